// What paint tells LaneEstimator.

#include <algorithm>
#include <cmath>
#include <limits>

#include "relative_map/pipeline/estimation/lane_estimator.hpp"
#include "relative_map/pipeline/lines/line_walker.hpp"

namespace relative_map::core {

namespace {

constexpr double kNearEdge = 0.5;    // [m] from its border the vehicle may be taken to be in either lane
constexpr double kSameBorder = 0.6;  // [m] by which paint may be off to be the border that it is not called
constexpr double kNarrowestNext = 2.0;  // [m] of a lane beyond, and ...
constexpr double kWidestNext = 6.0;     // [m] ... its widest
constexpr double kNextWalk = 0.02;      // [m] of its border from image to image
constexpr double kSameNext = 0.5;       // [m] ... and by which it may jump
constexpr double kUnseen = 1e4;         // [m^2] variance of a sample that has no line beside it
constexpr double kBend = 0.01;          // [rad] of the line along straight paint: it can't be straight

}  // namespace

std::optional<LaneEstimator::Measurement> LaneEstimator::measure(const PaintSamples& paint, Index side,
                                                                 const NavigationLine& line,
                                                                 std::size_t vertex) const {
  const Filter::State& x = filter_.state();
  const Pose2 pose(Point2(x[kX], x[kY]), x[kHeading] + x[kCameraYaw]);
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
    row[kHeading] = row[kCameraYaw] = -beside.normal.dot(left_of(arm));
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

Eigen::Matrix<double, kPaintSamples, 1> LaneEstimator::Measurement::weights() const {
  Eigen::Matrix<double, kPaintSamples, 1> weights = covariance.diagonal().cwiseInverse();
  return weights / weights.sum();
}

/// Without the far part of paint that is straight where the line is not: the camera fits straight lines.
std::optional<PaintSamples> LaneEstimator::credible(const std::optional<PaintSamples>& paint,
                                                    const NavigationLine& line, std::size_t vertex) const {
  if (!paint || !paint->straight) return paint;
  const Filter::State& x = filter_.state();
  const Pose2 line_from_base(origin_ + Point2(x[kX], x[kY]) - line.origin, x[kHeading]);
  LineWalker walker(line, vertex);
  const Point2 near = walker.beside(line_from_base.to_parent(paint->points.front())).normal,
               far = walker.beside(line_from_base.to_parent(paint->points.back())).normal;
  return std::abs(cross(near, far)) < kBend ? paint : near_part(*paint);
}

std::array<LaneEstimator::SeenSide, 2> LaneEstimator::assign(const SeenSides& sides,
                                                             const NavigationLine& line,
                                                             const LineProjection& projection) const {
  const Filter::State& x = filter_.state();
  const auto credible_part = [&](const auto& paint) {
    return credible(paint, line, projection.nearest_vertex);
  };
  std::array<SeenSide, 2> seen{SeenSide{kLeft, "left", credible_part(sides.left), {}},
                               SeenSide{kRight, "right", credible_part(sides.right), {}}};
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
  const bool opening = is_opening(seen);
  for (SeenSide& one : seen) {
    if (any && opening) {
      ignored.push_back(refusal_of(one));
      break;
    }
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
    see_next(credible(sides.next_left, line, projection.nearest_vertex), kLeft, line,
             projection.nearest_vertex, next_left_);
    see_next(credible(sides.next_right, line, projection.nearest_vertex), kRight, line,
             projection.nearest_vertex, next_right_);
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
  if (border.known && std::abs(distance - border.distance.state()[0]) > kSameNext) {
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

}  // namespace relative_map::core
