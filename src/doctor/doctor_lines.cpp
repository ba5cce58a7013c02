#include <algorithm>
#include <cmath>
#include <limits>

#include "doctor_rules.hpp"
#include "relative_map/ros/messages/conversions.hpp"

// Where the vehicle is on the navigation lines.
namespace relative_map::doctor {

namespace {

using core::Foot;
using core::NavigationLine;
using core::Point2;

constexpr double kOtherOrigin = 1000.0;  // [m] nobody is so far from a line by driving there

struct Nearest {
  const NavigationLine* line = nullptr;
  double distance = std::numeric_limits<double>::infinity();  ///< [m]
};

Nearest nearest_line(const core::NavigationLines& lines, const Point2& position) {
  Nearest nearest;
  for (const NavigationLine& line : lines.lines) {
    const Foot foot = line.index.nearest(line.points, position - line.origin);
    const double distance = std::sqrt(foot.squared_distance);
    if (distance < nearest.distance) nearest = {&line, distance};
  }
  return nearest;
}

bool can_compare(const Evidence& evidence) {
  return evidence.vehicle && evidence.lines && !evidence.lines->lines.empty();
}

double reach(const Evidence& evidence) {
  return evidence.seen.config.pipeline.navigation_lane.max_distance_to_navigation_line;
}

/// The vehicle's heading minus the line's at every place where it passes by [rad].
void add_heading_offsets(const NavigationLine& line, const core::Pose2& vehicle, double reach,
                         std::vector<double>& offsets) {
  const Point2 position = vehicle.position() - line.origin;
  for (const Foot& foot : line.index.passes(line.points, position, reach)) {
    const core::PathPoint& from = line.points[foot.segment];
    const core::PathPoint& to = line.points[(foot.segment + 1) % line.points.size()];
    const Point2 along = to.position - from.position;
    offsets.push_back(core::angle_difference(vehicle.heading(), std::atan2(along.y(), along.x())));
  }
}

std::string bring_together(const Evidence& evidence, const Nearest& nearest) {
  const Point2& position = evidence.vehicle->map_from_base.position();
  const double swapped = nearest_line(*evidence.lines, {position.y(), position.x()}).distance;
  if (swapped <= reach(evidence)) return "swap x and y of one of them: east is x, north is y";
  if (nearest.distance >= kOtherOrigin) {
    return "bring both into one map frame: they have another UTM zone, map origin or projection (or one is "
           "in a local frame, or in degrees)";
  }
  return "drive to the line, or record one here; if the vehicle stands on it, compare datum and map origin "
         "of recording and localization (or raise navigation_lane/max_distance_to_navigation_line)";
}

}  // namespace

Findings lines_are_usable(const Evidence& evidence) {
  if (!evidence.lines) return {};
  const std::string& topic = evidence.seen.navigation.topic.name;
  const std::size_t sent = evidence.seen.navigation.messages.back().message->navigation_path.size();
  const std::size_t usable = evidence.lines->lines.size();
  const std::vector<std::string>& faults = evidence.lines->faults;
  const std::string mend = "send lines of two or more distinct points with finite x and y";
  if (sent == 0) return {wrong(topic + " holds no line: navigation_path is empty", mend)};
  if (usable < sent) {
    return {wrong(text(topic, ": ", usable, " of ", sent, " lines can be used: ", some(faults)), mend)};
  }
  Findings findings = {ok(text(topic, " holds ", sent, sent == 1 ? " line" : " lines", " that can be used"))};
  if (!faults.empty()) {
    findings.push_back(
        note(topic + ": " + some(faults), "the map node goes on with that; send lines that need no repair"));
  }
  return findings;
}

Findings a_line_is_near(const Evidence& evidence) {
  if (!can_compare(evidence)) return {};
  const Point2& position = evidence.vehicle->map_from_base.position();
  const Nearest nearest = nearest_line(*evidence.lines, position);
  const std::string what =
      "the nearest line, " + quoted(nearest.line->id) + ", is " + distance(nearest.distance) + " away";
  if (nearest.distance <= reach(evidence)) return {ok(what)};
  const Point2 start = nearest.line->origin + nearest.line->points.front().position;
  return {wrong(what + " (at most " + distance(reach(evidence)) + " is in reach): the vehicle is at " +
                    place(position.x(), position.y()) + ", the line begins at " + place(start.x(), start.y()),
                bring_together(evidence, nearest))};
}

Findings a_line_runs_along(const Evidence& evidence) {
  if (!can_compare(evidence)) return {};
  std::vector<double> offsets;
  for (const NavigationLine& line : evidence.lines->lines) {
    add_heading_offsets(line, evidence.vehicle->map_from_base, reach(evidence), offsets);
  }
  if (offsets.empty()) return {};
  const double best = *std::min_element(offsets.begin(), offsets.end(),
                                        [](double a, double b) { return std::abs(a) < std::abs(b); });
  if (std::abs(best) <= core::kPi / 2.0)
    return {ok("a line runs along, " + degrees(best) + " off the heading")};
  return {wrong(
      "all lines in reach are opposed to the vehicle: its heading is " + degrees(best) + " off the line's",
      "turn the vehicle round, send lines whose points follow each other in the direction of travel, or "
      "mend the heading if it is wrong")};
}

}  // namespace relative_map::doctor
