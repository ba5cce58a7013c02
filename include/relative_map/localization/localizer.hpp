#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/localization/event_history.hpp"
#include "relative_map/localization/geodesy/map_projection.hpp"
#include "relative_map/localization/localizer_param.hpp"
#include "relative_map/localization/pose_estimate.hpp"
#include "relative_map/localization/source_health.hpp"
#include "relative_map/localization/stamp_guard.hpp"

namespace relative_map::core {

/// A satellite receiver's fix as it came; nothing about it is checked yet.
struct FixReading {
  GeoPoint place;                                        ///< NaN altitude: not given
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2] east, north, up
  bool covariance_known = false;
  int status = 0;  ///< -1: no fix, 0: plain, 1: satellite-based corrections, 2: ground-based ones (RTK)
};

/// A pose of the body in the map, from whatever matches the surroundings.
struct MapPoseReading {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();                 ///< [m] map
  Eigen::Quaterniond map_from_body = Eigen::Quaterniond::Identity();  ///< FLU to map
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();      ///< [m^2] map
  double yaw_variance = 0.0;                                          ///< [rad^2]
};

/// What is known of a method while it runs, for people.
struct LocalizerReport {
  std::array<SourceHealth, kSources> health;
  double wheel_scale = kNotGiven, mount_pitch = kNotGiven, mount_yaw = kNotGiven;  ///< [-], [rad], [rad]
  double stamp_offset = kNotGiven, stamp_offset_stddev = kNotGiven;   ///< [s] inertial sensor after the fixes
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Constant(kNotGiven);   ///< [rad/s]
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Constant(kNotGiven);  ///< [m/s^2]
  bool standing = false, aligned = false;
  int inflations = 0, alignments = 0;
  double since_fix = kNotGiven, distance = kNotGiven;  ///< [s], [m] since a position was used
};

/// A method that turns measurements into estimates. Implementations: inertial, planar and RTK.
class LocalizationMethod {
 public:
  virtual ~LocalizationMethod() = default;
  virtual Taken add(const Event& event) = 0;
  /// The newest state's, if it is newer than the last one that was asked for.
  virtual std::optional<PoseEstimate> estimate(const MapProjection& map) = 0;
  virtual LocalizerReport report() const = 0;
};

/// Sensors to poses: checks what comes, puts it on one clock, and hands it to the method. What it has to say
/// of a message is a sentence; nothing is thrown.
class Localizer {
 public:
  explicit Localizer(const LocalizerParam& param);
  ~Localizer();

  // Readings, in any order; `stamp` as the sensor has it. The inertial sample is in the body's axes.
  void add_imu(Time stamp, const ImuSample& sample);
  void add_fix(Time stamp, const FixReading& fix);
  /// `stddev`: [m/s] of each axis; NaN: not known.
  void add_fix_velocity(Time stamp, const Eigen::Vector3d& velocity, double stddev);
  /// [rad] of the body from true east; `stddev` NaN: not known.
  void add_heading(Time stamp, double heading, double stddev);
  void add_wheels(Time stamp, const WheelSpeed& wheels);
  void add_map_pose(Time stamp, const MapPoseReading& pose);

  /// The estimates that have become known, oldest first.
  std::vector<PoseEstimate> take_estimates();
  /// Sentences about what was dropped, and why; alike but for their numbers where the fault is the same.
  std::vector<std::string> take_remarks();

  /// [m] of the sensors in the body. What was found with another place is forgotten.
  void set_imu_place(const Eigen::Vector3d& place);
  void set_antenna_place(const Eigen::Vector3d& place);

  /// Forgets all but the map.
  void reset();
  /// Where the map frame lies on the earth; nothing may have been published in another.
  void set_reference(const GeoReference& reference);
  const std::optional<MapProjection>& map() const { return map_; }
  LocalizerReport report() const;
  const LocalizerParam& param() const { return param_; }

 private:
  void add(Event event, double stamp_offset, const char* name);
  void remark(const std::string& sentence) { remarks_.push_back(sentence); }
  bool is_finite(const char* name, bool finite);

  LocalizerParam param_;
  std::unique_ptr<LocalizationMethod> method_;
  StampGuard stamps_;
  std::optional<MapProjection> map_;
  double altitude_ = 0.0;  ///< [m] of the newest fix that had one
  std::vector<PoseEstimate> estimates_;
  std::vector<std::string> remarks_;
  Time newest_{};  ///< stamp of the last estimate
  bool estimated_ = false;
};

}  // namespace relative_map::core
