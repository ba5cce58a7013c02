#include "relative_map/pipeline/lanes/narrow_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr double kSearchStep = 1.0;  // [m] between the places where narrowness is looked for
constexpr double kShortestLane =
    30.0;  // [m] ahead of the vehicle; what is left of a lane must be worth a change

/// Arc length at which `lane` first comes too near to `better`; none: it never does.
std::optional<double> first_narrow_place(const LanePath& lane, const LanePath& better, double spacing) {
  const Polyline centerline = positions_of(better.points);
  PolylineWalker walker(centerline);
  const double step = std::min(kSearchStep, 0.5 * spacing);
  double s = 0.0;
  std::size_t last = 0;
  for (std::size_t i = 0; i + 1 < lane.points.size(); ++i) {
    const PathPoint &a = lane.points[i], &b = lane.points[i + 1];
    while (s < b.s) {
      const Point2 place = a.position + (s - a.s) / (b.s - a.s) * (b.position - a.position);
      const Foot foot = walker.next(place, std::max<std::size_t>(1, i - last));
      last = i;
      const double distance = std::sqrt(foot.squared_distance);
      if (!walker.beyond_end(foot) && distance < spacing) return s;
      s += std::max(step, distance - spacing);  // it comes no nearer by more than the way between
    }
  }
  return std::nullopt;
}

/// Ends a lane before `s` [m]; false leaves it as it is: what remained of it ahead would be too short.
bool cut_short(LanePath& lane, double s) {
  const auto end = std::find_if(lane.points.begin(), lane.points.end(),
                                [s](const PathPoint& point) { return point.s >= s; });
  if (end - lane.points.begin() < 2 || (end - 1)->s - lane.s_at_vehicle < kShortestLane) return false;
  lane.points.erase(end, lane.points.end());
  lane.remaining = lane.points.back().s - lane.s_at_vehicle;
  return true;
}

std::string narrow_sentence(const LanePath& lane, const LanePath& better, const char* verb, double ahead) {
  std::ostringstream sentence;
  sentence.precision(3);
  sentence << "line '" << lane.id << "' " << verb << ": " << std::max(0.0, ahead)
           << " m ahead it comes so near to '" << better.id << "' that the vehicle does not fit";
  return sentence.str();
}

/// One pass over the neighbours; true if a lane was taken out and the neighbours are others now.
bool drop_one(std::vector<LanePath>& lanes, double half_width, const std::string& kept,
              std::vector<std::string>& sentences) {
  for (std::size_t i = 0; i + 1 < lanes.size(); ++i) {
    const bool right_is_better =
        lanes[i].priority > lanes[i + 1].priority ? lanes[i].id != kept : lanes[i + 1].id == kept;
    const std::size_t worse = right_is_better ? i : i + 1;
    const LanePath& better = lanes[worse == i ? i + 1 : i];
    LanePath& lane = lanes[worse];
    const std::optional<double> narrow = first_narrow_place(lane, better, 2.0 * half_width);
    if (!narrow) continue;
    const double ahead = *narrow - lane.s_at_vehicle;
    if (cut_short(lane, *narrow)) {
      sentences.push_back(narrow_sentence(lane, better, "is cut short", ahead));
      continue;
    }
    sentences.push_back(narrow_sentence(lane, better, "is left out", ahead));
    lanes.erase(lanes.begin() + static_cast<std::ptrdiff_t>(worse));
    return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> drop_narrow_lanes(std::vector<LanePath>& lanes, double half_width,
                                           const std::string& kept) {
  std::vector<std::string> sentences;
  while (drop_one(lanes, half_width, kept, sentences)) {
  }
  return sentences;
}

std::vector<std::string> keep_room_beside(std::vector<LanePath>& lanes, std::size_t& current,
                                          double half_width) {
  const std::string id = lanes[current].id;
  sort_left_to_right(lanes);
  std::vector<std::string> sentences = drop_narrow_lanes(lanes, half_width, id);
  for (current = 0; lanes[current].id != id;) ++current;
  return sentences;
}

}  // namespace relative_map::core
