#include "relative_map/pipeline/estimation/lane_filter.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kBehind = 1.5;  // knots behind the vehicle
constexpr double kMostAslant =
    0.3;                        // [-] cosine between the camera's side and the line's: paint that leads away
constexpr double kBend = 0.05;  // [m] of the line along the paint
constexpr double kStraightDoubt = 0.03;  // [-] of the difference between both
constexpr double kSharp = 0.4;           // [rad]
constexpr double kMisfit = 6.0;  // [-] standard deviations of what a polynomial can't follow, in what it can
// [m/sqrt(s)] at least, of localization's bias along the way, where paint shows nothing of it but odometry
// does: SLAM that drifts by 1 % of the way makes as much at 10 m/s.
constexpr double kAlongWalk = 0.25;
constexpr double kHalfWidthWalk =
    0.01;  // [m] by the root of the way [m]: lanes widen by metres over hundreds of them
constexpr double kRecordingWalk =
    0.005;                             // [m] by the root of the way [m]: drivers change their habits slowly
constexpr double kOtherLane = 0.15;    // [m] of one lane's half width from another's
constexpr double kPoseGate = 16.0;     // squared, in standard deviations of a pose: localization has jumped
constexpr double kHeadingGate = 16.0;  // squared, likewise

double squared(double value) {
  return value * value;
}

}  // namespace

LaneFilter::LaneFilter(const SensorNoise& noise, const VehicleState& localized, double half_width,
                       double sway)
    : noise_(noise),
      sway_(sway),
      expected_half_width_(half_width),
      origin_(localized.map_from_base.position()) {
  auto& x = filter_.state();
  auto& p = filter_.covariance();
  x[kHeading] = localized.map_from_base.heading();
  x[kHalfWidth] = half_width;
  const LocalizationNoise& loc = noise_.localization;
  const Eigen::Vector3d bias(squared(loc.position_bias), squared(loc.position_bias),
                             squared(loc.heading_bias));
  const Eigen::Vector3d white(squared(loc.least_position_noise), squared(loc.least_position_noise),
                              squared(loc.least_heading_noise));
  p.block<3, 3>(kBiasX, kBiasX) = bias.asDiagonal();
  p.block<3, 3>(kX, kX) = (bias + white).asDiagonal();
  p.block<3, 3>(kX, kBiasX) = p.block<3, 3>(kBiasX, kX) = -p.block<3, 3>(kBiasX, kBiasX);
  p(kYawRateBias, kYawRateBias) = squared(noise_.odometry.yaw_rate_bias);
  p(kSpeedScale, kSpeedScale) = squared(noise_.odometry.speed_scale);
  p(kCameraOffset, kCameraOffset) = squared(noise_.camera.mount_offset);
  p(kCameraYaw, kCameraYaw) = squared(noise_.camera.mount_yaw);
  p(kHalfWidth, kHalfWidth) = squared(noise_.road.half_width);
  p(kRecording, kRecording) = squared(noise_.road.recording);
  p.bottomRightCorner<OffsetProfile::kKnots, OffsetProfile::kKnots>() = OffsetProfile::prior(sway_);
}

