#include "relative_map/pipeline/motion/heading_witness.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/pipeline/motion/vehicle_state.hpp"

namespace relative_map::core {

namespace {

constexpr double kSameStep = 1.2;                            // ratio of two periods that count as one
constexpr int kMemory = 40;                                  // poses
constexpr int kEnough = 5;                                   // poses to measure noise by
constexpr double kUnknown = 0.1;                             // [m] until then
constexpr double kBlunder = 9.0;                             // times the variance: a jump is no noise
constexpr int kSeveral = 3;                                  // messages in a row are no stray one
constexpr Duration kWhile = std::chrono::milliseconds(140);  // 14 poses at 100 Hz, one at 5
constexpr double kLeast = 0.005;                             // [m]

double yaw_of(const Eigen::Quaterniond& q) {
  const Eigen::Vector3d forward = q * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

DirectionEvidence evidence_of(const CourseCheck& check) {
  return {check.verdict(), check.cause(), check.latest_offset(), check.steady_offset()};
}

}  // namespace

void PositionNoise::add(Time stamp, const Point2& position) {
  if (last_ && before_) {
    const double step = to_seconds(stamp - *last_), step_before = to_seconds(*last_ - *before_);
    if (step < kSameStep * step_before && step_before < kSameStep * step) {
      // The second difference of a smooth way is nothing, that of noise has six times its variance.
      const double bend = (position - 2.0 * last_position_ + position_before_).squaredNorm() / 12.0;
      const bool sure = measured_ >= kEnough;
      const double seen = sure ? std::min(bend, kBlunder * std::max(variance_, kLeast * kLeast)) : bend;
      measured_ = std::min(measured_ + 1, kMemory);
      variance_ += (seen - variance_) / measured_;
    }
  }
  before_ = last_;
  position_before_ = last_position_;
  last_ = stamp;
  last_position_ = position;
}

double PositionNoise::stddev() const {
  return measured_ < kEnough ? std::max(kUnknown, std::sqrt(variance_)) : std::sqrt(variance_);
}

bool MeanPose::holds(Time stamp) const {
  return count_ > 0 && stamp - begin_ < kWhile && stamp >= begin_;
}

void MeanPose::add(Time stamp, const Pose2& pose, const KnownMotion& motion) {
  if (count_++ == 0) {
    begin_ = stamp;
    first_ = pose;
  }
  since_ += stamp - begin_;
  moved_ += pose.position() - first_.position();
  turned_ += angle_difference(pose.heading(), first_.heading());
  motion_ = motion;
}

void HeadingWitness::Witness::add(Time stamp, const Pose2& base, const KnownMotion& motion) {
  if (!mean.empty() && (!mean.holds(stamp) || motion.direction != mean.motion().direction)) {
    KnownMotion known = mean.motion();
    known.position_noise /= std::sqrt(static_cast<double>(mean.count()));
    check.add(mean.stamp(), mean.pose(), known);
    mean = MeanPose();
  }
  mean.add(stamp, base, motion);
}

void HeadingWitness::add(const Localization& link, const std::optional<Eigen::Isometry3d>& link_from_base,
                         KnownMotion motion, bool heading_in_range) {
  out_of_range_ = heading_in_range ? 0 : out_of_range_ + 1;
  if (out_of_range_ >= kSeveral) heading_.check.doubt(CourseCheck::Cause::kDegrees);
  const Point2 position = link.position.head<2>();
  if (!position.allFinite()) return;
  noise_.add(link.stamp, position);
  motion.position_noise = noise_.stddev();
  const auto look = [&](double heading, Witness& witness) {
    if (!link_from_base) return witness.add(link.stamp, Pose2(position, heading), motion);
    Localization by_it = link;
    by_it.heading = heading;
    const Localization base = carry_to_base(by_it, *link_from_base);
    witness.add(link.stamp, Pose2(base.position.head<2>(), base.heading), motion);
  };
  if (std::isfinite(link.heading)) look(link.heading, heading_);
  if (!link.map_from_body.coeffs().isZero()) look(yaw_of(link.map_from_body), orientation_);
}

MotionEvidence HeadingWitness::evidence() const {
  return {evidence_of(heading_.check), evidence_of(orientation_.check)};
}

std::string likely_cause(CourseCheck::Cause cause, bool of_orientation) {
  using Cause = CourseCheck::Cause;
  switch (cause) {
    case Cause::kNeverFilled:
      return of_orientation ? "it is the identity all the time, and seems never to be filled"
                            : "it is 0 all the time, and seems never to be filled: then it must be NaN";
    case Cause::kFixed:
      return "it does not turn with the vehicle";
    case Cause::kCompass:
      return "it seems to be a compass heading, from north and clockwise, where counter-clockwise from east "
             "is meant";
    case Cause::kDegrees:
      return "it seems to be in degrees, where radians are meant";
    case Cause::kQuarterTurn:
      return of_orientation
                 ? "orientation_convention seems to be wrong (flu for rfu, or rfu for flu)"
                 : "it seems to be of the other convention (RFU for FLU), or of an antenna that is "
                   "turned by 90 degrees";
    case Cause::kHalfTurn:
      return "an antenna seems to be mounted the other way round, or the gear to be wrong";
    default:
      return "it is turned against the vehicle";
  }
}

}  // namespace relative_map::core
