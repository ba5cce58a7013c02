#include "relative_map/model/route.hpp"

#include <algorithm>

#include "relative_map/model/route_segments.hpp"

namespace relative_map::core {

namespace {

template <class T, class Same>
bool all_same(const std::vector<T>& a, const std::vector<T>& b, Same same) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

bool same_segment(const LaneSegment& a, const LaneSegment& b) {
  return a.lane_id == b.lane_id && a.start_s == b.start_s && a.end_s == b.end_s;
}

bool same_passage(const Passage& a, const Passage& b) {
  return a.can_exit == b.can_exit && a.change_lane == b.change_lane &&
         all_same(a.segments, b.segments, same_segment);
}

bool same_road(const RouteRoad& a, const RouteRoad& b) {
  return a.id == b.id && all_same(a.passages, b.passages, same_passage);
}

bool same_waypoint(const RouteWaypoint& a, const RouteWaypoint& b) {
  return a.lane_id == b.lane_id && a.s == b.s;
}

}  // namespace

bool same_way(const Route& a, const Route& b) {
  return a.map_version == b.map_version && all_same(a.roads, b.roads, same_road) &&
         all_same(a.waypoints, b.waypoints, same_waypoint);
}

double RouteSegments::length() const {
  double sum = 0.0;
  for (const LaneSegment& segment : segments) sum += segment.end_s - segment.start_s;
  return sum;
}

}  // namespace relative_map::core
