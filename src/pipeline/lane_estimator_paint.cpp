// What paint tells LaneEstimator.

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "relative_map/pipeline/lane_estimator.hpp"
#include "relative_map/pipeline/line_walker.hpp"

namespace relative_map::core {

namespace {

constexpr double kGate = 30.0;       // squared, in standard deviations: not this lane's paint
constexpr double kOffsetGate = 3.5;  // standard deviations of a marker's mean offset
constexpr double kNearEdge = 0.5;    // [m] from its border the vehicle may be taken to be in either lane
constexpr double kSameBorder = 0.6;  // [m] by which paint may be off to be the border that it is not called
constexpr double kPatience = 0.7;    // [s] of paint that agrees on something else, until it is believed
constexpr double kPatienceWithOne = 1.3;  // [s] of paint on one side only: outliers last for up to a second
constexpr double kMaxSurprise = 1.5;      // [m] that paint may be off by: beyond, it is rather another lane's
constexpr double kSameSurprise = 0.5;     // [m] between offsets that say the same
constexpr double kDoubtTime = 2.5;        // [s] in which none of the paint counted: the estimate is doubted,
constexpr double kLostTime = 5.0;         // [s] ... and given up
constexpr double kNarrowestNext = 2.0;    // [m] of a lane beyond, and ...
constexpr double kWidestNext = 6.0;       // [m] ... its widest
constexpr double kNextWalk = 0.02;        // [m] of its border from image to image
constexpr double kUnseen = 1e4;           // [m^2] variance of a sample that has no line beside it
constexpr double kShapeReach = 30.0;  // [m] ahead, where a change of the line's direction is looked for ...
const Eigen::Vector2d kShapeChange(0.03,
                                   0.05);  // [rad] ... here and there: paint can't stay the same beside it

}  // namespace

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
    const BesideLine beside = walker.beside(pose.position() + arm - line_origin);
    if (!beside.exists || !std::isfinite(beside.s) || !std::isfinite(beside.lateral)) {
      result.covariance(i, i) += kUnseen;
      continue;
    }
    ++seen;
    const double s = s_along(line, beside.s);
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
  result.expected = filter_.expect(result.jacobian, result.covariance);
  result.squared_distance = result.expected.squared_distance(result.innovation);
  return result;
}

bool LaneEstimator::fits(const Measurement& measurement) const {
  if (measurement.squared_distance > kGate) return false;
  // The mean by itself, too: five numbers hide a shift of all of them.
  const double offset = std::abs(measurement.mean_offset());
  if (!informed() && offset > watch_.max_offset) return false;
  return offset < kMaxSurprise && offset < kOffsetGate * mean_stddev(measurement);
}

double LaneEstimator::mean_stddev(const Measurement& measurement) const {
  const auto weights = measurement.weights();
  return std::sqrt(weights.dot(measurement.expected.covariance * weights));
}

Eigen::Matrix<double, kPaintSamples, 1> LaneEstimator::Measurement::weights() const {
  Eigen::Matrix<double, kPaintSamples, 1> weights = covariance.diagonal().cwiseInverse();
  return weights / weights.sum();
}

std::array<LaneEstimator::SeenSide, 2> LaneEstimator::assign(const SeenSides& sides,
                                                             const NavigationLine& line,
                                                             const LineProjection& projection) const {
  const Filter::State& x = filter_.state();
  std::array<SeenSide, 2> seen{SeenSide{kLeft, "left", sides.left, {}},
                               SeenSide{kRight, "right", sides.right, {}}};
  for (SeenSide& one : seen) measure_again(one, line, projection);
  // Beside a border the camera and the map may not be of one mind yet on which lane the vehicle is in: the
  // lane's left border may be on the right of the camera already, and the other way round.
  const double to_left = x[kLeft] - projection.l, to_right = x[kRight] + projection.l;
  if (std::min(to_left, to_right) < kNearEdge) {
    const bool at_left = to_left < to_right;
    SeenSide &border = seen[at_left ? 0 : 1], &beyond = seen[at_left ? 1 : 0];
    SeenSide crossed{border.side, beyond.name, beyond.paint, {}};
    measure_again(crossed, line, projection);
    const double offset = crossed.measurement ? std::abs(crossed.measurement->mean_offset()) : kSameBorder;
    if (offset < kSameBorder &&
        !(border.measurement && std::abs(border.measurement->mean_offset()) < offset)) {
      border = crossed;
      beyond.paint.reset();
      beyond.measurement.reset();
    }
  }
  const auto distance = [](const SeenSide& one) {
    return one.measurement ? one.measurement->squared_distance : std::numeric_limits<double>::max();
  };
  if (distance(seen[1]) < distance(seen[0])) std::swap(seen[0], seen[1]);
  return seen;
}

