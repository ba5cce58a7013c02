#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "relative_map/model/lane_graph.hpp"
#include "relative_map/model/route.hpp"
#include "relative_map/route/lane_network.hpp"

// Small lane graphs and routes that tests share.
namespace relative_map::core::test {

inline GraphLane make_lane(const std::string& id, const Polyline& centerline) {
  GraphLane lane;
  lane.id = id;
  lane.centerline = centerline;
  lane.left_width = lane.right_width = {{0.0, 1.75}};
  lane.left_paint = lane.right_paint = {{0.0, BoundaryType::kDottedWhite}};
  lane.speed_limit = 13.9;
  return lane;
}

/// Points every 5 m or nearer.
inline Polyline straight(const Point2& from, const Point2& to) {
  const int chords = std::max(1, static_cast<int>(std::ceil((to - from).norm() / 5.0)));
  Polyline points;
  for (int i = 0; i <= chords; ++i) points.push_back(from + (to - from) * i / chords);
  return points;
}

inline GraphLane& lane_of(LaneGraph& graph, const std::string& id) {
  for (GraphLane& lane : graph.lanes) {
    if (lane.id == id) return lane;
  }
  throw std::runtime_error("no lane " + id);
}

inline void follow(LaneGraph& graph, const std::string& from, const std::string& to) {
  lane_of(graph, from).successors.push_back(to);
  lane_of(graph, to).predecessors.push_back(from);
}

/// `left` lies to the left of `right`.
inline void neighbors(LaneGraph& graph, const std::string& left, const std::string& right) {
  lane_of(graph, left).right_neighbors.push_back(right);
  lane_of(graph, right).left_neighbors.push_back(left);
}

/// `rows` lanes side by side from left ("a") to right, 3.5 m apart, the first at y = 0, each of `columns`
/// pieces of 100 m along x: a0 a1 .. / b0 b1 .. / ...
inline LaneGraph grid(int rows, int columns) {
  LaneGraph graph;
  const auto id = [](int row, int column) {
    return std::string(1, static_cast<char>('a' + row)) + std::to_string(column);
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double y = -3.5 * row;
      graph.lanes.push_back(
          make_lane(id(row, column), straight({100.0 * column, y}, {100.0 * (column + 1), y})));
    }
  }
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (column > 0) follow(graph, id(row, column - 1), id(row, column));
      if (row > 0) neighbors(graph, id(row - 1, column), id(row, column));
    }
  }
  return graph;
}

/// A circle about the origin in `lanes` pieces q0 q1 ..., counter-clockwise from (radius, 0).
inline LaneGraph ring(int lanes, double radius) {
  LaneGraph graph;
  constexpr int kChords = 160;
  for (int i = 0; i < lanes; ++i) {
    Polyline points;
    for (int k = 0; k <= kChords / lanes; ++k) {
      const double angle = 2.0 * kPi * (i + k / std::floor(kChords / lanes)) / lanes;
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    graph.lanes.push_back(make_lane("q" + std::to_string(i), points));
  }
  for (int i = 0; i < lanes; ++i) {
    follow(graph, "q" + std::to_string(i), "q" + std::to_string((i + 1) % lanes));
  }
  return graph;
}

inline std::shared_ptr<const LaneNetwork> prepared(const LaneGraph& graph) {
  std::vector<GraphFault> faults;
  auto network = LaneNetwork::prepare(graph, faults);
  if (!network) throw std::runtime_error(faults.front().what);
  return network;
}

inline Passage passage(const std::vector<LaneSegment>& segments, ChangeLane change = ChangeLane::kForward,
                       bool can_exit = true) {
  return {segments, can_exit, change};
}

/// One road for each of the passages.
inline Route one_passage_roads(const std::vector<LaneSegment>& segments) {
  Route route;
  for (const LaneSegment& segment : segments) route.roads.push_back({"", {passage({segment})}});
  route.waypoints = {{segments.front().lane_id, segments.front().start_s, {}},
                     {segments.back().lane_id, segments.back().end_s, {}}};
  return route;
}

}  // namespace relative_map::core::test
