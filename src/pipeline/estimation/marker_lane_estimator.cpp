#include "relative_map/pipeline/estimation/marker_lane_estimator.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/pipeline/estimation/half_width_model.hpp"

namespace relative_map::core {

namespace {

// Standard deviations at the start ...
constexpr double kOffset0 = 2.0;          // [m]
constexpr double kSlope0 = 0.3;           // [-]
constexpr double kCurvature0 = 0.05;      // [1/m]
constexpr double kCurvatureRate0 = 2e-3;  // [1/m^2]
constexpr double kTurnBias0 = 0.005;      // [rad/s]
constexpr double kCameraYaw0 = 0.006;     // [rad]
// ... and of the random walks, by the root of the way [m] or the time [s].
constexpr double kCurvatureRateWalk = 2e-5;                                   // [1/m^2] by way
constexpr double kCurvatureWalk = 6e-5;                                       // [1/m] by way
constexpr double kHeadingWalk = 0.002;                                        // [rad] by time
constexpr double kSlipWalk = 0.02;                                            // [m] by time
constexpr double kTurnBiasWalk = 5e-5;                                        // [rad/s] by time
constexpr double kCameraYawWalk = 1e-4;                                       // [rad] by time
constexpr double kRoadSpeed = 15.0, kSlowestRoad = 5.0, kFastestRoad = 40.0;  // [m/s]
constexpr double kLongestGap = 1.0;     // [s] between poses that odometry bridges
constexpr double kNothingSeen = 10.0;   // [m] of paint left ahead, below which the vehicle's own way counts
constexpr double kSlowest = 3.0;        // [m/s] at which it tells anything
constexpr double kDriverSlope = 0.015;  // [rad] of it from the lane's, by the root of the time [s]
constexpr double kDriverCurvature = 0.004;  // [1/m] likewise
constexpr double kPatience = 1.2;     // [s] of paint that does not fit; outliers last for up to a second
constexpr double kWidthMargin = 1.2;  // a lane so much wider or narrower than the limits is none
constexpr double kGate = 30.0;        // squared, in standard deviations

}  // namespace

void MarkerLaneEstimator::start(double half_width) {
  Filter::State x = x.Zero();
  x[kLeft] = x[kRight] = half_width;
  Filter::State sigma;
  sigma << kOffset0, kSlope0, kCurvature0, kCurvatureRate0, 0.0, 0.0, kTurnBias0, kCameraYaw0;
  Filter::Covariance p = sigma.cwiseAbs2().asDiagonal();
  p.block<2, 2>(kLeft, kLeft) = HalfWidthModel::unknown();
  filter_ = Filter(x, p);
}

void MarkerLaneEstimator::move(const VehicleState& to) {
  const bool broken = !filter_.sound();
  const bool gap = last_ && to_seconds(to.stamp - last_->stamp) > kLongestGap;
  if (last_ && (has_jumped(*last_, to) || to.stamp <= last_->stamp || gap || broken)) reset();
  if (!last_ || !last_paint_) {
    last_ = to;
    return;
  }
  const double dt = to_seconds(to.stamp - last_->stamp);
  const double d = 0.5 * (last_->speed + to.speed) * dt, turn = 0.5 * (last_->yaw_rate + to.yaw_rate) * dt;
  last_ = to;
  Filter::Covariance f = f.Identity(), q = q.Zero();
  f.block<4, 4>(0, 0) << 1.0, d, d * d / 2.0, d * d * d / 6.0,  //
      0.0, 1.0, d, d * d / 2.0,                                 //
      0.0, 0.0, 1.0, d,                                         //
      0.0, 0.0, 0.0, 1.0;
  f(kSlope, kTurnBias) = dt;
  f(kOffset, kTurnBias) = 0.5 * d * dt;  // a turn leads the vehicle off the lane, too
  const double way = std::abs(d);
  q(kOffset, kOffset) = kSlipWalk * kSlipWalk * dt;
  q(kSlope, kSlope) = kHeadingWalk * kHeadingWalk * dt;
  q(kTurnBias, kTurnBias) = kTurnBiasWalk * kTurnBiasWalk * dt;
  q(kCameraYaw, kCameraYaw) = kCameraYawWalk * kCameraYawWalk * dt;
  // Roads are built for a lateral acceleration: what their curvature changes by goes with the square of the
  // speed.
  const double slower = std::pow(kRoadSpeed / std::clamp(std::abs(to.speed), kSlowestRoad, kFastestRoad), 2);
  q(kCurvature, kCurvature) = std::pow(slower * kCurvatureWalk, 2) * way;
  q(kCurvatureRate, kCurvatureRate) = std::pow(slower * kCurvatureRateWalk, 2) * way;
  f.block<2, 2>(kLeft, kLeft) = HalfWidthModel::transition(way);
  q.block<2, 2>(kLeft, kLeft) = HalfWidthModel::noise(way);
  Filter::State turned = turned.Zero();
  turned[kSlope] = -turn;
  turned[kOffset] = -0.5 * d * turn;
  filter_.predict(f, Filter::Covariance::Identity(), turned, q);
  seen_to_ -= d;
  if (seen_to_ < kNothingSeen && to.speed > kSlowest) follow_driver(to, dt);
}

/// Where nothing is seen, the driver knows the road: the lane turns as the vehicle does, and runs along with
/// it.
void MarkerLaneEstimator::follow_driver(const VehicleState& vehicle, double dt) {
  Eigen::Matrix<double, 2, kStates> h = h.Zero();
  h(0, kSlope) = h(1, kCurvature) = 1.0;
  h(1, kTurnBias) = 1.0 / vehicle.speed;
  const Eigen::Vector2d driven(0.0, vehicle.yaw_rate / vehicle.speed);
  const Eigen::Vector2d noise(kDriverSlope * kDriverSlope, kDriverCurvature * kDriverCurvature);
  const Eigen::Matrix2d covariance = (noise / dt).asDiagonal();
  filter_.correct<2>(driven - h * filter_.state(), filter_.expect(h, covariance));
}

MarkerLaneEstimator::Measurement MarkerLaneEstimator::measure(const PaintSamples& paint, Index side) const {
  SampleValues residual;
  Eigen::Matrix<double, kPaintSamples, kStates> jacobian;
  const Cubic center = centerline();
  const double sign = side == kLeft ? 1.0 : -1.0;
  for (int i = 0; i < kPaintSamples; ++i) {
    const Point2& point = paint.points[static_cast<std::size_t>(i)];
    const double x = point.x(), aslant = std::hypot(1.0, center.slope(x));
    auto row = jacobian.row(i);
    row << 1.0, x, x * x / 2.0, x * x * x / 6.0, 0.0, 0.0, 0.0, -x;
    row[side] = sign * aslant;
    residual[i] = point.y() - row.dot(filter_.state());
  }
  const auto fit = least_squares(paint.degree, kPaintSamples);
  return {fit * residual, fit * jacobian};
}

std::vector<std::string> MarkerLaneEstimator::see(const SeenSides& sides, double half_width,
                                                  const NavigationLaneParam& param, Time stamp) {
  if (!last_paint_ && sides.left && sides.right) {  // nothing tells yet which of the two is where it seems
    const double width = sides.left->points.front().y() - sides.right->points.front().y();
    if (!(width > param.min_lane_half_width && width < 4.0 * param.max_lane_half_width)) {
      return {"both are ignored: no lane is between them"};
    }
  }
  if (!last_paint_) start(half_width);
  std::vector<std::string> ignored = correct(sides, stamp);
  if (last_paint_ == stamp) {
    refused_since_.reset();
  } else if (!ignored.empty()) {
    if (!refused_since_) refused_since_ = stamp;
    if (to_seconds(stamp - *refused_since_) > kPatience) {  // the vehicle is in another lane, or was astray
      start(half_width);
      ignored = correct(sides, stamp);
      refused_since_.reset();
    }
  }
  const double mean = 0.5 * (filter_.state()[kLeft] + filter_.state()[kRight]);
  // Begun with an outlier, a lane may seem to be one that there is not.
  if (!filter_.sound() ||
      !(mean < kWidthMargin * param.max_lane_half_width && mean > param.min_lane_half_width / kWidthMargin)) {
    reset();
  }
  return ignored;
}

std::vector<std::string> MarkerLaneEstimator::correct(const SeenSides& sides, Time stamp) {
  std::vector<std::string> ignored;
  struct Seen {
    Index side;
    const PaintSamples* paint;
    const char* name;
    double distance;
  };
  std::vector<Seen> seen;
  if (sides.left) seen.push_back({kLeft, &*sides.left, "left", 0.0});
  if (sides.right) seen.push_back({kRight, &*sides.right, "right", 0.0});
  const auto distance_of = [&](const Seen& one) {
    const Measurement m = measure(*one.paint, one.side);
    return filter_.expect(m.jacobian, one.paint->covariance).squared_distance(m.innovation);
  };
  for (Seen& one : seen) one.distance = distance_of(one);
  if (seen.size() == 2 && seen[1].distance < seen[0].distance) std::swap(seen[0], seen[1]);
  bool any = false;
  for (Seen& one : seen) {
    if (any) one.distance = distance_of(one);  // the surer side has moved the state
    if (one.distance > kGate) {
      ignored.push_back(std::string(one.name) + " is ignored: it is not where this lane's paint is expected");
      continue;
    }
    const Measurement m = measure(*one.paint, one.side);
    filter_.correct(m.innovation, filter_.expect(m.jacobian, one.paint->covariance));
    if (!any) left_paint_ = right_paint_ = BoundaryType::kUnknown;
    (one.side == kLeft ? left_paint_ : right_paint_) = one.paint->type;
    seen_to_ = any ? std::max(seen_to_, one.paint->to) : one.paint->to;
    any = true;
  }
  if (any) last_paint_ = stamp;
  return ignored;
}

Cubic MarkerLaneEstimator::centerline() const {
  const Filter::State& x = filter_.state();
  return {x[kOffset], x[kSlope], x[kCurvature] / 2.0, x[kCurvatureRate] / 6.0};
}

}  // namespace relative_map::core