void LaneEstimator::measure_again(SeenSide& one, const NavigationLine& line,
                                  const LineProjection& projection) const {
  one.measurement.reset();
  if (one.paint) one.measurement = measure(*one.paint, one.side, line, projection.nearest_vertex);
}

std::vector<std::string> LaneEstimator::see(const SeenSides& sides, const NavigationLine& line,
                                            const LineProjection& projection, Time stamp) {
  if (!last_) return {};
  if (is_frozen(sides, line, projection)) {
    const std::string why = "they are frozen: the numbers stay the same while the line beside them moves";
    if (informed()) give_up(*last_, why);  // they have led it astray
    return {why};
  }
  std::array<SeenSide, 2> seen = assign(sides, line, projection);
  std::vector<std::string> ignored;
  if (!informed() && !may_begin(seen, stamp, ignored)) return ignored;

  bool any = false;
  for (SeenSide& one : seen) {
    if (any) measure_again(one, line, projection);  // the surer side has moved the state
    if (!one.measurement) continue;
    if (fits(*one.measurement)) {
      filter_.correct(one.measurement->innovation, one.measurement->expected);
      if (!any) left_paint_ = right_paint_ = BoundaryType::kUnknown;
      (one.side == kLeft ? left_paint_ : right_paint_) = one.paint->type;
      paint_range_ = any ? std::max(paint_range_, one.paint->to) : one.paint->to;
      any = true;
    } else {
      ignored.push_back(refusal_of(one));
    }
  }
  if (!filter_.state().allFinite()) {
    start(*last_);
  } else if (any) {
    see_next(sides.next_left, kLeft, line, projection.nearest_vertex, next_left_);
    see_next(sides.next_right, kRight, line, projection.nearest_vertex, next_right_);
    last_paint_ = stamp;
    watch_.refused = false;
    surprise_.reset();
    refused_since_.reset();
    doubted_ = false;
    given_up_.clear();
  } else if (!ignored.empty()) {
    reconsider(seen, stamp);
  }
  return ignored;
}

void LaneEstimator::see_next(const std::optional<PaintSamples>& paint, Index side, const NavigationLine& line,
                             std::size_t vertex, NextBorder& border) {
  using Scalar = Eigen::Matrix<double, 1, 1>;
  border.type = BoundaryType::kUnknown;
  const auto measurement = paint ? measure(*paint, side, line, vertex) : std::nullopt;
  if (!measurement) return;
  // Measured as if it were the lane's own border: what it is off by is the width of the lane beyond.
  const double sign = side == kLeft ? 1.0 : -1.0, own = filter_.state()[side];
  const double distance = own + sign * measurement->mean_offset();
  const auto weights = measurement->weights();
  const Scalar noise = weights.transpose() * measurement->covariance * weights;
  if (distance < own + kNarrowestNext || distance > own + kWidestNext) return;
  if (border.known && std::abs(distance - border.distance.state()[0]) > kSameSurprise) {
    border.known = false;  // it goes elsewhere: start anew with the next image
    return;
  }
  if (!border.known) border.distance = KalmanFilter<1>(Scalar::Constant(distance), noise);
  border.distance.predict(Scalar::Ones(), Scalar::Constant(kNextWalk * kNextWalk));
  border.distance.correct(Scalar(distance - border.distance.state()[0]),
                          border.distance.expect(Scalar::Ones(), noise));
  border.known = true;
  border.type = paint->type;
}

