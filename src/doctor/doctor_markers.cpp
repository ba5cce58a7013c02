#include <algorithm>
#include <cmath>
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

/// [1/m] Of the vehicle's way at a time [s, as in PoseSample]; none if it does not move or is not known.
std::optional<double> curvature_at(const Evidence& evidence, double time) {
  constexpr double kNear = 0.25;     // [s]
  constexpr double kMinSpeed = 2.0;  // [m/s] slower, the yaw rate's noise tells more of it than the road
  const PoseSample* nearest = nullptr;
  for (const PoseSample& pose : evidence.poses) {
    if (!nearest || std::abs(pose.time - time) < std::abs(nearest->time - time)) nearest = &pose;
  }
  if (!nearest || std::abs(nearest->time - time) > kNear || evidence.reversing) return std::nullopt;
  const double speed = nearest->velocity.norm();
  if (!(speed > kMinSpeed) || !std::isfinite(nearest->yaw_rate)) return std::nullopt;
  return nearest->yaw_rate / speed;
}

/// The side that is seen better; none if neither is.
const LaneMarker* better_side(const LaneMarkers& markers) {
  const LaneMarker &left = markers.left_lane_marker, &right = markers.right_lane_marker;
  const LaneMarker& better = left.quality >= right.quality ? left : right;
  return better.quality > 0.0 ? &better : nullptr;
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

Findings marker_quality_is_a_share(const Evidence& evidence) {
  constexpr double kSurest = 1.001;  // a quality of 1, rounded
  const Input<LaneMarkers>& input = evidence.seen.lane_markers;
  const double best = best_quality(input);
  if (!(best > kSurest)) return {};
  return {wrong(
      input.topic.name + ": quality is up to " + fixed(best, 2) +
          ", but must lie from 0 to 1: markers above it are not used",
      "divide it by the greatest value that the camera gives (one of 0 to 3 by 3, of per cent by 100)")};
}

Findings marker_curvature_is_halved(const Evidence& evidence) {
  constexpr double kBend = 0.003;      // [1/m] of a way that tells curvature from its half
  constexpr std::size_t kEnough = 10;  // images in bends
  const Input<LaneMarkers>& input = evidence.seen.lane_markers;
  if (input.messages.empty() || evidence.seen.localization.messages.empty()) return {};
  const ros::Time begin = evidence.seen.localization.messages.front().at;
  std::vector<double> ratios;
  for (const auto& [at, message] : input.messages) {
    const LaneMarker* marker = better_side(*message);
    const auto kappa = curvature_at(evidence, message->header.stamp.toSec() - begin.toSec());
    if (marker && kappa && std::abs(*kappa) > kBend) ratios.push_back(2.0 * marker->c2_curvature / *kappa);
  }
  if (ratios.size() < kEnough) return {};
  const double ratio = median(ratios);
  if (ratio > 0.6 && ratio < 1.4)
    return {ok(input.topic.name + ": curvatures are those of the vehicle's way")};
  if (!(ratio > 1.6 && ratio < 2.5))
    return {};  // the camera sees no bends, or other ones than the vehicle drives
  return {wrong(input.topic.name + ": c2_curvature is " + fixed(0.5 * ratio, 1) +
                    " times the curvature of the vehicle's way, but must be half of it",
                "fill c2_curvature with half the curvature, and c3_curvature_derivative with a sixth of its "
                "derivative: y = c0 + c1 x + c2 x^2 + c3 x^3")};
}

}  // namespace relative_map::doctor
