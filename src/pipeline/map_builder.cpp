#include "relative_map/pipeline/map_builder.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kRoadSampleStep = 5.0;  // [m] the road's edge needs no sample at each vertex

/// Distance to the border from each vertex, or from one every `step` [m], the last one included.
std::vector<WidthSample> measure(const PathPoints& path, const Polyline& border, double step = 0.0) {
  PolylineWalker walker(border);
  std::vector<WidthSample> samples;
  samples.reserve(step > 0.0 ? static_cast<std::size_t>(path.back().s / step) + 2 : path.size());
  for (const PathPoint& vertex : path) {
    const bool last = &vertex == &path.back();
    if (!last && !samples.empty() && vertex.s < samples.back().s + step) continue;
    samples.push_back({vertex.s, std::sqrt(walker.next(vertex.position).squared_distance)});
  }
  return samples;
}

LaneBoundary make_boundary(Polyline points, BoundaryType type, double range) {
  LaneBoundary boundary;
  boundary.points = std::move(points);
  boundary.length = chord_length(boundary.points);
  boundary.paint.push_back({0.0, type});
  if (type != BoundaryType::kUnknown && range < boundary.length) {
    boundary.paint.push_back({range, BoundaryType::kUnknown});
  }
  return boundary;
}

Lane make_lane(LanePath path, double speed_limit) {
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

RelativeMap build_map(std::vector<LanePath> lanes, LaneBorders borders, std::size_t current,
                      const SeenPaint& paint, const PipelineConfig& config) {
  RelativeMap map;
  map.frame_id = config.base_frame;
  const std::size_t n = lanes.size();
  for (std::size_t i = 0; i < n; ++i) {
    // The border between two lanes is one line of paint: the current lane's is also its neighbour's.
    const bool left_of_current = i + 1 == current && borders.left_is_shared[current];
    const bool right_of_current = i == current + 1 && borders.left_is_shared[i];
    const BoundaryType left = i == current       ? paint.left
                              : right_of_current ? paint.right
                                                 : BoundaryType::kUnknown;
    const BoundaryType right = i == current      ? paint.right
                               : left_of_current ? paint.left
                                                 : BoundaryType::kUnknown;
    Lane lane = make_lane(std::move(lanes[i]), config.map_param.default_speed_limit);
    lane.left_boundary = make_boundary(std::move(borders.left[i]), left, paint.range);
    lane.right_boundary = make_boundary(std::move(borders.right[i]), right, paint.range);
    lane.left_samples = measure(lane.path, lane.left_boundary.points);
    lane.right_samples = measure(lane.path, lane.right_boundary.points);
    if (i > 0 && borders.left_is_shared[i]) {
      lane.left_neighbor_id = map.lanes.back().id;
      map.lanes.back().right_neighbor_id = lane.id;
    }
    map.lanes.push_back(std::move(lane));
  }
  map.lanes.front().left_boundary.is_virtual = !config.generate_left_boundary;
  shift_priorities(map.lanes);
  map.roads.push_back(make_road(map.lanes));
  for (Lane& lane : map.lanes) {
    lane.left_road_samples = measure(lane.path, map.roads[0].left_edge, kRoadSampleStep);
    lane.right_road_samples = measure(lane.path, map.roads[0].right_edge, kRoadSampleStep);
  }
  map.current_lane_id = map.lanes[current].id;
  return map;
}

}  // namespace relative_map::core
