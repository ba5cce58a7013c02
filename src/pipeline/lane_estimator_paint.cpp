// What paint tells LaneEstimator.

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "relative_map/pipeline/lane_estimator.hpp"
#include "relative_map/pipeline/line_walker.hpp"

namespace relative_map::core {

namespace {

constexpr double kGate = 30.0;        // squared, in standard deviations: not this lane's paint
constexpr double kOffsetGate = 3.5;   // standard deviations of a marker's mean offset
constexpr double kNearEdge = 0.5;     // [m] from its border the vehicle may be taken to be in either lane
constexpr double kSameBorder = 0.6;   // [m] by which paint may be off to be the border that it is not called
constexpr double kPatience = 0.7;     // [s] of paint that agrees on something else, until it is believed
constexpr double kMaxSurprise = 1.4;  // [m] that it may differ by: less than half a lane
constexpr double kLostTime = 2.5;     // [s] in which none of the paint counted: the estimate is wrong
constexpr double kUnseen = 1e4;       // [m^2] variance of a sample that has no line beside it

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
    if (!beside.exists) {
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
  result.squared_distance = filter_.squared_distance(result.innovation, result.jacobian, result.covariance);
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
    if (offset < kSameBorder &&
        !(border.measurement && std::abs(border.measurement->mean_offset()) < offset)) {
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
    given_up_.clear();
  } else if (!ignored.empty()) {
    reconsider(seen[0].measurement, seen[1].measurement, stamp);
    if (!refused_since_) refused_since_ = stamp;
    if (informed() && to_seconds(stamp - *refused_since_) > kLostTime) {
      give_up(*last_, "the lane markers have not been this lane's for long: localization is believed again");
    }
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

}  // namespace relative_map::core
