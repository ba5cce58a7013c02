#include "relative_map/pipeline/motion/course_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relative_map::core {

namespace {

constexpr double kDegree = kPi / 180.0;

// A leg.
constexpr double kShortest = 1.0;      // [m]
constexpr double kNoiseLengths = 4.0;  // times the noise of positions, at least
constexpr double kLeastTime = 0.4;     // [s]
constexpr double kMostTime = 6.0;      // [s] slower is drift as well as motion
constexpr double kLongestGap = 1.0;    // [s] between poses
constexpr double kSlowest = 0.7;       // [m/s] where no speed is known
constexpr double kStanding = 0.2;      // [m/s] of a speed that is known
constexpr double kFastReverse = 7.0;   // [m/s] nobody reverses faster
constexpr double kStepTolerance =
    0.5;  // [m] a step that is longer than the speed says by more is a jump, and ...
constexpr double kStepShare = 0.4;  // [-] ... by more of itself
constexpr double kStepNoise = 6.0;  // [-] ... by more times the noise

// A verdict.
constexpr std::size_t kLeastLegs = 3;
constexpr double kWindowTime = 1.4;      // [s] at least
constexpr double kWindowLength = 4.0;    // [m] at least
constexpr double kLongestWindow = 10.0;  // [s]
constexpr double kSure = 4.0;            // standard deviations
constexpr double kContradicted = 17.0 * kDegree;
constexpr double kAside = 12.0 * kDegree;  // of a single leg
constexpr double kAlong = 20.0 * kDegree;  // of a single leg
constexpr double kBorneOut = 15.0 * kDegree;
constexpr double kKnown = 5.0 * kDegree;  // the offset is, with this standard deviation
constexpr double kScattered = 60.0 * kDegree;
constexpr double kLeverArm = 1.5;          // [m] that the localized point may be from where it is said to be
constexpr double kEstablished = 8.0;       // [s] borne out: then a skid is likelier than a fault, and ...
constexpr double kSkidTime = 2.5;          // [s] ... lasts no longer
constexpr double kUnlike = 8.0 * kDegree;  // turned by less or more than the yaw rate says, in a window
constexpr double kSuspicious =
    6.0 * kDegree;  // turned by less or more than the yaw rate says, or than the course
constexpr double kProof = 15.0 * kDegree;  // turned like the course, in a window
constexpr double kForgiveTime = 4.0;       // [s] borne out again, by legs that the fault does not explain
constexpr double kFits = 10.0 * kDegree;   // of legs that a cause explains
constexpr std::size_t kLegsKept = 40;

// The steady offset.
constexpr double kStraight = 3.0 * kDegree;  // turned in a leg
constexpr double kFadeTime = 30.0;           // [s] of driving
constexpr double kNoOffset = 0.5 * kDegree;  // grid convergence and mounting that nobody minds
constexpr double kLegNoise = 1.5 * kDegree;  // of one leg's offset
constexpr double kOutlier = 6.0 * kDegree;
constexpr int kSureLegs = 8;
constexpr int kMostOutliers = 4;  // in a row

double direction_of(const Point2& v) {
  return std::atan2(v.y(), v.x());
}

}  // namespace

double CourseCheck::Leg::offset() const {
  return -direction_of(moved);
}

void CourseCheck::restart(Time stamp, const Pose2& base, int direction, bool joined) {
  begin_ = stamp;
  begin_pose_ = base;
  direction_ = direction;
  joined_ = joined;
  moved_ = Point2::Zero();
  yaw_ = 0.0;
}

