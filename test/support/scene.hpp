#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "relative_map/pipeline/contract/map_check.hpp"
#include "relative_map/pipeline/relative_map_pipeline.hpp"
#include "support/lines.hpp"
#include "support/markers.hpp"

namespace relative_map::core::test {

inline Localization localization_at(const Pose2& pose, Time stamp, double speed = 10.0) {
  Localization localization;
  localization.stamp = stamp;
  localization.position << pose.position(), 0.0;
  localization.heading = pose.heading();
  localization.map_from_body = Eigen::AngleAxisd(pose.heading(), Eigen::Vector3d::UnitZ());
  localization.linear_velocity << speed * pose.forward(), 0.0;
  return localization;
}

/// A pipeline with lines, a clock and a vehicle to put on them. Every map that it makes is held against the
/// output contract.
class Scene {
 public:
  explicit Scene(std::vector<RecordedLine> lines, const PipelineConfig& config = PipelineConfig())
      : config_(config),
        context_(MapContext::of(config)),
        pipeline_(std::make_shared<PipelineConfig>(config)) {
    set_lines(std::move(lines));
  }

  void set_lines(std::vector<RecordedLine> lines) {
    pipeline_.set_navigation_lines(
        prepare_navigation_lines({"map", std::move(lines)}, IntakeParam::of(config_)));
  }

  /// A tenth of a second later, with the vehicle at `pose`.
  RelativeMap at(const Pose2& pose, double speed = 10.0, double yaw_rate = 0.0) {
    now_ += step;
    Chassis chassis;
    chassis.stamp = now_;
    chassis.speed = speed;
    pipeline_.set_chassis(chassis, now_);
    Localization localization = localization_at(pose, now_, speed);
    localization.angular_velocity_body.z() = yaw_rate;
    pipeline_.set_localization(localization, std::nullopt, now_);
    return tick();
  }
  /// Seen at the pose and time of the next call of `at`.
  void see(LaneMarkers markers) {
    markers.stamp = now_ + step;
    pipeline_.set_lane_markers(markers);
  }
  RelativeMap tick() {
    RelativeMap map = pipeline_.tick(now_);
    for (const Violation& violation : check_map(map, context_)) {
      ADD_FAILURE() << violation.row << ": " << violation.what;
    }
    context_.previous_sequence_num = map.sequence_num;
    context_.previous_stamp = map.stamp;
    return map;
  }

  RelativeMapPipeline& pipeline() { return pipeline_; }
  Time now() const { return now_; }
  void wait(double seconds) {
    now_ += from_seconds(seconds);
    if (seconds < 0.0) context_.previous_stamp.reset();  // the clock is set back
  }
  bool remarked(const std::string& words) const {
    const auto& remarks = pipeline_.remarks();
    return std::any_of(remarks.begin(), remarks.end(),
                       [&](const std::string& remark) { return remark.find(words) != std::string::npos; });
  }

  const Duration step = std::chrono::milliseconds(100);

 private:
  PipelineConfig config_;
  MapContext context_;
  RelativeMapPipeline pipeline_;
  Time now_ = at_seconds(1000.0);
};

inline std::vector<std::string> lane_ids(const RelativeMap& map) {
  std::vector<std::string> ids;
  for (const Lane& lane : map.lanes) ids.push_back(lane.id);
  return ids;
}

/// Three straight lanes of 3.5 m along x, left to right, the middle one on the axis.
inline std::vector<RecordedLine> three_straight_lines(double length = 600.0, double spacing = 0.5) {
  std::vector<RecordedLine> lines;
  const std::vector<std::string> names = {"left", "middle", "right"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Pose2 start(Point2(0.0, 3.5 * (1.0 - static_cast<double>(i))), 0.0);
    lines.push_back(recording(straight(start, length, spacing), names[i], static_cast<std::uint32_t>(i)));
  }
  return lines;
}

}  // namespace relative_map::core::test
