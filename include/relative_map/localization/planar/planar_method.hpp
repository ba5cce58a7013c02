#pragma once

#include "relative_map/localization/localizer.hpp"
#include "relative_map/localization/planar/planar_filter.hpp"

namespace relative_map::core {

/// What the planar filter's state says of the body, in the map. Roll and pitch are those of the plane's
/// ground.
PoseEstimate make_estimate(const PlanarState& state, const LocalizerParam& param, const MapProjection& map);

/// The planar filter over the last two seconds' measurements, in the order of their stamps.
class PlanarMethod : public LocalizationMethod {
 public:
  explicit PlanarMethod(const LocalizerParam& param);
  Taken add(const Event& event) override;
  std::optional<PoseEstimate> estimate(const MapProjection& map) override;
  LocalizerReport report() const override;

 private:
  EventHistory<PlanarFilter> history_;
  Time told_{};
  bool told_any_ = false;
};

}  // namespace relative_map::core