void LaneFilter::move(const VehicleState& from, const VehicleState& to, double position_walk,
                      double decay_time, bool unseen) {
  const double dt = to_seconds(to.stamp - from.stamp);
  const auto& x = filter_.state();
  const OdometryNoise& odometry = noise_.odometry;
  const double told = 0.5 * (from.speed + to.speed) * dt, way = told * (1.0 + x[kSpeedScale]);
  const double turn = (0.5 * (from.yaw_rate + to.yaw_rate) - x[kYawRateBias]) * dt;
  const double heading = x[kHeading] + 0.5 * turn;
  const Point2 ahead(std::cos(heading), std::sin(heading)), left = left_of(ahead);

  using Moved = Eigen::Matrix<double, 5, 1>;  // yaw rate bias, speed scale, x, y, heading
  Eigen::Matrix<double, 5, 5> f = f.Identity(), q = q.Zero();
  f.block<2, 1>(2, 0) = -0.5 * dt * way * left;
  f.block<2, 1>(2, 1) = told * ahead;
  f.block<2, 1>(2, 4) = way * left;
  f(4, 0) = -dt;
  const double turned = std::abs(turn);
  const double along = squared(odometry.speed_noise) * dt;
  const double aside = squared(odometry.slip) * dt + squared(odometry.slip_in_turns) * turned;
  q(0, 0) = squared(odometry.yaw_rate_bias_walk) * dt;
  q(1, 1) = squared(odometry.speed_scale_walk) * dt;
  q.block<2, 2>(2, 2) = along * ahead * ahead.transpose() + aside * left * left.transpose();
  q(4, 4) = squared(odometry.yaw_rate_noise) * dt + squared(odometry.yaw_rate_scale) * turned;
  Moved moved = x.segment<5>(kYawRateBias);
  moved.segment<2>(2) += way * ahead;
  moved[4] += turn;
  filter_.predict_part<kYawRateBias, 5>(moved, f, q);

  const LocalizationNoise& loc = noise_.localization;
  const double kept = std::exp(-dt / decay_time);
  Eigen::Matrix3d walk = walk.Zero();
  const double along_walk = to.speed_by_poses ? position_walk : std::max(position_walk, kAlongWalk);
  walk.topLeftCorner<2, 2>() =
      squared(along_walk) * ahead * ahead.transpose() + squared(position_walk) * left * left.transpose();
  walk(2, 2) = squared(loc.heading_walk);
  filter_.predict_part<kBiasX, 3>(kept * x.segment<3>(kBiasX), kept * Eigen::Matrix3d::Identity(),
                                  Eigen::Matrix3d(dt * walk));

  // The mount's errors come and go: Gauss-Markov processes. The direction keeps what is steady of it.
  const CameraNoise& camera = noise_.camera;
  const double mount = std::exp(-dt / camera.mount_time);
  using One = Eigen::Matrix<double, 1, 1>;
  filter_.predict_part<kCameraOffset, 1>(One(mount * x[kCameraOffset]), One(mount),
                                         One(squared(camera.mount_offset) * (1.0 - mount * mount)));
  filter_.covariance()(kCameraYaw, kCameraYaw) += squared(camera.slope) * (1.0 - mount * mount);
  const double width_kept = unseen ? std::exp(-dt / decay_time) : 1.0,
               unknown = squared(noise_.road.half_width);
  filter_.predict_part<kHalfWidth, 1>(
      One(expected_half_width_ + width_kept * (x[kHalfWidth] - expected_half_width_)), One(width_kept),
      One(std::min(squared(kHalfWidthWalk) * std::abs(way), unknown)));
  filter_.covariance()(kRecording, kRecording) += squared(kRecordingWalk) * std::abs(way);
}

void LaneFilter::localize(const VehicleState& localized, double position_stddev, double heading_stddev) {
  const auto& x = filter_.state();
  auto& p = filter_.covariance();
  const Point2 gap = localized.map_from_base.position() - origin_ - x.segment<2>(kX) - x.segment<2>(kBiasX);
  const double turned = angle_difference(localized.map_from_base.heading(), x[kHeading] + x[kBiasHeading]);
  const Eigen::Vector3d noise(position_stddev, position_stddev, heading_stddev);
  const auto expect = [&] {  // pose plus bias
    KalmanFilter<kStates>::Expected<3> expected;
    expected.cross = p.middleCols<3>(kX) + p.middleCols<3>(kBiasX);
    expected.covariance = expected.cross.middleRows<3>(kX) + expected.cross.middleRows<3>(kBiasX);
    expected.covariance.diagonal() += noise.cwiseAbs2();
    return expected;
  };
  auto expected = expect();
  const Eigen::Matrix2d place = expected.covariance.topLeftCorner<2, 2>();
  // Place and heading jump apart: a receiver's multipath turns no antenna.
  if (gap.dot(place.llt().solve(gap)) > kPoseGate) {
    p(kBiasX, kBiasX) += gap.squaredNorm();
    p(kBiasY, kBiasY) += gap.squaredNorm();
  }
  if (squared(turned) > kHeadingGate * expected.covariance(2, 2))
    p(kBiasHeading, kBiasHeading) += squared(turned);
  filter_.correct<3>({gap.x(), gap.y(), turned}, expect());
}

