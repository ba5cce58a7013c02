#include "relative_map/pipeline/lane_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "relative_map/pipeline/half_width_model.hpp"

namespace relative_map::core {

namespace {

// Standard deviations at the start.
constexpr double kBias0 = 0.6;             // [m]
constexpr double kHeadingBias0 = 0.01;     // [rad]
// Of localization, white from message to message.
constexpr double kPositionNoise = 0.03;    // [m]
constexpr double kHeadingNoise = 0.0035;   // [rad]
// Random walks, by the root of the time [s].
constexpr double kBiasWalk = 0.08;         // [m]
constexpr double kHeadingBiasWalk = 0.0015;  // [rad]
constexpr double kHeadingWalk = 0.002;     // [rad] of odometry
constexpr double kSlipWalk = 0.02;         // [m] of odometry, sideways
constexpr double kSpeedWalk = 0.05;        // [m] of odometry, along
constexpr double kSpeedScale = 0.01;       // [-] of the speed, besides

constexpr double kJumpDistance = 40.0;  // squared, in standard deviations: localization has jumped
constexpr double kGate = 30.0;          // squared, in standard deviations: not this lane's paint
constexpr double kOffsetGate = 3.5;     // standard deviations of a marker's mean offset
constexpr double kNearEdge = 0.5;       // [m] from its border the vehicle may be taken to be in either lane
constexpr double kSameBorder = 0.6;     // [m] by which paint may be off to be the border that it is not called
constexpr double kPatience = 0.7;       // [s] of paint that agrees on something else, until it is believed
constexpr double kMaxSurprise = 1.4;    // [m] that it may differ by: less than half a lane
constexpr double kRecording = 0.4;      // [m] of one line against another
constexpr double kOtherWidth = 0.1;     // [m] of one lane against another
constexpr double kMaxBias = 30.0;       // [m] of localization, and ...
constexpr double kMaxHeadingBias = 0.1;  // [rad] ... no estimate beyond them is one
constexpr double kLostTime = 2.5;       // [s] in which none of the paint counted: the estimate is wrong
constexpr double kHoldTime = 1.0;       // [s] without paint until the estimate starts to decay
constexpr double kDecayTime = 30.0;     // [s] of the decay
constexpr double kForgetTime = 60.0;    // [s] without paint until nothing is left worth having
constexpr double kUnseen = 1e4;         // [m^2] variance of a sample that has no line beside it
constexpr double kBehind = 1.5;         // knots behind the vehicle

using Vector3 = Eigen::Vector3d;

Point2 normal_of(double heading) {
  return {-std::sin(heading), std::cos(heading)};
}

/// Where a point lies beside a line, found from the segment where the last one was.
struct Beside {
  double s;        ///< [m]
  double lateral;  ///< [m] left positive
  Point2 normal;   ///< to the left
  bool exists;     ///< false: beyond an end
};

class LineWalker {
 public:
  LineWalker(const NavigationLine& line, std::size_t vertex) : line_(line), segment_(vertex) {
    if (!line.closed()) segment_ = std::min(segment_, line.points.size() - 2);
  }

  Beside beside(const Point2& point) {
    Foot foot = project(point);
    int last_step = 0;
    while (true) {
      const int step = foot.fraction >= 1.0 && can_step(1) ? 1 : foot.fraction <= 0.0 && can_step(-1) ? -1 : 0;
      if (step == 0 || step == -last_step) break;
      take(step);
      last_step = step;
      foot = project(point);
    }
    const PathPoint &a = first(), &b = second();
    const Point2 direction = (a.direction + foot.fraction * (b.direction - a.direction)).normalized();
    const Point2 offset = point - foot.point;
    const bool beyond = (foot.fraction >= 1.0 || foot.fraction <= 0.0) && std::abs(direction.dot(offset)) > 0.5;
    return {a.s + foot.fraction * length(), cross(direction, offset), left_of(direction), !beyond};
  }

 private:
  const PathPoint& first() const { return line_.points[segment_]; }
  const PathPoint& second() const {
    return line_.points[segment_ + 1 == line_.points.size() ? 0 : segment_ + 1];
  }
  double length() const {
    return (segment_ + 1 == line_.points.size() ? line_.length : second().s) - first().s;
  }
  Foot project(const Point2& point) const {
    return project_on_segment(first().position, second().position, point);
  }
  bool can_step(int step) const {
    return line_.closed() || (step > 0 ? segment_ + 2 < line_.points.size() : segment_ > 0);
  }
  void take(int step) {
    const std::size_t n = line_.points.size();  // of segments, on a lap
    segment_ = line_.closed() ? (segment_ + n + static_cast<std::size_t>(step + 1) - 1) % n
                              : segment_ + static_cast<std::size_t>(step + 1) - 1;
  }

