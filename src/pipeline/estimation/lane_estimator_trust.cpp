// Which of the paint LaneEstimator believes.

#include <cmath>
#include <sstream>

#include "relative_map/pipeline/estimation/lane_estimator.hpp"
#include "relative_map/pipeline/lines/line_walker.hpp"

namespace relative_map::core {

namespace {

constexpr double kGate = 30.0;            // squared, in standard deviations: not this lane's paint
constexpr double kOffsetGate = 3.5;       // standard deviations of a marker's mean offset
constexpr double kOpeningGate = 2.0;      // standard deviations of the lane's width
constexpr double kPatience = 0.7;         // [s] of paint that agrees on something else, until it is believed
constexpr double kPatienceWithOne = 1.3;  // [s] of paint on one side only: outliers last for up to a second
constexpr double kMaxSurprise = 1.5;      // [m] that paint may be off by: beyond, it is rather another lane's
constexpr double kSameSurprise = 0.5;     // [m] between offsets that say the same
constexpr double kDoubtTime = 2.5;        // [s] in which none of the paint counted: the estimate is doubted,
constexpr double kLostTime = 5.0;         // [s] ... and given up
constexpr double kShapeReach = 30.0;      // [m] ahead, where a change of the line's direction is looked for
// [rad] of the line's direction at the vehicle and there: paint can't have stayed the same beside it.
const Eigen::Vector2d kShapeChange(0.03, 0.05);

}  // namespace

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

/// Whether the sides lie farther apart than they should: the lane opens into a second one. Its center stays
/// with the side that has moved less.
bool LaneEstimator::is_opening(const std::array<SeenSide, 2>& seen) const {
  if (!seen[0].measurement || !seen[1].measurement) return false;
  Jacobian<1> h = h.Zero();
  double apart = 0.0, variance = 0.0;
  for (const SeenSide& one : seen) {
    const double sign = one.side == kLeft ? 1.0 : -1.0;
    const auto weights = one.measurement->weights();
    apart += sign * one.measurement->mean_offset();
    h += sign * weights.transpose() * one.measurement->jacobian;
    variance += weights.dot(one.measurement->covariance * weights);
  }
  variance += (h * filter_.covariance() * h.transpose())(0, 0);
  return apart > 0.0 && apart * apart > kOpeningGate * kOpeningGate * variance;
}

void LaneEstimator::doubt_motion() {
  if (!informed()) return;
  const Filter::State& x = filter_.state();
  const double aside = std::cos(x[kHeading]) * x[kBiasY] - std::sin(x[kHeading]) * x[kBiasX];
  if (std::abs(aside) < kMaxSurprise) reset();
}

std::string LaneEstimator::refusal_of(const SeenSide& side) {
  std::ostringstream reason;
  reason.precision(2);
  reason << side.name << " is ignored: it is " << side.measurement->mean_offset()
         << " m aside of where this lane's paint is expected";
  return reason.str();
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

}  // namespace relative_map::core