/// The first paint must not be an outlier's: both sides that fit together, or one for a while. Where paint
/// has been refused just now, it must go on for longer than outliers do.
bool LaneEstimator::may_begin(const std::array<SeenSide, 2>& seen, Time stamp,
                              std::vector<std::string>& ignored) {
  for (const SeenSide& one : seen) {
    if (one.measurement && !fits(*one.measurement)) ignored.push_back(refusal_of(one));
  }
  if (!ignored.empty()) watch_.refused = true;
  if (!ignored.empty() || !watch_.begun || to_seconds(stamp - watch_.last_image) > 1.0) watch_.begun = stamp;
  watch_.last_image = stamp;
  if (!ignored.empty()) return false;
  const double lasted = to_seconds(stamp - *watch_.begun);
  if (watch_.refused) return lasted > kPatienceWithOne;
  if (!seen[0].measurement || !seen[1].measurement) return lasted > kPatience;
  return std::abs(seen[0].measurement->mean_offset() - seen[1].measurement->mean_offset()) < kSameSurprise;
}

std::string LaneEstimator::refusal_of(const SeenSide& side) {
  std::ostringstream reason;
  reason.precision(2);
  reason << side.name << " is ignored: it is " << side.measurement->mean_offset()
         << " m aside of where this lane's paint is expected";
  return reason.str();
}

/// Whether paint says the same numbers as before, while the line has moved beside the vehicle.
bool LaneEstimator::is_frozen(const SeenSides& sides, const NavigationLine& line,
                              const LineProjection& projection) {
  // By headings, since localization's position drifts and jumps.
  const Pose2& pose = last_->map_from_base;
  const Point2 position = pose.position() - line.origin;
  LineWalker walker(line, projection.nearest_vertex);
  Eigen::Vector2d shape;
  for (int i = 0; i < 2; ++i) {
    const Point2 normal = walker.beside(position + i * kShapeReach * pose.forward()).normal;
    shape[i] = std::atan2(-pose.forward().dot(normal), -cross(pose.forward(), normal));
  }
  if (!sides.unchanged || line.id != watch_.line_id) {
    watch_.line_id = line.id;
    watch_.line_shape = shape;
    watch_.frozen = false;
  }
  if (((shape - watch_.line_shape).cwiseAbs().array() > kShapeChange.array()).any()) watch_.frozen = true;
  return watch_.frozen;
}

void LaneEstimator::reconsider(const std::array<SeenSide, 2>& seen, Time stamp) {
  if (!refused_since_) refused_since_ = stamp;
  const double refused = to_seconds(stamp - *refused_since_);
  if (informed() && refused > kLostTime) {
    watch_.refused = true;
    give_up(*last_, "the lane markers have not been this lane's for long: localization is believed again");
    return;
  }
  if (refused > kDoubtTime && !doubted_) {
    doubt_bias(kMaxSurprise * kMaxSurprise);
    doubted_ = true;
  }
  const bool both = seen[0].measurement && seen[1].measurement;
  double offset = seen[0].measurement ? seen[0].measurement->mean_offset() : 0.0;
  if (both) {
    const double other = seen[1].measurement->mean_offset();
    if (std::abs(offset - other) > kSameSurprise) return;
    offset = 0.5 * (offset + other);
  }
  if (std::abs(offset) > kMaxSurprise) return;
  if (!surprise_ || std::abs(offset - surprise_->offset) > kSameSurprise) surprise_ = Surprise{offset, stamp};
  surprise_->offset = offset;
  if (to_seconds(stamp - surprise_->since) < (both ? kPatience : kPatienceWithOne)) return;
  // It has said the same for long: the bias is another one than was thought.
  doubt_bias(offset * offset);
  surprise_.reset();
}

}  // namespace relative_map::core