void CourseCheck::add(Time stamp, const Pose2& base, const KnownMotion& motion) {
  const double dt = last_stamp_ ? to_seconds(stamp - *last_stamp_) : 0.0;
  const Point2 step = base.position() - last_pose_.position();
  const double told = std::abs(motion.speed) * dt;  // NaN: not known
  const double noise = motion.position_noise;
  const bool jumped = std::abs(step.norm() - told) > kStepTolerance + kStepShare * told + kStepNoise * noise;
  const bool stands = std::abs(motion.speed) < kStanding;
  const Pose2 before = last_pose_;
  const bool fresh = !begin_ || !(dt > 0.0) || dt > kLongestGap || jumped || stands ||
                     motion.direction != direction_ || to_seconds(stamp - *begin_) > kMostTime;
  const double yaw_rate = 0.5 * (last_motion_.yaw_rate + motion.yaw_rate);
  last_stamp_ = stamp;
  last_pose_ = base;
  last_motion_ = motion;
  if (fresh) return restart(stamp, base, motion.direction, false);

  const double middle = before.heading() + 0.5 * angle_difference(base.heading(), before.heading());
  moved_ += Pose2(Point2::Zero(), middle).to_local(step);
  yaw_ += yaw_rate * dt;
  look_at_turn(base, noise);
  const double seconds = to_seconds(stamp - *begin_);
  const double chord = (base.position() - begin_pose_.position()).norm();
  if (seconds < kLeastTime || chord < std::max(kShortest, kNoiseLengths * noise)) return;
  const bool slow = !std::isfinite(motion.speed) && chord < kSlowest * seconds;
  if (!slow) {
    if (direction_ == 0 && chord > kFastReverse * seconds) direction_ = 1;
    close_leg(base, noise);
  }
  restart(stamp, base, motion.direction, !slow);
}

void CourseCheck::look_at_turn(const Pose2& base, double noise) {
  if (proven_ || verdict_ == Verdict::kContradicted || legs_.empty()) return;
  const Leg& last = legs_.back();
  const double turned = angle_difference(base.heading(), begin_pose_.heading());
  const bool turns_unlike = std::abs(turned + last.turned - yaw_ - last.yaw) > kSuspicious;
  if (turns_unlike && std::abs(normalize_angle(last.heading + last.course - 0.5 * kPi)) < kAlong) {
    return doubt(Cause::kCompass);
  }
  const Point2 way = (direction_ < 0 ? -1.0 : 1.0) * (base.position() - begin_pose_.position());
  const double length = way.norm();
  if (length < kShortest) return;
  const auto same = [&](const Leg& leg) { return leg.heading == base.heading(); };
  const auto turned_since = [&](const Leg& leg) {
    return std::abs(angle_difference(direction_of(way), leg.course)) >
           kSuspicious + kSure * (leg.noise + noise / length);
  };
  if (std::all_of(legs_.begin(), legs_.end(), same) &&
      std::any_of(legs_.begin(), legs_.end(), turned_since)) {
    doubt(base.heading() == 0.0 ? Cause::kNeverFilled : Cause::kFixed);
  }
}

void CourseCheck::close_leg(const Pose2& base, double noise) {
  const double front = direction_ < 0 ? -1.0 : 1.0;
  Leg leg;
  leg.seconds = to_seconds(*last_stamp_ - *begin_);
  leg.moved = front * moved_;
  leg.course = direction_of(front * (base.position() - begin_pose_.position()));
  // Which way it drives is not known: the nearer one.
  if (direction_ == 0 && leg.moved.x() < 0.0) {
    leg.moved = -leg.moved;
    leg.course = normalize_angle(leg.course + kPi);
  }
  leg.turned = angle_difference(base.heading(), begin_pose_.heading());
  leg.heading = normalize_angle(begin_pose_.heading() + 0.5 * leg.turned);
  leg.yaw = yaw_;
  leg.noise = std::sqrt(2.0) * noise / leg.moved.norm();
  leg.joined = joined_ && !legs_.empty();
  legs_.push_back(leg);
  if (legs_.size() > kLegsKept) legs_.pop_front();
  judge(leg);
}

