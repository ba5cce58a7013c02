#include <algorithm>
#include <cmath>

#include "map_check_rows.hpp"

namespace relative_map::core {

namespace {

constexpr double kHeadingTolerance = 0.01;  // [rad]
constexpr double kTurnWindow = 5.0;         // [m] over which curvature must add up to the turn
constexpr double kRateTolerance = 2e-3;     // [1/m^2] of dkappa, as much as a line's own may be off
constexpr double kRateShare = 0.15;         // likewise, of the changes of kappa

/// The first terms of a series tell angles up to this one within 1e-7 rad, and spare the time of
/// trigonometry.
constexpr double kSmall = 0.1;

/// [rad] from the tangent of a circle to a chord of it.
double tangent_to_chord(double kappa, double chord) {
  const double x = 0.5 * kappa * chord, squared = x * x;
  if (squared < kSmall * kSmall) return x * (1.0 + squared * (1.0 / 6.0 + squared * (3.0 / 40.0)));
  return std::asin(std::clamp(x, -1.0, 1.0));
}

/// [rad] from one direction to another.
double turn_between(const Point2& from, const Point2& to) {
  const double across = cross(from, to), along = from.dot(to);
  if (!(std::abs(across) < kSmall * along)) return std::atan2(across, along);
  const double x = across / along, squared = x * x;
  return x * (1.0 - squared * (1.0 / 3.0 - squared * (1.0 / 5.0)));
}

/// Heading at point i of the circle through it and its neighbours; at the ends of the circle with its
/// curvature.
Point2 chord_direction(const PathPoints& path, std::size_t i) {
  if (i > 0 && i + 1 < path.size()) {
    const Point2 before = path[i].position - path[i - 1].position;
    const Point2 after = path[i + 1].position - path[i].position;
    return before * after.squaredNorm() + after * before.squaredNorm();
  }
  const std::size_t first = i == 0 ? 0 : i - 1;
  const Point2 chord = path[first + 1].position - path[first].position;
  const double to_chord = tangent_to_chord(path[i].kappa, chord.norm());
  return Pose2(Point2::Zero(), i == 0 ? -to_chord : to_chord).rotate_to_parent(chord);
}

}  // namespace

Fault check_arc_length(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    if (lane.path.front().s != 0.0) return fault("s starts at ", lane.path.front().s);
    for (std::size_t i = 1; i < lane.path.size(); ++i) {
      const double ds = lane.path[i].s - lane.path[i - 1].s;
      const double squared_chord = (lane.path[i].position - lane.path[i - 1].position).squaredNorm();
      if (!(ds > 0.0)) return fault("s steps by ", ds, " m at point ", i);
      // Nearly always the squares tell: |a - b| <= |a^2 - b^2| / a.
      if (std::abs(ds * ds - squared_chord) <= kLengthTolerance * ds) continue;
      const double chord = std::sqrt(squared_chord);
      if (std::abs(ds - chord) > kLengthTolerance) {
        return fault("s steps by ", ds, " m at point ", i, ", but the chord is ", chord, " m");
      }
    }
    if (lane.length != lane.path.back().s) {
      return fault("length is ", lane.length, " m, but s ends at ", lane.path.back().s, " m");
    }
    return std::nullopt;
  });
}

Fault check_heading(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    Point2 before = chord_direction(lane.path, 0);
    double expected = std::atan2(before.y(), before.x());
    for (std::size_t i = 0; i < lane.path.size(); ++i) {
      const Point2 tangent = chord_direction(lane.path, i);
      expected += turn_between(before, tangent);
      before = tangent;
      const double error = angle_difference(lane.path[i].theta, expected);
      if (std::abs(error) > kHeadingTolerance) {
        return fault("theta is off the path by ", error, " rad at s = ", lane.path[i].s, " m");
      }
    }
    return std::nullopt;
  });
}

Fault check_curvature(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    double turn = 0.0, curved = 0.0, bent = 0.0, start = 0.0;
    for (std::size_t i = 1; i < lane.path.size(); ++i) {
      const PathPoint &a = lane.path[i - 1], &b = lane.path[i];
      const double along = tangent_to_chord(a.kappa, b.s - a.s) + tangent_to_chord(b.kappa, b.s - a.s);
      // Two sharp bends in a row turn by half a circle and more.
      const double step = along + angle_difference(b.theta - a.theta, along);
      turn += step;
      bent += std::abs(step);
      curved += along;
      if (b.s - start < kTurnWindow && i + 1 < lane.path.size()) continue;
      if (std::abs(turn - curved) > kHeadingTolerance + 0.3 * bent) {
        return fault("kappa adds up to ", curved, " rad before s = ", b.s, " m, but the path turns by ",
                     turn);
      }
      turn = curved = bent = 0.0;
      start = b.s;
    }
    return std::nullopt;
  });
}

Fault check_curvature_rate(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    const auto slope = [&](std::size_t i) {
      return (lane.path[i + 1].kappa - lane.path[i].kappa) / (lane.path[i + 1].s - lane.path[i].s);
    };
    // Not at the ends: what lies past them is not known.
    double before = slope(0);
    for (std::size_t i = 1; i + 1 < lane.path.size(); ++i) {
      const double after = slope(i), dkappa = lane.path[i].dkappa;
      const double slack = kRateTolerance + kRateShare * std::max(std::abs(before), std::abs(after));
      if (dkappa < std::min(before, after) - slack || dkappa > std::max(before, after) + slack) {
        return fault("dkappa is ", dkappa, " 1/m^2 at s = ", lane.path[i].s, " m, but kappa changes by ",
                     before, " and ", after);
      }
      before = after;
    }
    return std::nullopt;
  });
}

}  // namespace relative_map::core
