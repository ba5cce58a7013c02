#pragma once

#include "relative_map/localization/inertial_filter/inertial_filter.hpp"
#include "relative_map/localization/localizer.hpp"

namespace relative_map::core {

/// The inertial filter over the last two seconds' measurements, in the order of their stamps.
class InertialMethod : public LocalizationMethod {
 public:
  InertialMethod(const InertialParam& param, double rate);
  Taken add(const Event& event) override;
  std::optional<PoseEstimate> estimate(const MapProjection& map) override;
  LocalizerReport report() const override;
  const InertialState& state() const { return history_.state(); }

 private:
  EventHistory<InertialFilter> history_;
  double rate_;
  Time told_{};
  bool told_any_ = false;
};

}  // namespace relative_map::core