CourseCheck::Finding CourseCheck::look_back() const {
  Finding finding;
  bool all_aside = true, all_along = true;
  Point2 moved = Point2::Zero();
  double seconds = 0.0, turned = 0.0, yaw = 0.0, length = 0.0, noise = 0.0;
  std::size_t legs = 0;
  int pieces = 1;
  for (auto leg = legs_.rbegin(); leg != legs_.rend() && seconds < kLongestWindow; ++leg) {
    const double aside = std::abs(leg->offset());
    all_aside = all_aside && aside > kAside + leg->noise;
    all_along = all_along && aside < kAlong + 2.0 * leg->noise;
    moved += leg->moved;
    seconds += leg->seconds;
    turned += leg->turned;
    yaw += leg->yaw;
    length += leg->moved.norm();
    noise = std::max(noise, leg->noise * leg->moved.norm());
    const double uncertain = std::sqrt(pieces) * noise / length;
    if (!leg->joined) ++pieces;
    if (++legs < kLeastLegs || seconds < kWindowTime || length < kWindowLength) continue;

    const double offset = -direction_of(moved);
    // A point that is not where it is said to be in the vehicle goes another way in a bend.
    const double lever = std::atan(kLeverArm * std::abs(turned) / length);
    const double most = kContradicted + lever + kSure * uncertain;
    // A jump spoils one of them: without any of them, the others must say the same.
    bool scattered = false;
    finding.contradicts = true;
    for (auto other = legs_.rbegin(); other != std::next(leg); ++other) {
      const double apart = std::abs(angle_difference(other->offset(), offset));
      scattered = scattered || apart > kScattered + kSure * other->noise;
      finding.contradicts = finding.contradicts && std::abs(direction_of(moved - other->moved)) > most;
    }
    finding.contradicts = finding.contradicts || (scattered && all_aside);
    finding.bears_out = all_along && std::abs(offset) < kBorneOut && uncertain < kKnown;
    finding.turned = std::abs(turned);
    finding.turned_unlike = std::abs(turned - yaw) > kUnlike;
    if (finding.contradicts || finding.bears_out) return finding;
  }
  return finding;
}

void CourseCheck::judge(const Leg& leg) {
  const double offset = std::abs(leg.offset());
  aside_ = offset > kAside ? aside_ + leg.seconds : 0.0;
  unexplained_ = offset < kAlong + 2.0 * leg.noise && !explained(leg) ? unexplained_ + leg.seconds : 0.0;
  const Finding finding = look_back();
  if (verdict_ == Verdict::kContradicted) {
    if (finding.bears_out && unexplained_ >= kForgiveTime) {
      verdict_ = Verdict::kBorneOut;
      cause_ = Cause::kNone;
      borne_out_ = 0.0;
      legs_.clear();
    } else if (cause_ != Cause::kDegrees || !doubted_) {
      cause_ = likely_cause();
    }
    return;
  }
  learn_offset(leg);
  if (finding.contradicts) {
    const bool may_skid =
        verdict_ == Verdict::kBorneOut && borne_out_ > kEstablished && !finding.turned_unlike;
    if (may_skid && aside_ < kSkidTime) return;
    contradict(likely_cause());
    doubted_ = false;
  } else if (finding.bears_out) {
    verdict_ = Verdict::kBorneOut;
    borne_out_ += leg.seconds;
    proven_ = proven_ || finding.turned > kProof;
  }
}

void CourseCheck::contradict(Cause cause) {
  verdict_ = Verdict::kContradicted;
  cause_ = cause;
  unexplained_ = borne_out_ = 0.0;
  proven_ = false;
  steady_ = Point2::Zero();
  steady_legs_ = outliers_ = 0;
}

void CourseCheck::doubt(Cause cause) {
  if (verdict_ == Verdict::kContradicted) return;
  contradict(cause);
  doubted_ = true;
}

