#include <algorithm>
#include <map>

#include "doctor_rules.hpp"
#include "relative_map/pipeline/fixed_weight/lane_marker_path.hpp"
#include "relative_map/ros/messages/conversions.hpp"

// Whether the perceived paint makes sense.
namespace relative_map::doctor {

namespace {

bool both_seen(const LaneMarkers& markers) {
  return markers.left_lane_marker.quality > 0.0 && markers.right_lane_marker.quality > 0.0;
}

double gap(const LaneMarkers& markers) {
  return markers.left_lane_marker.c0_position - markers.right_lane_marker.c0_position;
}

bool mirrored(const LaneMarkers& markers) {
  return both_seen(markers) && gap(markers) < 0.0;
}

double best_quality(const Input<LaneMarkers>& input) {
  double best = 0.0;
  for (const auto& [at, message] : input.messages) {
    best = std::max({best, message->left_lane_marker.quality, message->right_lane_marker.quality});
  }
  return best;
}

/// Why the core makes no path of the markers; empty: it does.
std::string fault_of(const Received<LaneMarkers>& received, const core::PipelineConfig& config) {
  const auto made = core::make_marker_path(to_core(*received.message, core::Pose2(), received.at),
                                           core::Pose2(), 0.0, config.map_param, config.navigation_lane);
  const auto* fault = std::get_if<std::string>(&made);
  return fault ? *fault : "";
}

}  // namespace

Findings markers_are_not_mirrored(const Evidence& evidence) {
  const Input<LaneMarkers>& input = evidence.seen.lane_markers;
  std::size_t seen = 0, wrong_way = 0;
  const LaneMarkers* example = nullptr;
  for (const auto& [at, message] : input.messages) {
    seen += both_seen(*message);
    if (!mirrored(*message)) continue;
    ++wrong_way;
    example = message.get();
  }
  if (seen == 0) return {};
  if (2 * wrong_way < seen) return {ok(input.topic.name + ": left is left of right")};
  const double left = example->left_lane_marker.c0_position, right = example->right_lane_marker.c0_position;
  return {wrong(input.topic.name + ": the left marker lies right of the right one (c0_position " +
                    fixed(left, 2) + " m and " + fixed(right, 2) + " m)",
                left < 0.0 && right > 0.0
                    ? "y is positive to the left: turn the signs of c0 to c3, or swap left_lane_marker and "
                      "right_lane_marker if they are mixed up"
                    : "swap left_lane_marker and right_lane_marker, or see why c0_position is off")};
}

Findings markers_make_a_lane(const Evidence& evidence) {
  const Input<LaneMarkers>& input = evidence.seen.lane_markers;
  std::map<std::string, std::size_t> faults;
  std::size_t looked_at = 0, good = 0;
  for (const Received<LaneMarkers>& received : input.messages) {
    if (mirrored(*received.message)) continue;
    ++looked_at;
    const std::string fault = fault_of(received, evidence.seen.config.pipeline);
    if (fault.empty())
      ++good;
    else
      ++faults[fault];
  }
  if (looked_at == 0) return {};
  if (2 * good > looked_at) {
    return {ok(text(input.topic.name, ": ", good, " of ", looked_at, " messages make a lane"))};
  }
  const auto& [fault, count] = *std::max_element(
      faults.begin(), faults.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const std::string what = text(input.topic.name, ": of ", looked_at, " messages ", looked_at - good,
                                " make no lane, as: ", fault);
  const double quality = best_quality(input),
               limit = evidence.seen.config.pipeline.navigation_lane.min_lane_marker_quality;
  if (quality < limit) {
    return {
        note(what + "; the best quality is " + fixed(quality, 2) + ", and " + fixed(limit, 2) + " is needed",
             "well where there is no paint; else fill quality (0 to 1), or lower "
             "navigation_lane/min_lane_marker_quality")};
  }
  return {wrong(what,
                "fill view_range [m] (above longitude_start) and quality of left_lane_marker and "
                "right_lane_marker; c0_position is in [m] from the middle of the vehicle")};
}

}  // namespace relative_map::doctor
