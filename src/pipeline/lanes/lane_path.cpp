#include "relative_map/pipeline/lanes/lane_path.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

/// Of two lanes that are nowhere beside each other the vehicle's place decides.
bool starts_left_of(const LanePath& lane, const LanePath& other) {
  const Polyline centerline = positions_of(other.points);
  PolylineWalker walker(centerline);
  const Point2& start = lane.points.front().position;
  const Foot foot = walker.next(start);
  if (walker.beyond_end(foot)) return lane.l < other.l;
  const Point2 direction = centerline[foot.segment + 1] - centerline[foot.segment];
  return cross(direction, start - foot.point) > 0.0;
}

}  // namespace

void locate_vehicle(LanePath& lane) {
  const PathPoints& points = lane.points;
  const Point2 vehicle = Point2::Zero();
  const auto ahead_of = [&](std::size_t i) {
    return points[i].direction.dot(vehicle - points[i].position) > 0.0;
  };
  std::size_t i = 0;
  while (i + 2 < points.size() && ahead_of(i + 1)) ++i;
  const PathPoint &a = points[i], &b = points[i + 1];
  Foot foot = project_on_segment(a.position, b.position, vehicle);
  const bool beyond = foot.fraction <= 0.0 || foot.fraction >= 1.0;
  const PathPoint& end = foot.fraction < 0.5 ? a : b;
  const Point2 offset = vehicle - foot.point;
  const Point2 direction = beyond ? end.direction : (b.position - a.position).normalized();
  lane.s_at_vehicle = a.s + foot.fraction * (b.s - a.s) + (beyond ? direction.dot(offset) : 0.0);
  lane.l = cross(direction, offset);
}

void sort_left_to_right(std::vector<LanePath>& lanes, std::size_t& current) {
  const std::string current_id = lanes[current].id;
  // The vehicle lies left of a lane by l, so the leftmost lane has the smallest l.
  std::stable_sort(lanes.begin(), lanes.end(),
                   [](const LanePath& a, const LanePath& b) { return a.l < b.l; });
  const auto ahead = std::stable_partition(lanes.begin(), lanes.end(),
                                           [](const LanePath& lane) { return lane.s_at_vehicle >= 0.0; });
  std::stable_sort(ahead, lanes.end(), [](const LanePath& a, const LanePath& b) {
    return a.s_at_vehicle >
           b.s_at_vehicle;  // whose start is nearer; so each start is beside those placed before
  });
  for (auto lane = ahead; lane != lanes.end(); ++lane) {
    const auto place = std::find_if(lanes.begin(), lane,
                                    [&](const LanePath& other) { return starts_left_of(*lane, other); });
    std::rotate(place, lane, lane + 1);
  }
  for (current = 0; lanes[current].id != current_id;) ++current;
}

}  // namespace relative_map::core