void CourseCheck::learn_offset(const Leg& leg) {
  if (std::abs(leg.turned) > kStraight || std::abs(leg.offset()) > kContradicted) return;
  const double far = std::max(kOutlier, 4.0 * leg.noise);
  if (steady_legs_ > kSureLegs && std::abs(angle_difference(leg.offset(), -direction_of(steady_))) > far) {
    if (++outliers_ < kMostOutliers) return;
    steady_ = Point2::Zero();  // it is another one now
    steady_legs_ = 0;
  }
  outliers_ = 0;
  steady_ = (1.0 - std::min(1.0, leg.seconds / kFadeTime)) * steady_ + leg.moved;
  steady_legs_ = std::min(steady_legs_ + 1, static_cast<int>(kLegsKept));
  steady_noise_ += (std::hypot(leg.noise, kLegNoise) - steady_noise_) / steady_legs_;
}

double CourseCheck::latest_offset() const {
  if (legs_.empty()) return std::numeric_limits<double>::quiet_NaN();
  Point2 moved = Point2::Zero();
  const std::size_t first = legs_.size() - std::min(legs_.size(), kLeastLegs);
  for (std::size_t i = first; i < legs_.size(); ++i) moved += legs_[i].moved;
  return -direction_of(moved);
}

double CourseCheck::steady_offset() const {
  if (steady_legs_ < static_cast<int>(kLeastLegs) || verdict_ == Verdict::kContradicted) return 0.0;
  const double offset = -direction_of(steady_);
  const double uncertain =
      std::max(kNoOffset, 2.0 * steady_noise_ / std::sqrt(static_cast<double>(steady_legs_)));
  // Shrunk (James and Stein 1961), so that it comes and goes without a step.
  const double share = uncertain / std::max(uncertain, std::abs(offset));
  return offset * (1.0 - share * share);
}

CourseCheck::Cause CourseCheck::likely_cause() const {
  const auto fits = [&](auto residual) {
    double squares = 0.0, expected = 0.0;
    for (const Leg& leg : legs_) {
      squares += std::pow(normalize_angle(residual(leg)), 2);
      expected += std::pow(kFits, 2) + 2.0 * std::pow(leg.noise, 2);
    }
    return squares < expected;
  };
  const auto same = [&](const Leg& leg) { return leg.heading == legs_.front().heading; };
  const bool fixed = std::all_of(legs_.begin(), legs_.end(), same);
  if (fixed && legs_.front().heading == 0.0) return Cause::kNeverFilled;
  if (fits([](const Leg& leg) { return leg.heading + leg.course - 0.5 * kPi; })) return Cause::kCompass;
  // As a number of degrees it is read as radians, and the turns are taken off.
  if (fits([](const Leg& leg) { return leg.heading - leg.course / kDegree; })) return Cause::kDegrees;
  Point2 sum = Point2::Zero();
  for (const Leg& leg : legs_) sum += leg.moved.normalized();
  const double offset = -direction_of(sum);
  const bool steady = fits([&](const Leg& leg) { return leg.offset() - offset; });
  if (!steady && fits([&](const Leg& leg) { return leg.heading - legs_.front().heading; }))
    return Cause::kFixed;
  if (steady && std::abs(std::abs(offset) - 0.5 * kPi) < 12.0 * kDegree) return Cause::kQuarterTurn;
  if (steady && std::abs(offset) > kPi - 12.0 * kDegree) return Cause::kHalfTurn;
  return Cause::kOffset;
}

bool CourseCheck::explained(const Leg& leg) const {
  const auto is_small = [](double angle) { return std::abs(normalize_angle(angle)) < kAlong; };
  switch (cause_) {
    case Cause::kCompass:
      return is_small(leg.heading + leg.course - 0.5 * kPi);
    case Cause::kDegrees:
      return is_small(leg.heading - leg.course / kDegree);
    case Cause::kNeverFilled:
      return leg.heading == 0.0;
    case Cause::kFixed:
      return !legs_.empty() && is_small(leg.heading - legs_.front().heading);
    default:
      return false;
  }
}

}  // namespace relative_map::core
