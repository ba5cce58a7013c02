#include "relative_map/ros/route/route_markers.hpp"

#include <set>

namespace relative_map {

namespace {

using visualization_msgs::Marker;

constexpr double kShownGraph = 300.0;  // [m] around the vehicle that lanes of the graph are drawn

std_msgs::ColorRGBA color(float r, float g, float b, float a) {
  std_msgs::ColorRGBA c;
  c.r = r;
  c.g = g;
  c.b = b;
  c.a = a;
  return c;
}

Marker marker(const RouteSegmentsArray& told, const std::string& name, int id, int type, double width,
              const std_msgs::ColorRGBA& rgba) {
  Marker m;
  m.header = told.header;
  m.ns = name;
  m.id = id;
  m.type = type;
  m.action = Marker::ADD;
  m.pose.orientation.w = 1.0;
  m.scale.x = m.scale.y = m.scale.z = width;
  m.color = rgba;
  return m;
}

geometry_msgs::Point to_point(const core::Point2& from, double z = 0.0) {
  geometry_msgs::Point point;
  point.x = from.x();
  point.y = from.y();
  point.z = z;
  return point;
}

geometry_msgs::Point at(const Path& path, double s) {
  geometry_msgs::Point point;
  for (const PathPoint& candidate : path.path_point) {
    point.x = candidate.x;
    point.y = candidate.y;
    if (candidate.s >= s) break;
  }
  point.z = 0.3;
  return point;
}

void draw_graph(const RouteSegmentsArray& told, const core::RouteIndex& index, const core::Point2& around,
                visualization_msgs::MarkerArray& all) {
  Marker lanes = marker(told, "lane graph", 0, Marker::LINE_LIST, 0.15, color(0.6F, 0.6F, 0.65F, 0.5F));
  for (const std::size_t lane : index.network().lanes_near(around, kShownGraph)) {
    const core::PathPoints& points = index.network().lane(lane).line.points();
    for (std::size_t i = 1; i < points.size(); ++i) {
      lanes.points.push_back(to_point(points[i - 1].position));
      lanes.points.push_back(to_point(points[i].position));
    }
  }
  if (!lanes.points.empty()) all.markers.push_back(lanes);
}

void draw_waypoints(const RouteSegmentsArray& told, const core::RouteIndex& index,
                    visualization_msgs::MarkerArray& all) {
  for (std::size_t i = 0; i < index.waypoints().size(); ++i) {
    const core::PiecePlace& place = index.waypoints()[i];
    const bool goal = i + 1 == index.waypoints().size();
    Marker m = marker(told, "waypoints", static_cast<int>(i), Marker::CYLINDER, goal ? 3.0 : 2.0,
                      goal ? color(0.9F, 0.2F, 0.2F, 0.9F) : color(0.9F, 0.7F, 0.1F, 0.8F));
    m.scale.z = 0.2;
    m.pose.position = to_point(index.lane_of(place.piece).line.point_at(place.s), 0.1);
    all.markers.push_back(m);
  }
}

}  // namespace

visualization_msgs::MarkerArray draw_route(const RouteSegmentsArray& told, const core::RouteIndex* index) {
  visualization_msgs::MarkerArray all;
  Marker clear;
  clear.header = told.header;
  clear.action = Marker::DELETEALL;
  all.markers.push_back(clear);
  int id = 0;
  for (const RouteSegments& segments : told.segments) {
    const bool own = segments.is_on_segment;
    Marker line = marker(told, own ? "reference line" : "passages", id++, Marker::LINE_STRIP, own ? 0.6 : 0.3,
                         own ? color(0.1F, 0.7F, 0.3F, 1.0F) : color(0.2F, 0.5F, 0.9F, 0.7F));
    for (const PathPoint& point : segments.path.path_point) {
      line.points.push_back(to_point({point.x, point.y}, own ? 0.2 : 0.1));
    }
    if (line.points.size() > 1) all.markers.push_back(line);
    if (!segments.has_change || segments.path.path_point.size() < 2) continue;
    Marker zone = marker(told, "lane change", id++, Marker::LINE_STRIP, 1.4, color(1.0F, 0.6F, 0.0F, 0.5F));
    for (const PathPoint& point : segments.path.path_point) {
      const double ahead = point.s - segments.s;
      if (ahead >= segments.change_begin && ahead <= segments.change_end) {
        zone.points.push_back(to_point({point.x, point.y}, 0.15));
      }
    }
    if (zone.points.size() > 1) all.markers.push_back(zone);
  }
  if (index == nullptr) return all;
  if (!told.segments.empty() && !told.segments[0].path.path_point.empty()) {
    const geometry_msgs::Point here = at(told.segments[0].path, told.segments[0].s);
    draw_graph(told, *index, {here.x, here.y}, all);
  }
  draw_waypoints(told, *index, all);
  return all;
}

}  // namespace relative_map