  const NavigationLine& line_;
  std::size_t segment_;
};

}  // namespace

void LaneEstimator::start(const VehicleState& localized) {
  *this = [&] {
    LaneEstimator fresh;
    fresh.half_width_ = half_width_;
    return fresh;
  }();
  origin_ = localized.map_from_base.position();
  Filter::State& x = filter_.state();
  Filter::Covariance& p = filter_.covariance();
  x[kHeading] = localized.map_from_base.heading();
  const Vector3 bias(kBias0 * kBias0, kBias0 * kBias0, kHeadingBias0 * kHeadingBias0);
  const Vector3 noise(kPositionNoise * kPositionNoise, kPositionNoise * kPositionNoise,
                      kHeadingNoise * kHeadingNoise);
  p.block<3, 3>(kBiasX, kBiasX) = bias.asDiagonal();
  p.block<3, 3>(kX, kX) = (bias + noise).asDiagonal();
  p.block<3, 3>(kX, kBiasX) = p.block<3, 3>(kBiasX, kX) = -p.block<3, 3>(kBiasX, kBiasX);
  x[kLeft] = x[kRight] = half_width_;
  p.block<2, 2>(kLeft, kLeft) = HalfWidthModel::unknown();
  p.block<OffsetProfile::kKnots, OffsetProfile::kKnots>(kFirstKnot, kFirstKnot) = OffsetProfile::prior();
  last_ = localized;
}

void LaneEstimator::expect_half_width(double half_width) {
  half_width_ = half_width;
}

void LaneEstimator::move(const VehicleState& localized) {
  const bool forgotten = last_paint_ && to_seconds(localized.stamp - *last_paint_) > kForgetTime;
  // Without paint there is nothing to tell bias from place by.
  if (!last_ || !informed() || forgotten || has_jumped(*last_, localized) || localized.stamp <= last_->stamp) {
    start(localized);
    return;
  }
  follow_odometry(localized);
  follow_localization(localized);
  last_ = localized;
  const Filter::State& x = filter_.state();
  if (x.segment<2>(kBiasX).norm() > kMaxBias || std::abs(x[kBiasHeading]) > kMaxHeadingBias) start(localized);
}

void LaneEstimator::follow_odometry(const VehicleState& to) {
  const double dt = to_seconds(to.stamp - last_->stamp);
  const double way = 0.5 * (last_->speed + to.speed) * dt, turn = 0.5 * (last_->yaw_rate + to.yaw_rate) * dt;
  const double unseen = to_seconds(to.stamp - *last_paint_);
  const double kept = unseen > kHoldTime ? std::exp(-dt / kDecayTime) : 1.0;

  using Part = Eigen::Matrix<double, kFirstKnot, kFirstKnot>;
  Eigen::Matrix<double, kFirstKnot, 1> x = filter_.state().head<kFirstKnot>();
  const double heading = x[kHeading] + 0.5 * turn;
  const Point2 ahead(std::cos(heading), std::sin(heading)), left = left_of(ahead);
  Part f = f.Identity(), q = q.Zero();
  f.block<2, 1>(kX, kHeading) = way * left;
  f.block<3, 3>(kX, kBiasX) = (1.0 - kept) * Eigen::Matrix3d::Identity();  // back to what localization says
  f.block<3, 3>(kBiasX, kBiasX) = kept * Eigen::Matrix3d::Identity();
  f.block<2, 2>(kLeft, kLeft) = HalfWidthModel::transition(std::abs(way));
  x.segment<3>(kX) +=
      (1.0 - kept) * x.segment<3>(kBiasX) + Vector3(way * ahead.x(), way * ahead.y(), turn);
  x.segment<3>(kBiasX) *= kept;
  x.segment<2>(kLeft) = (f.block<2, 2>(kLeft, kLeft) * x.segment<2>(kLeft)).eval();
  const double along = kSpeedWalk * kSpeedWalk * dt + kSpeedScale * kSpeedScale * std::abs(to.speed * way);
  const double aside = kSlipWalk * kSlipWalk * dt;
  q.block<2, 2>(kX, kX) = along * ahead * ahead.transpose() + aside * left * left.transpose();
  q(kHeading, kHeading) = kHeadingWalk * kHeadingWalk * dt;
  q(kBiasX, kBiasX) = q(kBiasY, kBiasY) = kBiasWalk * kBiasWalk * dt;
  q(kBiasHeading, kBiasHeading) = kHeadingBiasWalk * kHeadingBiasWalk * dt;
  q.block<2, 2>(kLeft, kLeft) = HalfWidthModel::noise(std::abs(way));
  filter_.predict_first<kFirstKnot>(x, f, q);
}

void LaneEstimator::follow_localization(const VehicleState& localized) {
  Filter::State& x = filter_.state();
  const Point2 position = localized.map_from_base.position() - origin_;
  const auto innovation = [&]() -> Vector3 {
    return {position.x() - x[kX] - x[kBiasX], position.y() - x[kY] - x[kBiasY],
            angle_difference(localized.map_from_base.heading(), x[kHeading] + x[kBiasHeading])};
  };
  Jacobian<3> h = h.Zero();
  h.block<3, 3>(0, kX) = h.block<3, 3>(0, kBiasX) = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d r = Vector3(kPositionNoise * kPositionNoise, kPositionNoise * kPositionNoise,
                                    kHeadingNoise * kHeadingNoise)
                                .asDiagonal();
  const Vector3 gap = innovation();
  if (filter_.squared_distance(gap, h, r) > kJumpDistance) {
    // Vehicles do not jump, localization does: its bias is another one now. Headings are another matter:
    // localization's hardly drift, and odometry's do where a yaw rate is wrong.
    x.segment<2>(kBiasX) += gap.head<2>();
    x[kHeading] += gap[2];
    for (int i = 0; i < 2; ++i) filter_.covariance()(kBiasX + i, kBiasX + i) += 0.05 * gap[i] * gap[i];
    filter_.covariance()(kHeading, kHeading) += gap[2] * gap[2];
  }
  filter_.correct(innovation(), h, r);
}

void LaneEstimator::keep_profile_beside(const NavigationLine& line, const LineProjection& projection) {
  const double step = projection.s - last_projected_s_;
  const double moved = line.closed() ? std::remainder(step, line.length) : step;
  last_projected_s_ = projection.s;
  constexpr int kKnots = OffsetProfile::kKnots;
  constexpr double kSpacing = OffsetProfile::kSpacing;
  Filter::State& x = filter_.state();
  Filter::Covariance& p = filter_.covariance();
  if (line.id != line_id_ || std::abs(moved) > kKnots * kSpacing) {
    line_id_ = line.id;
    line_s_ = projection.s;
    first_knot_s_ = line_s_ - kBehind * kSpacing;
    x.tail<kKnots>().setZero();
    p.rightCols<kKnots>().setZero();
    p.bottomRows<kKnots>().setZero();
    p.bottomRightCorner<kKnots, kKnots>() = OffsetProfile::prior();
    // Each line has been recorded with an error of its own, and each lane has its width.
    doubt_bias(kRecording * kRecording);
    p.block<2, 2>(kLeft, kLeft) += HalfWidthModel::covariance(kOtherWidth * kOtherWidth, 0.0);
    return;
  }
  line_s_ += moved;
  const OffsetProfile::Next next = OffsetProfile::next();
  while (std::abs(line_s_ - first_knot_s_ - kBehind * kSpacing) > 0.5 * kSpacing) {
    const bool ahead = line_s_ - first_knot_s_ > kBehind * kSpacing;
    Filter::Covariance f = f.Identity(), q = q.Zero();
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

std::optional<LaneEstimator::Measurement> LaneEstimator::measure(const PaintSamples& paint, Index side,
                                                                 const NavigationLine& line,
                                                                 std::size_t vertex) const {
  const Filter::State& x = filter_.state();
  const Pose2 pose(Point2(x[kX], x[kY]), x[kHeading]);
  const Point2 line_origin = line.origin - origin_;
  const double sign = side == kLeft ? 1.0 : -1.0;
  Measurement result;
  result.jacobian.setZero();
  result.innovation.setZero();
  result.covariance = paint.covariance;
  LineWalker walker(line, vertex);
  int seen = 0;
  for (int i = 0; i < kPaintSamples; ++i) {
    const Point2& point = paint.points[static_cast<std::size_t>(i)];
    const Point2 arm = pose.rotate_to_parent(point);
    const Beside beside = walker.beside(pose.position() + arm - line_origin);
    if (!beside.exists) {
      result.covariance(i, i) += kUnseen;
      continue;
    }
    ++seen;
    const double s = line_s_ + (line.closed() ? std::remainder(beside.s - last_projected_s_, line.length)
                                              : beside.s - last_projected_s_);
    auto row = result.jacobian.row(i);
    row[kX] = -beside.normal.x();
    row[kY] = -beside.normal.y();
    row[kHeading] = -beside.normal.dot(left_of(arm));
    row[side] = sign;
    row.tail<OffsetProfile::kKnots>() = OffsetProfile::shares((s - first_knot_s_) / OffsetProfile::kSpacing);
    // Expected: where the lane's border is; measured: where the paint is.
    result.innovation[i] = beside.lateral - sign * x[side] -
                           row.tail<OffsetProfile::kKnots>().dot(x.tail<OffsetProfile::kKnots>());
  }
  if (seen < 2) return std::nullopt;
  result.squared_distance =
      filter_.squared_distance(result.innovation, result.jacobian, result.covariance);
  return result;
}

bool LaneEstimator::fits(const Measurement& measurement) const {
  if (measurement.squared_distance > kGate) return false;
  // The mean by itself, too: five numbers hide a shift of all of them.
  return std::abs(measurement.mean_offset()) < kOffsetGate * mean_stddev(measurement);
}

double LaneEstimator::mean_stddev(const Measurement& measurement) const {
  const Jacobian<1> h = measurement.weights().transpose() * measurement.jacobian;
  const auto weights = measurement.weights();
  return std::sqrt((h * filter_.covariance() * h.transpose() +
                    weights.transpose() * measurement.covariance * weights)(0, 0));
}

Eigen::Matrix<double, kPaintSamples, 1> LaneEstimator::Measurement::weights() const {
  Eigen::Matrix<double, kPaintSamples, 1> weights = covariance.diagonal().cwiseInverse();
  return weights / weights.sum();
}

std::vector<std::string> LaneEstimator::see(const SeenSides& sides, const NavigationLine& line,
                                            const LineProjection& projection, Time stamp) {
  std::vector<std::string> ignored;
  if (!last_) return ignored;
  keep_profile_beside(line, projection);
  const Filter::State& x = filter_.state();
  struct Seen {
    Index side;
    const std::optional<PaintSamples>* paint;
    const char* name;
    std::optional<Measurement> measurement;
  };
  std::array<Seen, 2> seen{Seen{kLeft, &sides.left, "left", {}}, Seen{kRight, &sides.right, "right", {}}};
  const auto measure_again = [&](Seen& one) {
    one.measurement.reset();
    if (*one.paint) one.measurement = measure(**one.paint, one.side, line, projection.nearest_vertex);
  };
  for (Seen& one : seen) measure_again(one);
  // Beside a border the camera and the map may not be of one mind yet on which lane the vehicle is in: the
  // lane's left border may be on the right of the camera already, and the other way round.
  const double to_left = x[kLeft] - projection.l, to_right = x[kRight] + projection.l;
  if (std::min(to_left, to_right) < kNearEdge) {
    const bool at_left = to_left < to_right;
    Seen &border = seen[at_left ? 0 : 1], &beyond = seen[at_left ? 1 : 0];
    Seen crossed{border.side, beyond.paint, beyond.name, {}};
    measure_again(crossed);
    const double offset = crossed.measurement ? std::abs(crossed.measurement->mean_offset()) : kSameBorder;
    if (offset < kSameBorder && !(border.measurement && std::abs(border.measurement->mean_offset()) < offset)) {
      border = crossed;
      beyond.measurement.reset();
    }
  }
  const auto distance = [](const Seen& one) {
    return one.measurement ? one.measurement->squared_distance : std::numeric_limits<double>::max();
  };
  if (distance(seen[1]) < distance(seen[0])) std::swap(seen[0], seen[1]);

  bool any = false;
  for (Seen& one : seen) {
    if (any) measure_again(one);  // the surer side has moved the state
    if (!one.measurement) continue;
    if (fits(*one.measurement)) {
      filter_.correct(one.measurement->innovation, one.measurement->jacobian, one.measurement->covariance);
      if (!any) left_paint_ = right_paint_ = BoundaryType::kUnknown;
      (one.side == kLeft ? left_paint_ : right_paint_) = (*one.paint)->type;
      const double range = (*one.paint)->to;
      paint_range_ = any ? std::max(paint_range_, range) : range;
      any = true;
    } else {
      std::ostringstream reason;
      reason.precision(2);
      reason << one.name << " is ignored: it is " << one.measurement->mean_offset()
             << " m aside of where this lane's paint is expected";
      ignored.push_back(reason.str());
    }
  }
  if (any) {
    last_paint_ = stamp;
    disagreeing_since_.reset();
    refused_since_.reset();
  } else if (!ignored.empty()) {
    reconsider(seen[0].measurement, seen[1].measurement, stamp);
    if (!refused_since_) refused_since_ = stamp;
    if (to_seconds(stamp - *refused_since_) > kLostTime) start(*last_);
  }
  return ignored;
}

void LaneEstimator::reconsider(const std::optional<Measurement>& first,
                               const std::optional<Measurement>& second, Time stamp) {
  const bool agree = first && second && std::abs(first->mean_offset() - second->mean_offset()) < 0.5;
  if (!agree || std::abs(first->mean_offset()) > kMaxSurprise) {
    disagreeing_since_.reset();
    return;
  }
  if (!disagreeing_since_) disagreeing_since_ = stamp;
  if (to_seconds(stamp - *disagreeing_since_) < kPatience) return;
  // Both borders say the same for long: the bias is another one than was thought.
  doubt_bias(first->mean_offset() * first->mean_offset());
  disagreeing_since_.reset();
}

/// Localization's bias may have changed by so much [m^2], and the vehicle's place with it.
void LaneEstimator::doubt_bias(double variance) {
  Filter::Covariance& p = filter_.covariance();
  for (int i = 0; i < 2; ++i) {
    p(kX + i, kX + i) += variance;
    p(kBiasX + i, kBiasX + i) += variance;
    p(kX + i, kBiasX + i) -= variance;
    p(kBiasX + i, kX + i) -= variance;
  }
}

VehicleState LaneEstimator::corrected(const VehicleState& localized) const {
  if (!informed()) return localized;
  VehicleState state = localized;
  const Filter::State& x = filter_.state();
  state.map_from_base = Pose2(origin_ + Point2(x[kX], x[kY]), normalize_angle(x[kHeading]));
  return state;
}

bool LaneEstimator::apply(LanePath& lane) const {
  if (!informed() || lane.id != line_id_) return false;
  lane.left_half_width = filter_.state()[kLeft];
  lane.right_half_width = filter_.state()[kRight];
  lane.seen = {lane.left_half_width, lane.right_half_width, lane.s_at_vehicle + paint_range_};
  const OffsetProfile profile(filter_.state().tail<OffsetProfile::kKnots>());
  const double start = (line_s_ - first_knot_s_ - lane.s_at_vehicle) / OffsetProfile::kSpacing;
  for (PathPoint& point : lane.points) {
    point.position += profile.at(start + point.s / OffsetProfile::kSpacing) * left_of(point.direction);
  }
  compute_arc_length(lane.points);
  compute_geometry(lane.points);
  locate_vehicle(lane);
  return true;
}

FusionState LaneEstimator::state(const LineProjection& projection, double heading) const {
  FusionState state;
  state.method = "estimator";
  if (!informed()) return state;
  const Filter::State& x = filter_.state();
  const Filter::Covariance& p = filter_.covariance();
  const double line_heading = heading - projection.heading_offset;
  const Point2 left = normal_of(line_heading), along(left.y(), -left.x());
  const Eigen::Matrix2d bias = p.block<2, 2>(kBiasX, kBiasX);
  Jacobian<1> lateral = lateral.Zero();
  lateral[kBiasX] = left.x();
  lateral[kBiasY] = left.y();
  lateral.tail<OffsetProfile::kKnots>() =
      OffsetProfile::shares((line_s_ - first_knot_s_) / OffsetProfile::kSpacing);
  state.lateral_offset = {lateral.dot(x), std::sqrt((lateral * p * lateral.transpose())(0, 0))};
  state.longitudinal_offset = {-along.dot(Point2(x[kBiasX], x[kBiasY])), std::sqrt(along.dot(bias * along))};
  state.heading_offset = {x[kBiasHeading], filter_.stddev(kBiasHeading)};
  state.left_half_width = {x[kLeft], filter_.stddev(kLeft)};
  state.right_half_width = {x[kRight], filter_.stddev(kRight)};
  return state;
}

}  // namespace relative_map::core
