#include <algorithm>
#include <cmath>

#include "doctor_rules.hpp"

// How fast the vehicle goes and turns, by its several witnesses.
namespace relative_map::doctor {

namespace {

using core::Point2;

constexpr double kSameSpeed = 1.0;       // [m/s] by which speeds may differ in any case
constexpr double kSameSpeedShare = 0.2;  // of the greater one
constexpr double kAside = 0.5;           // [rad] between velocity and course
constexpr std::size_t kEnoughLegs = 3;

/// A witness of the speed; NaN: it says nothing.
struct Speed {
  std::string source;
  double value;  ///< [m/s] without its sign
};

double speed_by_positions(const Evidence& evidence) {
  double distance = 0.0, duration = 0.0;
  for (const Leg& leg : evidence.legs) {
    distance += leg.distance;
    duration += leg.duration;
  }
  if (evidence.legs.size() >= kEnoughLegs) return distance / duration;
  if (evidence.poses.size() < 2) return std::nan("");
  // Too little for a leg: slow, if there was time for one.
  const PoseSample &first = evidence.poses.front(), &last = evidence.poses.back();
  const double seconds = last.time - first.time;
  return seconds > 1.0 ? (last.position - first.position).norm() / seconds : std::nan("");
}

double speed_by_velocity(const Evidence& evidence) {
  std::vector<double> speeds;
  for (const PoseSample& pose : evidence.poses) speeds.push_back(pose.velocity.norm());
  return median(speeds);
}

double speed_by_chassis(const Evidence& evidence) {
  std::vector<double> speeds;
  for (const auto& received : evidence.seen.chassis.messages) {
    speeds.push_back(std::abs(received.message->speed_mps));
  }
  return median(speeds);
}

bool same(double a, double b) {
  return std::abs(a - b) <= std::max(kSameSpeed, kSameSpeedShare * std::max(a, b));
}

std::string guess(const Speed& speed, double true_speed) {
  const auto ratio_is = [&](double ratio) { return std::abs(speed.value / true_speed / ratio - 1.0) < 0.1; };
  if (speed.value < 0.01) return "fill " + speed.source + ": it seems never to be filled";
  if (ratio_is(3.6)) return "publish " + speed.source + " in m/s: it seems to be in km/h";
  if (ratio_is(2.237)) return "publish " + speed.source + " in m/s: it seems to be in miles per hour";
  return "publish " + speed.source + " in m/s, and see whether sensor and stamps are right";
}

}  // namespace

Findings velocity_fits_motion(const Evidence& evidence) {
  std::vector<double> off, bearings, courses;
  for (const Leg& leg : evidence.legs) {
    if (!(leg.velocity.norm() > kSameSpeed)) continue;
    const double bearing = std::atan2(leg.velocity.y(), leg.velocity.x());
    off.push_back(bearing - leg.course);
    bearings.push_back(bearing);
    courses.push_back(leg.course);
  }
  if (off.size() < kEnoughLegs) return {};
  const std::string& topic = evidence.seen.localization.topic.name;
  const double mean_off = mean_direction(off).mean;
  if (std::abs(mean_off) < kAside) return {ok(topic + ": linear_velocity points where the position moves")};
  const bool in_body_frame = std::abs(mean_direction(bearings).mean) < kAside;
  return {wrong(topic + ": pose.linear_velocity points towards " + degrees(mean_direction(bearings).mean) +
                    ", but the position moves towards " + degrees(mean_direction(courses).mean) +
                    (in_body_frame ? ": it seems to be in the body frame" : ""),
                "publish pose.linear_velocity in the map frame (x east, y north)")};
}

Findings yaw_rate_fits_motion(const Evidence& evidence) {
  constexpr double kClearTurn = 0.15;  // [rad] while listening
  if (!evidence.heading_is_an_angle()) return {};
  double turned = 0.0, summed = 0.0;
  for (std::size_t i = 1; i < evidence.poses.size(); ++i) {
    const PoseSample &a = evidence.poses[i - 1], &b = evidence.poses[i];
    turned += core::angle_difference(b.heading, a.heading);
    summed += 0.5 * (a.yaw_rate + b.yaw_rate) * (b.time - a.time);
  }
  if (!(std::abs(turned) > kClearTurn) || !std::isfinite(summed)) return {};
  const std::string& topic = evidence.seen.localization.topic.name;
  const double ratio = summed / turned;
  if (ratio > 0.7 && ratio < 1.3) return {ok(topic + ": yaw rate and heading agree")};
  std::string mend = "publish the yaw rate of the body frame in [rad/s], positive to the left";
  if (std::abs(ratio) < 0.01) mend = "fill pose.angular_velocity_vrf, or set it to NaN where it is not known";
  if (std::abs(ratio) > 40.0 && std::abs(ratio) < 80.0) mend += ": it seems to be in degrees";
  return {wrong(topic + ": the heading turned by " + degrees(turned) +
                    ", but pose.angular_velocity_vrf.z adds up to " + degrees(summed),
                mend)};
}

Findings speeds_agree(const Evidence& evidence) {
  const Speed chassis{evidence.seen.chassis.topic.name + "'s speed_mps", speed_by_chassis(evidence)};
  const Speed velocity{evidence.seen.localization.topic.name + "'s linear_velocity",
                       speed_by_velocity(evidence)};
  const Speed positions{evidence.seen.localization.topic.name + "'s positions", speed_by_positions(evidence)};
  // What moves on the map is the surest; where too little is known of it, the velocity.
  const Speed& surest = std::isnan(positions.value) ? velocity : positions;
  if (std::isnan(surest.value)) return {};
  Findings findings;
  std::size_t compared = 0;
  for (const Speed* speed : {&chassis, &velocity}) {
    if (speed == &surest || std::isnan(speed->value)) continue;
    ++compared;
    if (same(speed->value, surest.value)) continue;
    findings.push_back(wrong("speeds disagree: " + fixed(speed->value, 1) + " m/s by " + speed->source +
                                 ", " + fixed(surest.value, 1) + " m/s by " + surest.source,
                             guess(*speed, surest.value)));
  }
  if (compared > 0 && findings.empty()) {
    findings.push_back(ok("chassis and localization agree on a speed of " + fixed(surest.value, 1) + " m/s"));
  }
  return findings;
}

}  // namespace relative_map::doctor
