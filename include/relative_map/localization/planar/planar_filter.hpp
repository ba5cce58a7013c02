#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "relative_map/geometry/kalman_filter.hpp"
#include "relative_map/localization/geodesy/tangent_plane.hpp"
#include "relative_map/localization/localizer_param.hpp"
#include "relative_map/localization/measurements.hpp"
#include "relative_map/localization/path_match.hpp"
#include "relative_map/localization/source_health.hpp"

namespace relative_map::core {

/// Where each number of the planar state is: place of the rear axle [m] and yaw [rad] in the plane, speed
/// [m/s], yaw rate [rad/s], what the wheels' yaw rate is wrong by [rad/s], and what their speed is multiplied
/// by.
namespace planar {
constexpr int kX = 0, kY = 1, kYaw = 2, kSpeed = 3, kYawRate = 4, kRateBias = 5, kScale = 6, kCount = 7;
}  // namespace planar

/// What the planar alignment has heard; shared by the states that remember the same.
struct PlanarMemory {
  PathMatch path;
  std::optional<std::pair<Time, PositionFix>> fix, earlier_fix;
};

/// Everything that the planar filter remembers. A value: it is copied, kept and gone back to.
struct PlanarState {
  bool has_time = false, has_plane = false, running = false;
  Time time{};
  TangentPlane plane;
  KalmanFilter<planar::kCount> filter;
  double height = 0.0, height_stddev = 1e4;  ///< [m] in the plane: the newest fixes'
  std::shared_ptr<const PlanarMemory> memory;
  Eigen::Vector3d path = Eigen::Vector3d::Zero();  ///< [m, m, rad] dead-reckoned before the heading is known
  WheelSpeed wheels;
  std::array<SourceHealth, kSources> health;
  Time last_absolute{}, steady_until{};
  double distance = 0.0;  ///< [m] since then
  int inflations = 0, alignments = 0;

  SourceHealth& of(Sensor source) { return health[static_cast<std::size_t>(source)]; }
  const SourceHealth& of(Sensor source) const { return health[static_cast<std::size_t>(source)]; }
};

/// For vehicles without an inertial sensor: an extended Kalman filter of a body that goes where it points,
/// with a speed and a yaw rate that change at random (constant turn rate and velocity), seen by wheels and
/// fixes. A pure function from state to state.
class PlanarFilter {
 public:
  using State = PlanarState;

  explicit PlanarFilter(const LocalizerParam& param);
  State step(State state, const Event& event, const Event* next_imu) const;
  const LocalizerParam& param() const { return param_; }

 private:
  void advance(State& state, Time time) const;
  void align(State& state, const Event& event) const;
  void start(State& state, double yaw, double yaw_stddev, double speed, double speed_stddev) const;
  void use(State& state, const Event& event) const;
  void use_position(State& state, const Event& event, const Eigen::Vector2d& lever) const;
  template <int Rows>
  bool update(State& state, Sensor source, const Eigen::Matrix<double, Rows, 1>& innovation,
              const Eigen::Matrix<double, Rows, planar::kCount>& jacobian,
              const Eigen::Matrix<double, Rows, Rows>& noise) const;

  LocalizerParam param_;
  std::array<double, 4> gate_{};  ///< squared distance by degrees of freedom
};

}  // namespace relative_map::core
