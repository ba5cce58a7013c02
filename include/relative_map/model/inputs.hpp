#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/geometry/cubic.hpp"
#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/time.hpp"

namespace relative_map::core {

/// A vertex of a recorded line, ENU map frame; NaN: not given.
struct LinePoint {
  double x = 0.0, y = 0.0, z = 0.0;  ///< [m]
  double theta = 0.0;                ///< [rad] counter-clockwise from east
  double kappa = 0.0;                ///< [1/m]
  double dkappa = 0.0;               ///< [1/m^2]
  double s = 0.0;                    ///< [m]
};

/// A recorded line as received; nothing about it is checked yet.
struct RecordedLine {
  std::string name;
  std::uint32_t priority = 0;  ///< 0 is the best
  std::vector<LinePoint> points;
};

/// All lines of one navigation message.
struct NavigationInfo {
  std::string frame_id;  ///< the map frame
  std::vector<RecordedLine> lines;
};

/// Paint, by Apollo's numbers.
enum class BoundaryType : std::uint8_t {
  kUnknown = 0,
  kDottedYellow = 1,
  kDottedWhite = 2,
  kSolidYellow = 3,
  kSolidWhite = 4,
  kDoubleYellow = 5,
  kCurb = 6,
};

/// One perceived line of paint, in the frame of its LaneMarkers.
struct LaneMarker {
  BoundaryType type = BoundaryType::kUnknown;
  double quality = 0.0;          ///< [0, 1]; 0: not seen
  Cubic cubic;                   ///< left positive
  int degree = 3;                ///< of the polynomial that was fitted: 1 to 3
  double longitude_start = 0.0;  ///< [m] trusted from this x
  double view_range = 0.0;       ///< [m] trusted up to this x
};

/// The paint of one image.
struct LaneMarkers {
  Time stamp{};
  Pose2 base_from_sensor;  ///< the planar place of the markers' frame in the body frame
  LaneMarker left, right;
  std::vector<LaneMarker> next_left, next_right;  ///< nearest first
};

struct Chassis {
  Time stamp{};
  double speed = 0.0;      ///< [m/s] signed: negative in reverse gear
  bool sign_known = true;  ///< false: the gear says neither forwards nor back
};

/// The pose of a link of the vehicle, ENU map frame; NaN: not given.
struct Localization {
  Time stamp{};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();                 ///< [m]
  Eigen::Quaterniond map_from_body = Eigen::Quaterniond::Identity();  ///< FLU body to ENU
  double heading = 0.0;                                               ///< [rad] ccw from east
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();          ///< [m/s] ENU
  Eigen::Vector3d angular_velocity_body = Eigen::Vector3d::Zero();    ///< [rad/s] FLU
  // What the localization says of itself. Standard deviations; NaN: not given.
  double position_stddev = std::numeric_limits<double>::quiet_NaN();  ///< [m] of x and of y, the greater one
  double heading_stddev = std::numeric_limits<double>::quiet_NaN();   ///< [rad]
  std::optional<std::string> failure;  ///< that it has none to give, in its words; none: it has not failed
};

}  // namespace relative_map::core