double LaneFilter::s_along(const NavigationLine& line, double s) const {
  const double step = s - last_s_;
  return line_s_ + (line.closed() ? std::remainder(step, line.length) : step);
}

void LaneFilter::follow(const NavigationLine& line, double s) {
  constexpr int kKnots = OffsetProfile::kKnots;
  constexpr double kSpacing = OffsetProfile::kSpacing;
  const double moved = s_along(line, s) - line_s_;
  last_s_ = s;
  auto& x = filter_.state();
  auto& p = filter_.covariance();
  if (line.id != line_id_ || !(std::abs(moved) <= kKnots * kSpacing)) {  // NaN is no way either
    const bool other = !line_id_.empty();
    line_id_ = line.id;
    line_s_ = s;
    first_knot_s_ = line_s_ - kBehind * kSpacing;
    // Each line has been recorded with errors of its own, and each lane has its width.
    const auto forget = [&](int first, int count) {
      x.segment(first, count).setZero();
      p.middleRows(first, count).setZero();
      p.middleCols(first, count).setZero();
    };
    forget(kFirstKnot, kKnots);
    p.bottomRightCorner<kKnots, kKnots>() = OffsetProfile::prior(sway_);
    if (!other) return;
    forget(kRecording, 1);
    p(kRecording, kRecording) = squared(noise_.road.recording);
    p(kHalfWidth, kHalfWidth) += squared(kOtherLane);
    return;
  }
  line_s_ += moved;
  const OffsetProfile::Next next = OffsetProfile::next(sway_);
  while (std::abs(line_s_ - first_knot_s_ - kBehind * kSpacing) > 0.5 * kSpacing) {
    const bool ahead = line_s_ - first_knot_s_ > kBehind * kSpacing;
    Eigen::Matrix<double, kStates, kStates> f = f.Identity(), q = q.Zero();
    f.bottomRightCorner<kKnots, kKnots>().setZero();
    const int first = kFirstKnot, last = kFirstKnot + kKnots - 1;
    for (int i = 1; i < kKnots; ++i) {
      ahead ? f(first + i - 1, first + i) = 1.0 : f(first + i, first + i - 1) = 1.0;
    }
    const int fresh = ahead ? last : first, inward = ahead ? -1 : 1;
    f(fresh, fresh) = next.from_near;  // by the knots as they were numbered before
    f(fresh, fresh + inward) = next.from_far;
    q(fresh, fresh) = next.variance;
    filter_.predict(f, q);
    first_knot_s_ += ahead ? kSpacing : -kSpacing;
  }
}

std::optional<LaneFilter::Measurement> LaneFilter::measure(const PaintSamples& paint, Side side,
                                                           const NavigationLine& line, std::size_t vertex,
                                                           double scale) const {
  const auto& x = filter_.state();
  const Pose2 camera(Point2(x[kX], x[kY]), x[kHeading] + x[kCameraYaw]);
  const Point2 to_left = left_of(camera.forward()), line_origin = line.origin - origin_;
  const double sign = side == Side::kLeft ? 1.0 : -1.0;
  SampleValues residual = residual.Zero();
  Eigen::Matrix<double, kPaintSamples, kStates> jacobian = jacobian.Zero();
  LineWalker walker(line, vertex);
  int seen = 0;
  double bend = 0.0;  // [rad] of the line along the paint
  Point2 first_normal = Point2::Zero();
  for (; seen < kPaintSamples; ++seen) {
    const Point2 arm =
        camera.rotate_to_parent(paint.points[static_cast<std::size_t>(seen)] + Point2(0.0, x[kCameraOffset]));
    const BesideLine beside = walker.beside(camera.position() + arm - line_origin);
    // The camera measures square to its own axis.
    const double aslant = beside.normal.dot(to_left);
    if (!beside.exists || !std::isfinite(beside.s) || !std::isfinite(beside.lateral) || aslant < kMostAslant)
      break;
    if (seen == 0) first_normal = beside.normal;
    bend = std::max(bend, std::acos(std::min(1.0, first_normal.dot(beside.normal))));
    auto row = jacobian.row(seen);
    row[kX] = -beside.normal.x();
    row[kY] = -beside.normal.y();
    row[kHeading] = row[kCameraYaw] = -beside.normal.dot(left_of(arm));
    row[kCameraOffset] = -aslant;
    row[kHalfWidth] = sign;
    row[kRecording] = 1.0;
    row.tail<OffsetProfile::kKnots>() = OffsetProfile::shares(knots_at(line, beside.s));
    residual[seen] = beside.lateral - sign * x[kHalfWidth] - x[kRecording] -
                     row.tail<OffsetProfile::kKnots>().dot(x.tail<OffsetProfile::kKnots>());
    residual[seen] /= aslant;
    row /= aslant;
  }
  if (seen < 2) return std::nullopt;
  // What a camera makes of a sharp corner is anybody's guess.
  return fit(paint, residual, jacobian, seen, scale * (1.0 + std::pow(bend / kSharp, 4)));
}

