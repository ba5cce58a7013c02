#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/contract/map_check.hpp"
#include "relative_map/pipeline/estimation/estimator_method.hpp"
#include "relative_map/pipeline/fixed_weight/fixed_weight_method.hpp"
#include "relative_map/pipeline/lanes/map_method.hpp"
#include "relative_map/pipeline/lines/lanes_in_reach.hpp"
#include "relative_map/pipeline/motion/motion_inputs.hpp"

namespace relative_map::core {

/// The stages in order: from the newest inputs to a map. Not thread-safe: feed it and tick it on one thread.
class RelativeMapPipeline {
 public:
  /// `config` must be valid (PipelineConfig::validate).
  explicit RelativeMapPipeline(std::shared_ptr<const PipelineConfig> config)
      : config_(std::move(config)), estimated_(config_->lane_fusion.noise) {}

  void set_config(std::shared_ptr<const PipelineConfig> config) { config_ = std::move(config); }
  void set_navigation_lines(std::shared_ptr<const NavigationLines> lines) {
    lines_.set_lines(std::move(lines));
  }
  // `received`: when a message came, by the clock that `tick` is told; none: not known, and no stamp is of
  // the future. StampOrder says which messages are dropped by their stamps, and when time has gone back.
  /// Of the link whose place in the vehicle `link_from_base` gives; none: of the body frame itself.
  /// False: it was dropped by its stamp.
  bool set_localization(const Localization& link,
                        const std::optional<Eigen::Isometry3d>& link_from_base = std::nullopt,
                        std::optional<Time> received = std::nullopt);
  void set_chassis(const Chassis& chassis, std::optional<Time> received = std::nullopt);
  void set_lane_markers(const LaneMarkers& markers, std::optional<Time> received = std::nullopt);
  /// Forgets all but configuration and lines.
  void reset();
  /// Tells the time. True: it has gone back; then all is forgotten likewise, and the next map's stamp may be
  /// older than the last one's. `tick` does this too.
  bool set_clock(Time now);

  /// The stamp of the pose that the next map would be for; none: no pose yet.
  std::optional<Time> pose_stamp() const { return motion_.stamp(); }
  /// A map for the newest pose, or an empty one with the reason. `now` dates the inputs' ages.
  RelativeMap tick(Time now);
  /// An empty map that says why.
  RelativeMap empty_map(Status status, Time stamp);

  /// What the last tick noticed about its inputs without giving up on the map, a sentence each.
  const std::vector<std::string>& remarks() const { return remarks_; }

 private:
  /// What is kept of the newest image: the methods keep its paint.
  struct NewestMarkers {
    Time stamp{};
    std::vector<std::string> remarks;  ///< on their numbers
  };

  std::variant<RelativeMap, Status> build(Time now);
  MapMethod& method();
  std::variant<RelativeMap, Status> map_of(FoundLanes found);
  bool leave_out(const BadLane& bad, FoundLanes& found);
  void forget_what_was_seen();
  void note(const std::vector<std::string>& remarks);

  std::shared_ptr<const PipelineConfig> config_;
  MotionInputs motion_;
  LanesInReach lines_;
  EstimatorMethod estimated_;
  FixedWeightMethod fixed_weight_;
  std::optional<NewestMarkers> markers_;
  std::string current_id_;  ///< of the last map
  std::uint32_t sequence_num_ = 0;
  StampOrder marker_order_{"perception/lane_markers"};
  std::optional<Time> last_tick_;
  Time last_stamp_{};  ///< of a map
  std::vector<std::string> remarks_;
  std::vector<std::string> noted_;  ///< on inputs since the last tick, which a newer one may have replaced
};

}  // namespace relative_map::core
