#include "relative_map/simulation/world_roads.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "relative_map/simulation/random_process.hpp"
#include "relative_map/simulation/random_roads.hpp"
#include "relative_map/simulation/smooth_step.hpp"

namespace relative_map::core {

namespace {

constexpr double kFirst = 80.0;           // [m] along the road, of the first other line
constexpr double kCrossingEvery = 90.0;   // [m] blocks of houses
constexpr double kCrossingReach = 130.0;  // [m] to both sides
constexpr double kRampLength = 160.0;     // [m] over which a ramp comes near or leaves
constexpr double kRampAway = 35.0;        // [m] so far aside

LinePoint line_point(const Point2& position) {
  const double not_given = std::numeric_limits<double>::quiet_NaN();
  return {position.x(), position.y(), not_given, not_given, not_given, not_given, not_given};
}

/// A line that runs beside the road from one s [m] to another, at an offset [m] that changes.
RecordedLine beside(const RoadShape& road, double from, double to, double spacing,
                    const std::function<double(double)>& l_at, const std::string& name,
                    std::uint32_t priority) {
  RecordedLine line;
  line.name = name;
  line.priority = priority;
  for (double s = from; s <= to; s += spacing) {
    line.points.push_back(line_point(road.at(s, l_at(s)).position));
  }
  return line;
}

std::vector<RecordedLine> crossings(const RoadShape& road, double l, double spacing, std::uint64_t seed) {
  std::mt19937_64 engine = random_engine(seed, 81);
  std::uniform_real_distribution<double> angle(30.0, 80.0), side(-1.0, 1.0);
  std::vector<RecordedLine> lines;
  for (double s = kFirst; s + kFirst < road.length(); s += kCrossingEvery) {
    const PathPoint here = road.at(s, l);
    const double turned = here.theta + std::copysign(angle(engine) * kPi / 180.0, side(engine));
    const Point2 along(std::cos(turned), std::sin(turned));
    RecordedLine line;
    line.name = "crossing " + std::to_string(lines.size());
    for (double x = -kCrossingReach; x <= kCrossingReach; x += spacing) {
      line.points.push_back(line_point(here.position + x * along));
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace

RoadShape world_road(RoadKind kind, std::uint64_t seed, double length) {
  switch (kind) {
    case RoadKind::kMotorway:
      return motorway_road(seed, length);
    case RoadKind::kCountry:
      return country_road(seed, length);
    case RoadKind::kUrban:
      return urban_road(seed, length);
    case RoadKind::kTown:
      return town_road(seed, length);
    default:
      return closed_road(random_start(seed));
  }
}

std::vector<RecordedLine> other_lines(OtherLines kind, const RoadShape& road, double l, double spacing,
                                      std::uint64_t seed) {
  const double middle = 0.4 * road.length();
  switch (kind) {
    case OtherLines::kCrossings:
      return crossings(road, l, spacing, seed);
    case OtherLines::kRamp:
      return {beside(
          road, middle - kRampLength, road.length(), spacing,
          [&](double s) { return l - kRampAway * smooth_step((middle - s) / kRampLength).value; }, "ramp",
          0)};
    case OtherLines::kFork:
      return {beside(
          road, 0.0, middle + kRampLength, spacing,
          [&](double s) { return l - kRampAway * smooth_step((s - middle) / kRampLength).value; }, "exit",
          1)};
    case OtherLines::kDouble:
      return {beside(
          road, 0.0, road.length(), spacing, [&](double) { return l; }, "another day", 0)};
    default:
      return {};
  }
}

}  // namespace relative_map::core
