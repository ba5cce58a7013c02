#include "relative_map/pipeline/lanes/map_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace relative_map::core {

namespace {

constexpr double kSampleStep = 1.0;      // [m] between width samples: vertices may be far denser
constexpr double kRoadSampleStep = 5.0;  // [m]
constexpr double kRoadIsFar = std::numeric_limits<double>::infinity();  // its edges may be
constexpr double kFarBorder = 2.5;                                      // [m] that few lanes have
constexpr double kNearer = 0.8;                                         // of the squared distance
constexpr double kHeadingError = 0.008;  // [rad] between a path's own headings and its points

Foot nearest_foot(const Polyline& border, const Point2& point) {
  Foot nearest;
  for (std::size_t i = 0; i + 1 < border.size(); ++i) {
    Foot foot = project_on_segment(border[i], border[i + 1], point);
    foot.segment = i;
    if (i == 0 || foot.squared_distance < nearest.squared_distance) nearest = foot;
  }
  return nearest;
}

/// Distance to the border from a vertex every `step` [m], the first and the last one included. Where it seems
/// `far` [m] away, all of the border is looked at.
std::vector<WidthSample> measure(const PathPoints& path, const Polyline& border, double step, double far) {
  std::optional<PolylineWalker> walker(border);
  std::vector<WidthSample> samples;
  samples.reserve(static_cast<std::size_t>(path.back().s / step) + 2);
  std::size_t steps = 0;
  double next_s = 0.0;
  for (const PathPoint& vertex : path) {
    ++steps;
    if (vertex.s < next_s && &vertex != &path.back()) continue;
    Foot foot = walker->next(vertex.position, steps);
    if (foot.squared_distance > far * far) {  // where a border folds, a walk along it may not get past
      const Foot nearest = nearest_foot(border, vertex.position);
      if (nearest.squared_distance < kNearer * foot.squared_distance) {
        foot = nearest;
        walker.emplace(border, nearest.segment);
      }
    }
    samples.push_back({vertex.s, std::sqrt(foot.squared_distance)});
    steps = 0;
    next_s = vertex.s + step;
  }
  return samples;
}

LaneBoundary make_boundary(Polyline points) {
  LaneBoundary boundary;
  boundary.points = std::move(points);
  boundary.length = chord_length(boundary.points);
  boundary.paint.push_back({0.0, BoundaryType::kUnknown});
  return boundary;
}

/// Arc length along a border beside the place s [m] of the path.
double s_beside(const PathPoints& path, double s, const Polyline& border) {
  PolylineWalker walker(border);
  for (auto vertex = path.begin(); vertex != path.end() && vertex->s < s; ++vertex) {
    walker.next(vertex->position);
  }
  std::size_t hint = 0;
  const Foot foot = walker.next(interpolate(path, s, hint).position);
  const auto end = border.begin() + static_cast<std::ptrdiff_t>(foot.segment) + 1;
  return chord_length({border.begin(), end}) + (foot.point - border[foot.segment]).norm();
}

/// The paint's type on the stretch of a border beside which it was seen from the path, unknown elsewhere.
void paint_boundary(LaneBoundary& boundary, BoundaryType type, const PathPoints& path, double from,
                    double to) {
  if (type == BoundaryType::kUnknown || to <= std::max(0.0, from)) return;
  const double start = from > 0.0 ? s_beside(path, from, boundary.points) : 0.0;
  const double end = s_beside(path, to, boundary.points);
  if (end <= start) return;
  if (start == 0.0) boundary.paint.clear();
  boundary.paint.push_back({start, type});
  if (end < boundary.length) boundary.paint.push_back({end, BoundaryType::kUnknown});
}

/// The border between two lanes is one line of paint: the current lane's is also its neighbour's.
void add_paint(RelativeMap& map, std::size_t current, const SeenPaint& paint) {
  Lane& lane = map.lanes[current];
  const auto add = [&](LaneBoundary& boundary, BoundaryType type) {
    paint_boundary(boundary, type, lane.path, paint.from, paint.to);
  };
  add(lane.left_boundary, paint.left);
  add(lane.right_boundary, paint.right);
  if (!lane.left_neighbor_id.empty()) {
    Lane& left = map.lanes[current - 1];
    add(left.right_boundary, paint.left);
    add(left.left_boundary, paint.next_left);
    if (!left.left_neighbor_id.empty()) add(map.lanes[current - 2].right_boundary, paint.next_left);
  }
  if (!lane.right_neighbor_id.empty()) {
    Lane& right = map.lanes[current + 1];
    add(right.left_boundary, paint.right);
    add(right.right_boundary, paint.next_right);
    if (!right.right_neighbor_id.empty()) add(map.lanes[current + 2].left_boundary, paint.next_right);
  }
}

/// Whether the headings of a path are those of its points, of the circles through three of them.
bool headings_fit(const PathPoints& path) {
  const auto fits = [](const Point2& tangent, const Point2& direction) {
    return std::abs(cross(tangent, direction)) <= kHeadingError * tangent.norm() &&
           tangent.dot(direction) > 0.0;
  };
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const Point2 before = path[i].position - path[i - 1].position;
    const Point2 after = path[i + 1].position - path[i].position;
    if (!fits(before * after.squaredNorm() + after * before.squaredNorm(), path[i].direction)) return false;
  }
  const auto fits_at_end = [&](const PathPoint& end, const Point2& chord, double sign) {
    const double to_chord = std::asin(std::clamp(0.5 * end.kappa * chord.norm(), -1.0, 1.0));
    return fits(Pose2(Point2::Zero(), sign * to_chord).rotate_to_parent(chord), end.direction);
  };
  const std::size_t last = path.size() - 1;
  return fits_at_end(path[0], path[1].position - path[0].position, -1.0) &&
         fits_at_end(path[last], path[last].position - path[last - 1].position, 1.0);
}

