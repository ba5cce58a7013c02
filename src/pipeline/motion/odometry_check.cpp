#include "relative_map/pipeline/motion/odometry_check.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kLongestGap = 1.0;    // [s] between poses
constexpr int kVerdicts = 2;           // in a row
constexpr int kSecondsOfWay = 2;       // of a verdict
constexpr double kWayTolerance = 1.0;  // [m] localization wanders, and ...
constexpr double kWayShare = 0.15;     // [-] ... tyres wear
constexpr double kStanding = 0.1;      // [m] in a verdict's time
constexpr double kMostDrift = 2.5;     // [m] in a verdict's time that localization drifts by at rest, at most
constexpr double kLeastHalf = 0.3;     // of a way that is driven, in each half of its time
constexpr int kSecondsOfTurn = 3;      // at most, of a verdict: a turn tells as soon as there is enough of it
constexpr double kLeastTurn = 0.04;    // [rad] that tells anything
constexpr double kTurnTolerance = 0.03;  // [rad]
constexpr double kTurnShare = 0.3;       // [-]
constexpr double kSmoothing = 0.3;       // [s] of headings

}  // namespace

void OdometryCheck::Course::restart(const VehicleState& from) {
  begin = from;
  integral = 0.0;
  seconds = 0;
}

bool OdometryCheck::Course::is_due(const VehicleState& now) {
  if (to_seconds(now.stamp - begin.stamp) < seconds + 1) return false;
  ++seconds;
  return true;
}

void OdometryCheck::Course::judge(bool agrees) {
  against = agrees == trusted ? 0 : against + 1;
  if (against < kVerdicts) return;
  trusted = agrees;
  against = 0;
}

void OdometryCheck::add(const VehicleState& given) {
  const double dt = last_ ? to_seconds(given.stamp - last_->stamp) : 0.0;
  if (!last_ || !(dt > 0.0) || dt > kLongestGap || has_jumped(*last_, given)) {
    residual_ = smoothed_ = 0.0;
    way_.restart(given);
    restart_turn(given);
  } else {
    const double turned = angle_difference(given.map_from_base.heading(), last_->map_from_base.heading());
    const double told = 0.5 * (last_->yaw_rate + given.yaw_rate) * dt;
    const double turn = std::isfinite(told) ? told : turned;  // not given: it tells nothing
    way_.integral += 0.5 * (last_->speed + given.speed) * dt;
    turn_.integral += turn;
    residual_ += turned - turn;
    smoothed_ += std::min(1.0, dt / kSmoothing) * (residual_ - smoothed_);
    if (way_.is_due(given)) look_at_way(given);
    if (turn_.is_due(given)) look_at_turn(given);
  }
  last_ = given;
}

void OdometryCheck::look_at_way(const VehicleState& now) {
  if (way_.seconds < kSecondsOfWay) {
    way_.middle = now;
    return;
  }
  const double heading = way_.begin.map_from_base.heading();
  const double middle = heading + 0.5 * angle_difference(now.map_from_base.heading(), heading);
  const Point2 moved = now.map_from_base.position() - way_.begin.map_from_base.position();
  const double driven = moved.dot(Point2(std::cos(middle), std::sin(middle)));
  // Who is told to stand may drift, or be put elsewhere at once: neither is driving.
  const bool told_to_stand = std::abs(way_.integral) < kStanding;
  const Point2 later = now.map_from_base.position() - way_.middle.map_from_base.position();
  const bool steady =
      later.norm() > kLeastHalf * moved.norm() && (moved - later).norm() > kLeastHalf * moved.norm();
  const bool drifts = told_to_stand && (std::abs(driven) < kMostDrift || !steady);
  if (!drifts && std::isfinite(way_.integral) &&
      std::max(std::abs(way_.integral), std::abs(driven)) > kWayTolerance) {
    way_.judge(std::abs(way_.integral - driven) <= kWayTolerance + kWayShare * std::abs(driven));
  }
  way_.restart(now);
}

void OdometryCheck::look_at_turn(const VehicleState& now) {
  const double residual = smoothed_ - smoothed_at_begin_, turned = turn_.integral + residual;
  const bool tells = std::max(std::abs(turn_.integral), std::abs(turned)) > kLeastTurn;
  if (tells) turn_.judge(std::abs(residual) <= kTurnTolerance + kTurnShare * std::abs(turned));
  if (tells || turn_.seconds >= kSecondsOfTurn) restart_turn(now);
}

void OdometryCheck::restart_turn(const VehicleState& from) {
  turn_.restart(from);
  smoothed_at_begin_ = smoothed_;
}

}  // namespace relative_map::core
