#include <algorithm>
#include <cmath>

#include "doctor_rules.hpp"

// Which way the vehicle points, by its several witnesses.
namespace relative_map::doctor {

namespace {

using core::angle_difference;
using core::kPi;

constexpr double kAgree = 5.0 * kPi / 180.0;           // [rad] heading and orientation say the same
constexpr double kSteady = 5.0 * kPi / 180.0;          // [rad] spread of what is constant
constexpr double kQuarterMargin = 10.0 * kPi / 180.0;  // [rad] about a quarter turn
constexpr double kSlip = 30.0 * kPi / 180.0;           // [rad] between heading and course of a car in a bend
constexpr double kFixed = 0.1 * kPi / 180.0;           // [rad] spread of what does not turn
constexpr double kTurns = 5.0 * kPi / 180.0;           // [rad] spread of what does
constexpr double kRefused = 20.0 * kPi / 180.0;        // [rad] off the course: the map node refuses it
constexpr double kNoOffset = 1.5 * kPi / 180.0;        // [rad] off the course that nobody minds
constexpr std::size_t kEnoughLegs = 3;
constexpr std::size_t kManyLegs = 6;  // a small offset takes more of them

bool is_about(double angle, double target, double margin) {
  return std::abs(angle_difference(angle, target)) < margin;
}

/// Heading minus orientation, where both are given.
MeanDirection heading_from_orientation(const std::vector<PoseSample>& poses) {
  std::vector<double> differences;
  for (const PoseSample& pose : poses) differences.push_back(pose.heading - pose.orientation);
  return mean_direction(differences);
}

/// The direction that the node takes, minus where the vehicle goes.
MeanDirection direction_from_course(const Evidence& evidence) {
  std::vector<double> differences;
  for (const Leg& leg : evidence.legs) {
    const double direction = std::isfinite(leg.heading) ? leg.heading : leg.orientation;
    differences.push_back(direction - leg.course - (evidence.reversing ? kPi : 0.0));
  }
  return mean_direction(differences);
}

/// Clockwise from north, as a compass and most GNSS receivers give it: heading + course is a quarter turn.
bool is_compass_heading(const std::vector<Leg>& legs) {
  std::vector<double> sums;
  for (const Leg& leg : legs) sums.push_back(leg.heading + leg.course);
  const MeanDirection sum = mean_direction(sums);
  return is_about(sum.mean, kPi / 2.0, kQuarterMargin) && sum.spread < 2.0 * kSteady;
}

bool heading_is_given(const Evidence& evidence) {
  return std::any_of(evidence.poses.begin(), evidence.poses.end(),
                     [](const PoseSample& pose) { return std::isfinite(pose.heading); });
}

/// Whether the orientation stays as it is while the vehicle turns.
bool orientation_stands(const Evidence& evidence) {
  std::vector<double> orientations, headings, courses;
  for (const PoseSample& pose : evidence.poses) {
    orientations.push_back(pose.orientation);
    headings.push_back(pose.heading);
  }
  for (const Leg& leg : evidence.legs) courses.push_back(leg.course);
  return mean_direction(orientations).spread < kFixed &&
         (mean_direction(headings).spread > kTurns || mean_direction(courses).spread > kTurns);
}

Finding standing_orientation(const Evidence& evidence) {
  return wrong(
      evidence.seen.localization.topic.name + ": the yaw of pose.orientation stays at " +
          degrees(evidence.poses.back().orientation) + " while the vehicle turns",
      "fill pose.orientation with the rotation of the localized link, or set it to 0, 0, 0, 0: the map "
      "node then takes pose.heading");
}

/// Of a direction that is off by the same small angle all the time; none: it is not, or not for certain.
std::optional<Finding> steady_offset(const Evidence& evidence, const MeanDirection& off,
                                     const std::string& field) {
  const auto legs = static_cast<double>(evidence.legs.size());
  const bool certain =
      evidence.legs.size() >= kManyLegs && std::abs(off.mean) > 3.0 * off.spread / std::sqrt(legs);
  if (std::abs(off.mean) < kNoOffset || !certain) return std::nullopt;
  return note(
      evidence.seen.localization.topic.name + ": " + field + " points " +
          fixed(std::abs(off.mean) * 180.0 / kPi, 1) + " degrees to the " +
          (off.mean > 0.0 ? "left" : "right") +
          " of where the vehicle moves, all the time; the map node corrects it by that",
      "turn the sensor's mounting angle by that, or give directions from the map's grid north (not from "
      "true or magnetic north)");
}

/// The other convention than the one that is set.
std::string other_convention(const Evidence& evidence) {
  return evidence.seen.config.orientation_convention == OrientationConvention::kFlu ? "rfu" : "flu";
}

std::string set_convention(const Evidence& evidence) {
  return "set the parameter " + evidence.seen.node + "/orientation_convention to " +
         other_convention(evidence) +
         " and start the map node again, or publish the orientation of a frame with x " +
         (other_convention(evidence) == "rfu" ? "forward, y left (FLU)" : "right, y forward (RFU)");
}

/// By how much orientation is off when the message has the other convention: RFU's yaw is heading - 90
/// degrees.
double quarter_of_other_convention(const Evidence& evidence) {
  return other_convention(evidence) == "rfu" ? kPi / 2.0 : -kPi / 2.0;
}

}  // namespace

Findings poses_are_usable(const Evidence& evidence) {
  if (evidence.refused_poses.empty()) return {};
  return {wrong(
      text(evidence.seen.localization.topic.name, ": ", evidence.refused_poses.size(), " of ",
           evidence.poses.size(), " poses can't be used; the last of them: ", evidence.refused_poses.back()),
      "publish finite numbers: position in [m], heading in [rad] or NaN where it is not given, "
      "orientation as a unit quaternion; publish nothing while the localization has no solution")};
}

Findings heading_is_filled(const Evidence& evidence) {
  if (!evidence.heading_is_never_filled()) return {};
  std::string witness = " while pose.orientation turns";
  if (!evidence.legs.empty()) {
    witness = " while the vehicle moves towards " + degrees(evidence.legs.back().course);
  } else if (!evidence.poses.empty()) {
    witness = " while pose.orientation says " + degrees(evidence.poses.back().orientation);
  }
  return {wrong(evidence.seen.localization.topic.name + ": pose.heading is 0 all the time" + witness,
                "fill pose.heading (counter-clockwise from east), or set it to NaN: the map node then takes "
                "pose.orientation's")};
}

Findings heading_is_in_radians(const Evidence& evidence) {
  const std::optional<double> heading = evidence.heading_not_in_radians();
  if (!heading) return {};
  return {wrong(evidence.seen.localization.topic.name + ": pose.heading is " + fixed(*heading, 1) +
                    ", which is no angle in radians from -pi to pi",
                "publish pose.heading in radians, not in degrees")};
}

Findings orientation_fits_heading(const Evidence& evidence) {
  const MeanDirection off = heading_from_orientation(evidence.poses);
  if (std::isnan(off.mean) || !evidence.heading_is_an_angle()) return {};
  if (orientation_stands(evidence)) return {standing_orientation(evidence)};
  const std::string& topic = evidence.seen.localization.topic.name;
  if (std::abs(off.mean) < kAgree && off.spread < kSteady) {
    return {ok(topic + ": heading and orientation agree")};
  }
  const std::string what = topic + ": pose.heading and the yaw of pose.orientation differ by " +
                           (off.spread < kSteady ? "a constant " : "about ") + degrees(off.mean);
  if (off.spread < kSteady && is_about(off.mean, quarter_of_other_convention(evidence), kQuarterMargin)) {
    return {wrong(
        what + ": the orientation is that of " +
            (other_convention(evidence) == "rfu" ? "an RFU (x right, y forward)" : "an FLU (x forward)") +
            " frame, but orientation_convention says otherwise",
        set_convention(evidence))};
  }
  return {wrong(what,
                "both must tell of the localized link, counter-clockwise from east; set pose.heading to NaN "
                "if the orientation is the better one, and the orientation to 0, 0, 0, 0 if the heading is")};
}

Findings heading_fits_motion(const Evidence& evidence) {
  if (evidence.legs.size() < kEnoughLegs || !evidence.heading_is_an_angle()) return {};
  const MeanDirection off = direction_from_course(evidence);
  if (std::isnan(off.mean)) return {};
  const bool from_heading = heading_is_given(evidence);
  const Leg& last = evidence.legs.back();
  const std::string& topic = evidence.seen.localization.topic.name;
  const std::string field = from_heading ? "pose.heading" : "the yaw of pose.orientation";
  if (!from_heading && orientation_stands(evidence)) return {standing_orientation(evidence)};
  const bool steady = off.spread < kSteady;
  if (std::abs(off.mean) < (steady ? kRefused : kSlip)) {
    if (auto offset = steady_offset(evidence, off, field)) return {std::move(*offset)};
    return {ok(topic + ": the vehicle moves where it points")};
  }
  const std::string what =
      topic + ": " + field + " is " + degrees(from_heading ? last.heading : last.orientation) +
      ", but the position moves towards " + degrees(last.course) + " (counter-clockwise from east)";
  if (from_heading && is_compass_heading(evidence.legs)) {
    return {wrong(what + ": this is a compass heading, clockwise from north",
                  "publish pi/2 - that angle, counter-clockwise from east")};
  }
  if (is_about(off.mean, kPi, kSlip)) {
    const std::string gear = evidence.reversing ? "REVERSE" : "not REVERSE";
    return {wrong(what + ": backwards, while the gear is " + gear,
                  "turn the heading by 180 degrees if the sensor is mounted the wrong way round, or fill "
                  "gear_location in " +
                      evidence.seen.chassis.topic.name)};
  }
  if (!from_heading && is_about(off.mean, -quarter_of_other_convention(evidence), kSlip)) {
    return {wrong(what, set_convention(evidence))};
  }
  return {wrong(what,
                "publish the direction of the vehicle's front, counter-clockwise from east; check the "
                "sensor's mounting angle")};
}

}  // namespace relative_map::doctor
