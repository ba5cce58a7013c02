#include "relative_map/ros/adapters/marker_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double kMinLength = 3.0;   // [m] of x: what is shorter tells no direction
constexpr double kKeptShare = 0.85;  // of the points, if all of them do not fit
constexpr double kOtherSide = 0.5;   // [s] without the other side, after which nobody waits for it

/// Ahead of the sensor; a border that comes back towards it ends there, as y is no function of x any more.
Points ahead(const nav_msgs::Path& paint) {
  Points points;
  for (const geometry_msgs::PoseStamped& pose : paint.poses) {
    const Eigen::Vector2d point(pose.pose.position.x, pose.pose.position.y);
    if (!point.allFinite() || point.x() < 0.0) continue;
    if (!points.empty() && point.x() <= points.back().x()) {
      if (point == points.back()) continue;
      break;
    }
    points.push_back(point);
  }
  return points;
}

struct Fit {
  Eigen::Vector4d coefficients = Eigen::Vector4d::Zero();
  double residual = 0.0;  ///< [m] RMS
};

/// Least squares by QR; x is scaled to 1, since x^3 of 100 m would cost half of the digits.
Fit fit(const Points& points, Eigen::Index degree) {
  const double scale = points.back().x();
  const auto rows = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd powers(rows, degree + 1);
  Eigen::VectorXd y(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Eigen::Vector2d& point = points[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k <= degree; ++k) powers(i, k) = std::pow(point.x() / scale, k);
    y(i) = point.y();
  }
  const Eigen::VectorXd scaled = powers.colPivHouseholderQr().solve(y);
  Fit result;
  for (Eigen::Index k = 0; k <= degree; ++k) result.coefficients(k) = scaled(k) / std::pow(scale, k);
  result.residual = (powers * scaled - y).norm() / std::sqrt(static_cast<double>(rows));
  return result;
}

}  // namespace

FittedMarker fit_marker(const nav_msgs::Path& paint, double max_residual) {
  FittedMarker result;
  Points points = ahead(paint);
  const double end = points.empty() ? 0.0 : points.back().x();
  while (points.size() >= 2 && points.back().x() - points.front().x() >= kMinLength) {
    // As many points as coefficients would fit any noise.
    const Eigen::Index degree = points.size() > 5 ? 3 : points.size() > 3 ? 2 : 1;
    const Fit fitted = fit(points, degree);
    result.residual = fitted.residual;
    if (fitted.residual <= max_residual) {
      LaneMarker& marker = result.marker;
      marker.quality = 1.0;
      marker.model_degree = static_cast<int32_t>(degree);
      marker.c0_position = fitted.coefficients(0);
      marker.c1_heading_angle = fitted.coefficients(1);
      marker.c2_curvature = fitted.coefficients(2);
      marker.c3_curvature_derivative = fitted.coefficients(3);
      marker.longitude_start = points.front().x();
      marker.longitude_end = marker.view_range = points.back().x();
      result.left_out = end - marker.view_range;
      return result;
    }
    const auto kept = static_cast<std::size_t>(kKeptShare * static_cast<double>(points.size()));
    points.resize(kept);
  }
  result.fault = result.residual > max_residual
                     ? "no cubic fits its points: they are " + std::to_string(result.residual) + " m from it"
                     : "it has less than " + std::to_string(kMinLength) + " m of points ahead of the sensor";
  return result;
}

MarkerPairing::Answer MarkerPairing::add(bool is_left, const nav_msgs::Path& paint,
                                         const ros::Time& received) {
  Answer answer;
  answer.fitted = fit_marker(paint, max_residual_);
  const bool pairs = waiting_ && waits_for_left_ == is_left && waiting_->header.stamp == paint.header.stamp;
  LaneMarkers markers = pairs ? *waiting_ : LaneMarkers();
  if (!pairs) {
    if (waiting_) answer.markers = std::move(waiting_);  // its other side did not come
    markers.header = paint.header;
    markers.header.frame_id = frame_name(paint.header.frame_id);
  }
  (is_left ? markers.left_lane_marker : markers.right_lane_marker) = answer.fitted.marker;
  newest_[is_left ? 0 : 1] = received;
  waiting_.reset();
  const double since_other = received.toSec() - newest_[is_left ? 1 : 0].toSec();
  if (pairs || (!answer.markers && std::abs(since_other) > kOtherSide)) {
    answer.markers = std::move(markers);
  } else {
    waiting_ = std::move(markers);
    waits_for_left_ = !is_left;
  }
  return answer;
}

}  // namespace relative_map
