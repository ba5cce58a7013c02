#pragma once

#include <relative_map/Chassis.h>
#include <relative_map/LaneMarkers.h>
#include <relative_map/LocalizationEstimate.h>
#include <relative_map/MapMsg.h>
#include <relative_map/NavigationInfo.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/pipeline/relative_map_pipeline.hpp"
#include "relative_map/ros/setup/frames.hpp"
#include "relative_map/ros/setup/parameters.hpp"

namespace relative_map {

/// Messages in, maps out: the pipeline with conversions and frames around it, without topics or timers.
/// The node and the replay tool both drive it. Not thread-safe, but for `prepare`.
class MapEngine {
 public:
  MapEngine(const NodeConfig& config, LinkTransforms transforms);

  /// Readies lines for `set_navigation_lines`; slow for long lines, and fit for any thread.
  static std::shared_ptr<const core::NavigationLines> prepare(const NavigationInfo& message,
                                                              const core::PipelineConfig& config);
  void set_navigation_lines(std::shared_ptr<const core::NavigationLines> lines);
  void set_config(const core::PipelineConfig& config);

  void on_localization(const LocalizationEstimateConstPtr& message, const ros::Time& received);
  void on_chassis(const ChassisConstPtr& message, const ros::Time& received);
  void on_lane_markers(const LaneMarkersConstPtr& message, const ros::Time& received);

  /// The map at `now`; none if the newest pose has had its map already. Time that runs backwards forgets
  /// all inputs but the lines.
  MapMsgPtr tick(const ros::Time& now);
  void reset();

  /// The map of the last tick, as the pipeline built it.
  const core::RelativeMap& last_map() const { return map_; }
  /// What the last tick noticed about its inputs, a sentence each.
  const std::vector<std::string>& remarks() const { return remarks_; }
  const core::NavigationLines* navigation_lines() const { return lines_.get(); }
  const core::PipelineConfig& config() const { return *config_; }

 private:
  /// What the pipeline can't know of: clock, transforms, the name of the map frame.
  std::optional<core::Status> localization_fault(const ros::Time& now) const;
  /// Neither stale nor of the future.
  bool pose_is_of_now(const ros::Time& now) const;

  void set_speed_limits(core::RelativeMap& map) const;

  std::shared_ptr<const core::PipelineConfig> config_;
  std::map<std::string, double> speed_limits_;  ///< [m/s] by the name of a line
  OrientationConvention convention_;
  LinkTransforms transforms_;
  core::RelativeMapPipeline pipeline_;
  std::shared_ptr<const core::NavigationLines> lines_;
  LocalizationEstimateConstPtr localization_;
  LaneMarkersConstPtr markers_;
  bool localization_has_transform_ = true;
  std::string marker_fault_;
  std::optional<core::Time> newest_pose_, mapped_pose_;  ///< stamps, where a transform is missing too
  std::optional<std::uint32_t> published_sequence_num_;
  core::RelativeMap map_;
  std::vector<std::string> remarks_;
};

}  // namespace relative_map
