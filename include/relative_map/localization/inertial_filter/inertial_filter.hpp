#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "relative_map/localization/imu/stillness.hpp"
#include "relative_map/localization/inertial_filter/inertial_param.hpp"
#include "relative_map/localization/inertial_filter/mechanization.hpp"
#include "relative_map/localization/inertial_filter/observations.hpp"
#include "relative_map/localization/path_match.hpp"
#include "relative_map/localization/source_health.hpp"

namespace relative_map::core {

enum class FilterMode {
  kWaiting,   ///< nothing came yet
  kAligning,  ///< level and heading are being found
  kRunning,
};

/// What the alignment has heard; shared by the states that remember the same.
struct AlignmentMemory {
  PathMatch path;
  std::optional<std::pair<Time, PositionFix>> fix, earlier_fix, before_fix;
  std::optional<std::pair<Time, VelocityFix>> velocity;
  double earlier_course = kNotGiven;  ///< [rad] from `before_fix` to `earlier_fix`
};

/// Everything that the inertial filter remembers. A value: it is copied, kept and gone back to.
struct InertialState {
  FilterMode mode = FilterMode::kWaiting;
  Time time{};               ///< that it holds for
  Time last_imu{};           ///< stamp of the newest inertial sample in it
  double imu_period = 0.01;  ///< [s] between samples, as a rule
  ImuSample sample;          ///< at `time`
  bool has_imu = false, has_plane = false;
  TangentPlane plane;
  NavigationState nav;  ///< aligning: attitude with a yaw from anywhere, and gyro bias
  ErrorFilter error;    ///< of `nav`; its state is zero
  EarthEffects earth;
  Motion motion;
  StillnessWindow window;
  std::array<SourceHealth, kSources> health;

  enum class Level { kNone, kMean, kStanding } level = Level::kNone;
  std::shared_ptr<const AlignmentMemory> memory;
  Eigen::Vector2d path = Eigen::Vector2d::Zero();  ///< [m] dead-reckoned, in the axes of the alignment

  double wheel_speed = 0.0;         ///< [m/s] the newest
  double stuck_speed_change = 0.0;  ///< [m/s] that the wheels should have told while they said the same
  Time wheel_used{}, wheel_changed{};
  Time last_absolute{};   ///< of a position that was used
  double distance = 0.0;  ///< [m] since then
  Time gap_end{};         ///< of the last gap between inertial samples
  Time steady_until{};    ///< re-aligned or inflated: not OK until then
  int inflations = 0, alignments = 0;
  bool standing = false;

  SourceHealth& of(Sensor source) { return health[static_cast<std::size_t>(source)]; }
  const SourceHealth& of(Sensor source) const { return health[static_cast<std::size_t>(source)]; }
};

/// An error-state Kalman filter of an inertial sensor and what sees the vehicle's place and motion; see
/// doc/localization.md for its equations. A pure function from state to state.
class InertialFilter {
 public:
  using State = InertialState;

  explicit InertialFilter(const InertialParam& param);

  State step(State state, const Event& event, const Event* next_imu) const;
  const InertialParam& param() const { return param_; }

 private:
  void move_to(State& state, Time time, const ImuSample& sample, const ImuNoise& noise) const;
  void advance(State& state, const Event& event, const Event* next_imu) const;
  void use_vehicle(State& state) const;
  void align(State& state, const Event& event) const;
  void find_level(State& state) const;
  double course_between_fixes(AlignmentMemory& memory, Time stamp, const PositionFix& fix,
                              const TangentPlane& plane) const;
  void start(State& state, double yaw, double yaw_stddev) const;
  void use_position(State& state, const Event& event, const Eigen::Vector3d& lever) const;
  void use_wheels(State& state, const WheelSpeed& wheels) const;
  void use(State& state, const Event& event) const;
  template <int Rows>
  bool update(State& state, Sensor source, const Observation<Rows>& seen, bool robust) const;
  void recover(State& state, Sensor source, const Eigen::Vector3d& innovation) const;
  void take_new_plane(State& state) const;

  InertialParam param_;
  std::array<double, 4> gate_{};    ///< squared distance by degrees of freedom
  Eigen::Vector3d antenna_, axle_;  ///< [m] from the sensor, body axes
};

}  // namespace relative_map::core
