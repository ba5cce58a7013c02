#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/estimation/lane_estimator.hpp"
#include "relative_map/pipeline/estimation/marker_lane_estimator.hpp"
#include "relative_map/pipeline/fixed_weight/lane_marker_path.hpp"
#include "relative_map/pipeline/lanes/map_builder.hpp"
#include "relative_map/pipeline/lines/lanes_in_reach.hpp"
#include "relative_map/pipeline/motion/input_check.hpp"
#include "relative_map/pipeline/motion/pose_buffer.hpp"
#include "relative_map/pipeline/paint/image_queue.hpp"

namespace relative_map::core {

/// The stages in order: from the newest inputs to a map. Not thread-safe: feed it and tick it on one thread.
class RelativeMapPipeline {
 public:
  /// `config` must be valid (PipelineConfig::validate).
  explicit RelativeMapPipeline(std::shared_ptr<const PipelineConfig> config) : config_(std::move(config)) {}

  void set_config(std::shared_ptr<const PipelineConfig> config) { config_ = std::move(config); }
  void set_navigation_lines(std::shared_ptr<const NavigationLines> lines) {
    lanes_in_reach_.set_lines(std::move(lines));
  }
  /// Of the link whose place in the vehicle `link_from_base` gives; none: of the body frame itself.
  /// A message a little older than the newest one is late and dropped: false; one much older sets time back.
  bool set_localization(const Localization& link,
                        const std::optional<Eigen::Isometry3d>& link_from_base = std::nullopt);
  void set_chassis(const Chassis& chassis);
  void set_lane_markers(const LaneMarkers& markers);
  /// Forgets all but configuration and lines, as after a jump of the clock.
  void reset();

  /// The stamp of the pose that the next map would be for; none: no pose yet.
  std::optional<Time> pose_stamp() const;
  /// A map for the newest pose, or an empty one with the reason. `now` dates the inputs' ages.
  RelativeMap tick(Time now);
  /// An empty map that says why.
  RelativeMap empty_map(Status status, Time stamp);

  /// What the last tick noticed about its inputs without giving up on the map, a sentence each.
  const std::vector<std::string>& remarks() const { return remarks_; }

 private:
  std::variant<RelativeMap, Status> build(Time now);
  std::variant<RelativeMap, Status> build_estimated(const VehicleState& vehicle, Time now);
  std::variant<RelativeMap, Status> build_with_fixed_weight(const VehicleState& vehicle, Time now);
  std::variant<VehicleState, Status> vehicle_state(Time now);
  /// Carried on to the tick, if that is wanted.
  VehicleState predicted(VehicleState vehicle, Time now) const;
  std::optional<Chassis> fresh_chassis(Time now) const;
  void add_remarks(const std::vector<std::string>& remarks);
  void note(const std::vector<std::string>& remarks);
  std::variant<std::vector<TrackedLine>, Status> lines_in_reach(const VehicleState& vehicle);
  std::vector<LanePath> cut_lanes(const std::vector<TrackedLine>& lines, const VehicleState& vehicle);
  std::optional<MarkerPath> marker_path(const VehicleState& vehicle, Time now);
  /// None, and the lane stays as it is: what the markers make of it can't be driven.
  std::optional<FusionState> fuse(const MarkerPath& markers, LanePath& lane);
  void keep_room_beside(std::vector<LanePath>& lanes, std::size_t& current);
  std::variant<RelativeMap, Status> lane_of_markers(const std::vector<ImageQueue::Image>& images,
                                                    const VehicleState& localized, Time now,
                                                    Status otherwise);
  double default_half_width() const;
  Status nothing(Status status) const;
  RelativeMap finish(std::vector<LanePath> lanes, std::size_t current, const SeenPaint& paint,
                     FusionState fusion, const VehicleState& vehicle);

  std::shared_ptr<const PipelineConfig> config_;
  LanesInReach lanes_in_reach_;
  std::optional<Checked<Localization>> localization_;  ///< of the body frame
  std::optional<Checked<Chassis>> chassis_;
  std::optional<LaneMarkers> markers_;
  std::vector<std::string> marker_remarks_;  ///< on their numbers
  PoseBuffer poses_;
  ImageQueue images_;
  LaneEstimator estimator_;
  MarkerLaneEstimator marker_estimator_;
  std::string current_id_;  ///< of the last map
  std::uint32_t sequence_num_ = 0;
  std::vector<std::string> remarks_;
  std::vector<std::string> noted_;  ///< on inputs since the last tick, which a newer one may have replaced
};

}  // namespace relative_map::core
