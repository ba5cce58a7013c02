#include "relative_map/tools/editable_line.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "line_ends.hpp"

namespace relative_map::core {

namespace {

constexpr double kMinSpacing = 1e-3;    // [m] nearer points are one and the same
constexpr double kMinLapLength = 30.0;  // [m] no vehicle drives a tighter circle

void find_ends(EditableLine& line) {
  Polyline& points = line.points;
  if (points.size() < 4 || chord_length(points) < kMinLapLength) return;
  const std::size_t last = points.size() - 1;
  const Point2 first_chord = points[1] - points[0], last_chord = points[last] - points[last - 1];
  const double spacing = std::max(first_chord.norm(), last_chord.norm());
  const Point2 gap = points[0] - points[last];
  const Point2 along = (first_chord.normalized() + last_chord.normalized()).normalized();
  if (gap.norm() > 1.5 * spacing) return;
  // Noise turns the chords, but not the ways that the ends lead as a whole.
  if (angle_between(direction_at_start(points), direction_at_end(points)) > kMaxTurn) return;
  if (gap.norm() < 0.3 * spacing) {
    line.repeats_start = true;
    points.pop_back();
    line.z.pop_back();
  } else if (gap.dot(along) <= 0.0) {
    return;  // it overlaps itself
  }
  line.ends = Ends::kClosed;
}

}  // namespace

double EditableLine::closing_length() const {
  return closed() ? (points.front() - points.back()).norm() : 0.0;
}

EditableLine make_editable(const RecordedLine& recorded) {
  EditableLine line;
  line.name = recorded.name;
  for (std::size_t i = 0; i < recorded.points.size(); ++i) {
    const LinePoint& point = recorded.points[i];
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      throw std::runtime_error("point " + std::to_string(i) + " has an x or y that is not finite");
    }
    const Point2 position(point.x, point.y);
    if (i == 0) line.origin = position;
    const Point2 relative = position - line.origin;
    if (i > 0 && (relative - line.points.back()).norm() < kMinSpacing) continue;
    line.points.push_back(relative);
    line.z.push_back(point.z);
  }
  if (line.points.size() < 2) throw std::runtime_error("the line has fewer than two distinct points");
  find_ends(line);
  return line;
}

double length_of(const EditableLine& line) {
  return chord_length(line.points) + line.closing_length();
}

PathPoints path_of(const EditableLine& line) {
  PathPoints path(line.points.size());
  for (std::size_t i = 0; i < path.size(); ++i) path[i].position = line.points[i];
  compute_arc_length(path);
  compute_geometry(path, line.ends, path.back().s + line.closing_length());
  return path;
}

RecordedLine make_recorded(const EditableLine& line) {
  RecordedLine recorded;
  recorded.name = line.name;
  const PathPoints path = path_of(line);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Point2 position = line.origin + path[i].position;
    recorded.points.push_back(
        {position.x(), position.y(), line.z[i], path[i].theta, path[i].kappa, path[i].dkappa, path[i].s});
  }
  if (line.closed() && line.repeats_start) {
    recorded.points.push_back(recorded.points.front());
    recorded.points.back().s = path.back().s + line.closing_length();
  }
  return recorded;
}

}  // namespace relative_map::core