/// As the camera fits what it sees: a polynomial, which can't follow every bend.
LaneFilter::Measurement LaneFilter::fit(const PaintSamples& paint, const SampleValues& residual,
                                        const Eigen::Matrix<double, kPaintSamples, kStates>& jacobian,
                                        int seen, double scale) const {
  Measurement result;
  auto fit = least_squares(paint.degree, seen);
  result.innovation = fit * residual;
  int terms = std::min(paint.degree + 1, kPaintTerms);
  PaintTerms unsure = unsure.Zero();  // between two ways to fit
  if (paint.straight && result.innovation.tail<2>().norm() > kBend) {
    // Paint that is straight where the line is not: this camera lays straight lines, whatever it says. Only
    // its near end counts, and less where a straight line through all of the paint would lie elsewhere.
    unsure[0] = kStraightDoubt * (residual[0] - least_squares(1, seen).row(0).dot(residual));
    fit.setZero();
    fit(0, 0) = 1.0;
    result.innovation = fit * residual;
    terms = 1;
  }
  result.jacobian = fit * jacobian;
  result.covariance = Eigen::Matrix4d::Identity();
  result.covariance.topLeftCorner(terms, terms) = scale * paint.covariance.topLeftCorner(terms, terms);
  result.covariance += unsure * unsure.transpose();
  // Where it can't, its weights are not known to be ours.
  const SampleValues misfit = residual - sample_powers() * result.innovation;
  const double variance = terms == 1 ? 0.0 : misfit.head(seen).squaredNorm() / seen;
  result.covariance += kMisfit * kMisfit * variance * fit * fit.transpose();
  result.expected = filter_.expect(result.jacobian, result.covariance);
  result.squared_distance = result.expected.squared_distance(result.innovation);
  return result;
}

void LaneFilter::shift(const Point2& normal, double by, double stddev) {
  auto& x = filter_.state();
  auto& p = filter_.covariance();
  x.segment<2>(kX) += by * normal;
  x.segment<2>(kBiasX) -= by * normal;
  const Eigen::Matrix2d unsure = squared(stddev) * normal * normal.transpose();
  p.block<2, 2>(kX, kX) += unsure;
  p.block<2, 2>(kBiasX, kBiasX) += unsure;
  p.block<2, 2>(kX, kBiasX) -= unsure;
  p.block<2, 2>(kBiasX, kX) -= unsure;
}

Estimate LaneFilter::lateral(const Point2& normal) const {
  Eigen::Matrix<double, 1, kStates> h = h.Zero();
  h[kX] = -normal.x();
  h[kY] = -normal.y();
  h[kRecording] = 1.0;
  h.tail<OffsetProfile::kKnots>() =
      OffsetProfile::shares((line_s_ - first_knot_s_) / OffsetProfile::kSpacing);
  const auto knots = h.tail<OffsetProfile::kKnots>();
  const double offset = normal.dot(filter_.state().segment<2>(kBiasX)) + filter_.state()[kRecording] +
                        knots.dot(filter_.state().tail<OffsetProfile::kKnots>());
  return {offset, std::sqrt(std::max(0.0, (h * filter_.covariance() * h.transpose())(0, 0)))};
}

}  // namespace relative_map::core
