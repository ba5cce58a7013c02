#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/time.hpp"

namespace relative_map::core {

constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// Apollo's numbers.
enum class RoadUserType : std::uint8_t {
  kUnknown = 0,
  kUnknownMovable = 1,
  kUnknownUnmovable = 2,
  kPedestrian = 3,
  kBicycle = 4,
  kVehicle = 5,
};

/// What a sensor says of one road user at one time, in the map frame. NaN: not given.
struct SeenRoadUser {
  int id = 0;
  RoadUserType type = RoadUserType::kUnknown;
  Point2 position = Point2::Zero();                ///< [m] the middle of its box
  double heading = kNotGiven;                      ///< [rad] of its box
  Point2 velocity = Point2::Constant(kNotGiven);   ///< [m/s] in the map frame
  double length = 0.0, width = 0.0, height = 0.0;  ///< [m] 0: not given
  double position_stddev = kNotGiven;              ///< [m] on each axis
};

/// All that was seen at one time.
struct SeenRoadUsers {
  Time stamp{};
  std::vector<SeenRoadUser> users;
};

/// How much it matters to the vehicle's own plan. Numbers as in the message PredictionObstacle.
enum class Priority : std::uint8_t { kCaution = 1, kNormal = 2, kIgnore = 3 };

struct TrajectoryPoint {
  double time = 0.0;                 ///< [s] after the prediction's stamp
  Point2 position = Point2::Zero();  ///< [m]
  double theta = 0.0;                ///< [rad] where it drives to
  double speed = 0.0;                ///< [m/s] >= 0
  double acceleration = 0.0;         ///< [m/s^2] along theta
  double sigma_along = 0.0;          ///< [m] standard deviation along theta
  double sigma_across = 0.0;         ///< [m] and across
};

constexpr double kPredictionStep = 0.1;        ///< [s] between points
constexpr std::size_t kPredictionPoints = 81;  ///< 0 .. 8.0 s

/// One thing that a road user may do.
struct PredictedTrajectory {
  double probability = 0.0;
  std::string lane_id;  ///< of the lane that it is on after 3 s; empty: off the lanes
  std::vector<TrajectoryPoint> points;
};

/// All that a road user may do, the likeliest first; probabilities sum to one.
struct PredictedRoadUser {
  SeenRoadUser seen;                 ///< as it was seen last
  Point2 position = Point2::Zero();  ///< [m] estimated, at the prediction's stamp
  Point2 velocity = Point2::Zero();  ///< [m/s] estimated
  double theta = 0.0;                ///< [rad] where it drives to
  bool still = false;
  Priority priority = Priority::kNormal;
  bool interactive = false;
  std::string lane_id;  ///< that it is on; empty: none
  std::vector<PredictedTrajectory> trajectories;
};

enum class Scenario : std::uint8_t { kUnknown = 0, kCruise = 1, kJunction = 2 };

/// In the map frame.
struct Prediction {
  Time stamp{};
  Scenario scenario = Scenario::kUnknown;
  std::vector<PredictedRoadUser> users;
  std::vector<std::string> remarks;  ///< what was noticed about the inputs, a sentence each
};

/// The vehicle itself: where it is and, if it has said so, where it will be.
struct EgoVehicle {
  Pose2 pose;
  double speed = 0.0;                       ///< [m/s]
  std::vector<TrajectoryPoint> trajectory;  ///< planned; empty: not known
  bool right_of_way_is_sure = false;        ///< Apollo's PROTECTED
};

}  // namespace relative_map::core