Lane make_lane(LanePath& path, double speed_limit) {
  if (!headings_fit(path.points)) compute_geometry(path.points);
  Lane lane;
  lane.id = std::move(path.id);
  lane.name = std::move(path.name);
  lane.priority = path.priority;
  lane.length = path.points.back().s;
  lane.remaining_distance = std::max(0.0, path.remaining);
  lane.path = std::move(path.points);
  lane.speed_limit = speed_limit;
  return lane;
}

/// The best of the lanes that are left has priority 0.
void shift_priorities(std::vector<Lane>& lanes) {
  std::uint32_t best = lanes.front().priority;
  for (const Lane& lane : lanes) best = std::min(best, lane.priority);
  for (Lane& lane : lanes) lane.priority -= best;
}

Road make_road(const std::vector<Lane>& lanes) {
  Road road;
  road.id = "road";
  for (const Lane& lane : lanes) road.lane_ids.push_back(lane.id);
  road.left_edge = lanes.front().left_boundary.points;
  road.right_edge = lanes.back().right_boundary.points;
  return road;
}

}  // namespace

RelativeMap build_map(std::vector<LanePath>& lanes, LaneBorders borders, std::size_t current,
                      const SeenPaint& paint, const PipelineConfig& config) {
  RelativeMap map;
  map.frame_id = config.base_frame;
  const std::size_t n = lanes.size();
  for (std::size_t i = 0; i < n; ++i) {
    Lane lane = make_lane(lanes[i], config.map_param.default_speed_limit);
    lane.left_boundary = make_boundary(std::move(borders.left[i]));
    lane.right_boundary = make_boundary(std::move(borders.right[i]));
    lane.left_samples = measure(lane.path, lane.left_boundary.points, kSampleStep, kFarBorder);
    lane.right_samples = measure(lane.path, lane.right_boundary.points, kSampleStep, kFarBorder);
    if (i > 0 && borders.left_is_shared[i]) {
      lane.left_neighbor_id = map.lanes.back().id;
      map.lanes.back().right_neighbor_id = lane.id;
    }
    map.lanes.push_back(std::move(lane));
  }
  add_paint(map, current, paint);
  map.lanes.front().left_boundary.is_virtual = !config.generate_left_boundary;
  shift_priorities(map.lanes);
  map.roads.push_back(make_road(map.lanes));
  for (Lane& lane : map.lanes) {
    lane.left_road_samples = measure(lane.path, map.roads[0].left_edge, kRoadSampleStep, kRoadIsFar);
    lane.right_road_samples = measure(lane.path, map.roads[0].right_edge, kRoadSampleStep, kRoadIsFar);
  }
  map.current_lane_id = map.lanes[current].id;
  return map;
}

void take_back(RelativeMap&& map, std::vector<LanePath>& lanes) {
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    lanes[i].id = std::move(map.lanes[i].id);
    lanes[i].name = std::move(map.lanes[i].name);
    lanes[i].points = std::move(map.lanes[i].path);
  }
}

}  // namespace relative_map::core
