#include "relative_map/ros/prediction/prediction_markers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "relative_map/ros/view/marker_shapes.hpp"

namespace relative_map {

namespace {

using visualization_msgs::Marker;

constexpr double kDefaultSize[3] = {0.8, 0.8, 1.6};         // [m] of what has no size
constexpr double kLeastRibbon = 0.15, kWidestRibbon = 3.0;  // [m] half widths
constexpr double kLeastShown = 0.01;                        // of a probability
constexpr std::size_t kStep = 4;                            // points a segment of a ribbon

/// Okabe and Ito's: vermilion, blue, grey.
std_msgs::ColorRGBA color_of(const PredictionObstacle& obstacle, double alpha) {
  switch (obstacle.priority) {
    case PredictionObstacle::CAUTION:
      return color(0.84, 0.37, 0.0, alpha);
    case PredictionObstacle::IGNORE:
      return color(0.6, 0.6, 0.6, alpha);
    default:
      return color(0.0, 0.45, 0.7, alpha);
  }
}

Marker make(const PredictionObstacles& message, const std::string& ns, int id, int type) {
  Marker marker;
  marker.header = message.header;
  marker.ns = ns;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  return marker;
}

Marker box(const PredictionObstacles& message, const PredictionObstacle& obstacle, int id) {
  const PerceptionObstacle& seen = obstacle.perception_obstacle;
  Marker marker = make(message, "road users", id, Marker::CUBE);
  marker.scale.x = seen.length > 0.0 ? seen.length : kDefaultSize[0];
  marker.scale.y = seen.width > 0.0 ? seen.width : kDefaultSize[1];
  marker.scale.z = seen.height > 0.0 ? seen.height : kDefaultSize[2];
  marker.pose.position = seen.position;
  marker.pose.position.z += 0.5 * marker.scale.z;
  marker.pose.orientation.z = std::sin(0.5 * seen.theta);
  marker.pose.orientation.w = std::cos(0.5 * seen.theta);
  marker.color = color_of(obstacle, 0.8);
  return marker;
}

Marker label(const PredictionObstacles& message, const PredictionObstacle& obstacle, int id) {
  static const char* const kTypes[] = {"unknown", "unknown", "unknown", "pedestrian", "bicycle", "vehicle"};
  const PerceptionObstacle& seen = obstacle.perception_obstacle;
  Marker marker = make(message, "labels", id, Marker::TEXT_VIEW_FACING);
  marker.pose.position = seen.position;
  marker.pose.position.z += 2.5;
  marker.scale.z = 0.9;
  marker.color = color(1.0, 1.0, 1.0);
  char text[96];
  std::snprintf(text, sizeof(text), "%s %d\n%.1f m/s", kTypes[std::min<int>(seen.type, 5)], seen.id,
                std::hypot(seen.velocity.x, seen.velocity.y));
  marker.text = text;
  return marker;
}

Marker ribbon(const PredictionObstacles& message, const PredictionObstacle& obstacle,
              const PredictionTrajectory& trajectory, int id) {
  Marker marker = make(message, "trajectories", id, Marker::TRIANGLE_LIST);
  marker.color = color_of(obstacle, std::clamp(trajectory.probability, 0.05, 0.9));
  const auto border = [](const TrajectoryPoint& point, double side) {
    const double half = std::clamp(point.sigma_across, kLeastRibbon, kWidestRibbon);
    geometry_msgs::Point result;
    result.x = point.path_point.x - side * half * std::sin(point.path_point.theta);
    result.y = point.path_point.y + side * half * std::cos(point.path_point.theta);
    result.z = 0.1;
    return result;
  };
  const auto& points = trajectory.trajectory_point;
  for (std::size_t i = 0; i + kStep < points.size(); i += kStep) {
    const TrajectoryPoint &a = points[i], &b = points[i + kStep];
    for (const auto& corner : {border(a, 1.0), border(a, -1.0), border(b, 1.0), border(b, 1.0),
                               border(a, -1.0), border(b, -1.0)}) {
      marker.points.push_back(corner);
    }
  }
  return marker;
}

}  // namespace

visualization_msgs::MarkerArray draw(const PredictionObstacles& message) {
  visualization_msgs::MarkerArray markers;
  Marker clear = make(message, "", 0, Marker::SPHERE);
  clear.action = Marker::DELETEALL;
  markers.markers.push_back(clear);
  int id = 0;
  for (const PredictionObstacle& obstacle : message.prediction_obstacle) {
    markers.markers.push_back(box(message, obstacle, id));
    markers.markers.push_back(label(message, obstacle, id));
    for (const PredictionTrajectory& trajectory : obstacle.trajectory) {
      if (trajectory.probability < kLeastShown || trajectory.trajectory_point.size() <= kStep) continue;
      markers.markers.push_back(ribbon(message, obstacle, trajectory, ++id));
    }
    ++id;
  }
  return markers;
}

}  // namespace relative_map
