#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "relative_map/geometry/self_crossings.hpp"
#include "relative_map/tools/line_edit.hpp"

namespace relative_map::core {

namespace {

constexpr double kMinStretch = 0.1;  // a parallel's length, by the line's: less is a fold, nearly

std::string metres(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << value << " m";
  return text.str();
}

/// [rad] between the directions of the two segments, in [0, pi].
double angle_of(const SelfCrossing& crossing, const PathPoints& path) {
  const Point2 &a = path[crossing.first].direction, &b = path[crossing.second].direction;
  return std::abs(std::atan2(cross(a, b), a.dot(b)));
}

/// Throws for the first place where the parallel crosses itself and the line does not. `path` is the line's.
void expect_no_crossing(const EditableLine& line, const EditableLine& parallel, const PathPoints& path,
                        double distance) {
  const std::vector<SelfCrossing> own = self_crossings(line.points, line.ends);
  for (const SelfCrossing& crossing : self_crossings(parallel.points, parallel.ends)) {
    const double angle = angle_of(crossing, path);
    // Where the line crosses itself the parallel does, too, a bit before or after.
    const double reach = 2.0 * std::abs(distance) * (1.0 + std::tan(0.5 * angle));
    const auto near = [&](std::size_t a, std::size_t b) { return std::abs(path[a].s - path[b].s) < reach; };
    const bool is_the_lines = std::any_of(own.begin(), own.end(), [&](const SelfCrossing& other) {
      return near(crossing.first, other.first) && near(crossing.second, other.second);
    });
    if (is_the_lines) continue;
    throw std::runtime_error("at s = " + metres(path[crossing.first].s) + " the parallel at " +
                             metres(distance) +
                             " crosses itself, since the line comes back too near to it at s = " +
                             metres(path[crossing.second].s) + "; take less, or cut the line");
  }
}

}  // namespace

EditableLine offset(const EditableLine& line, double distance) {
  const PathPoints path = path_of(line);
  EditableLine result = line;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (1.0 - path[i].kappa * distance < kMinStretch) {
      throw std::runtime_error("at s = " + metres(path[i].s) + " the curve's radius is " +
                               metres(1.0 / std::abs(path[i].kappa)) + ": a parallel at " + metres(distance) +
                               " would fold; smooth the line first, or take less");
    }
    result.points[i] += distance * left_of(path[i].direction);
  }
  for (std::size_t i = line.closed() ? 0 : 1; i < path.size(); ++i) {
    const std::size_t before = i == 0 ? path.size() - 1 : i - 1;
    const Point2 along = line.points[i] - line.points[before];
    if ((result.points[i] - result.points[before]).dot(along) > 0.0) continue;
    throw std::runtime_error("at s = " + metres(path[i].s) + " the parallel at " + metres(distance) +
                             " would fold; smooth the line first, or take less");
  }
  expect_no_crossing(line, result, path, distance);
  return result;
}

}  // namespace relative_map::core
