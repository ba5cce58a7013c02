#include "line_ends.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "relative_map/geometry/statistics.hpp"

namespace relative_map::core {

namespace {

constexpr double kLeastLength = 3.0;  // [m]
constexpr double kByScatter = 10.0;   // lengths a scatter: a direction of some 0.1 rad

double signed_angle(const Point2& a, const Point2& b) {
  return std::atan2(cross(a, b), a.dot(b));
}

}  // namespace

double direction_length(const Polyline& points) {
  if (points.size() < 3) return kLeastLength;
  std::vector<double> deviations;  // of each point from the middle of its neighbours
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    deviations.push_back((points[i] - 0.5 * (points[i - 1] + points[i + 1])).norm());
  }
  return std::max(kLeastLength, kByScatter * median(std::move(deviations)));
}

Point2 direction_at_start(const Polyline& points) {
  const double length = direction_length(points);
  const auto farther = [&](std::size_t i, const Point2& from) {
    while (i + 1 < points.size() && (points[i] - from).norm() < length) ++i;
    return i;
  };
  const std::size_t middle = farther(1, points[0]);
  const Point2 chord = points[middle] - points[0];
  if (middle + 1 >= points.size()) return chord.normalized();
  const Point2 next = points[farther(middle + 1, points[middle])] - points[middle];
  return Pose2({}, -0.5 * signed_angle(chord, next)).rotate_to_parent(chord).normalized();
}

Point2 direction_at_end(const Polyline& points) {
  const Polyline back(points.rbegin(), points.rend());
  return -direction_at_start(back);
}

double angle_between(const Point2& a, const Point2& b) {
  return std::abs(signed_angle(a, b));
}

}  // namespace relative_map::core
