// What a cycle on a route, a search and a reference line take, on a small map and on one of 100,000 lanes.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "relative_map/route/reference_line.hpp"
#include "relative_map/route/route_map.hpp"
#include "relative_map/route/route_search.hpp"
#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

/// A town of `blocks` x `blocks` crossings 100 m apart; between two of them a road of two lanes each way, and
/// at each crossing a lane for every turn but back.
LaneGraph town(int blocks) {
  LaneGraph graph;
  constexpr double kBlock = 100.0, kHalfCrossing = 12.0;
  const Point2 directions[] = {{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}};
  const auto id = [](int x, int y, int d, int row) {
    return std::to_string(x) + "," + std::to_string(y) + "/" + std::to_string(d) + "/" + std::to_string(row);
  };
  const auto exists = [&](int x, int y) { return x >= 0 && y >= 0 && x < blocks && y < blocks; };
  // The road that leaves crossing (x, y) in direction d, in rows 0 (left) and 1.
  const auto leaves = [&](int x, int y, int d) {
    return exists(x, y) &&
           exists(x + static_cast<int>(directions[d].x()), y + static_cast<int>(directions[d].y()));
  };
  const auto end_of = [&](int x, int y, int d, int row, bool at_start) -> Point2 {
    const Point2 right(directions[d].y(), -directions[d].x());
    const double along = at_start ? kHalfCrossing : kBlock - kHalfCrossing;
    return Point2(x * kBlock, y * kBlock) + along * directions[d] + (1.75 + 3.5 * row) * right;
  };
  for (int x = 0; x < blocks; ++x) {
    for (int y = 0; y < blocks; ++y) {
      for (int d = 0; d < 4; ++d) {
        if (!leaves(x, y, d)) continue;
        const int to_x = x + static_cast<int>(directions[d].x()),
                  to_y = y + static_cast<int>(directions[d].y());
        for (int row = 0; row < 2; ++row) {
          GraphLane lane = test::make_lane(
              id(x, y, d, row), test::straight(end_of(x, y, d, row, true), end_of(x, y, d, row, false)));
          if (row == 0) lane.right_neighbors = {id(x, y, d, 1)};
          if (row == 1) lane.left_neighbors = {id(x, y, d, 0)};
          for (int turn = -1; turn <= 1; ++turn) {
            const int out = (d + turn + 4) % 4;
            if ((turn == 1 && row == 1) || (turn == -1 && row == 0) || !leaves(to_x, to_y, out)) continue;
            const std::string name = lane.id + ">" + std::to_string(turn);
            GraphLane link = test::make_lane(
                name, test::straight(lane.centerline.back(), end_of(to_x, to_y, out, row, true)));
            link.turn = turn == 0   ? LaneTurn::kNoTurn
                        : turn == 1 ? LaneTurn::kLeftTurn
                                    : LaneTurn::kRightTurn;
            link.predecessors = {lane.id};
            link.successors = {id(to_x, to_y, out, row)};
            lane.successors.push_back(name);
            graph.lanes.push_back(std::move(link));
          }
          graph.lanes.push_back(std::move(lane));
        }
      }
    }
  }
  return graph;
}

struct Town {
  explicit Town(int blocks)
      : network(test::prepared(town(blocks))), search(network, SearchParam{}), map(RouteParam{}) {
    map.set_graph(network);
    request.places = {{"0,0/0/1", 5.0},
                      {std::to_string(blocks - 2) + "," + std::to_string(blocks - 1) + "/0/1", 60.0}};
    const SearchResult found = search.find(request);
    if (!found.route) throw std::runtime_error(found.why_not);
    if (map.set_route(*found.route).code != RouteCode::kOk || map.update(pose(20.0), 10.0).segments.empty()) {
      throw std::runtime_error("the route can't be followed");
    }
  }
  Pose2 pose(double along) const {
    const LaneLine& line = network->lane(*network->find("0,0/0/1")).line;
    return Pose2(line.point_at(along), line.heading_at(along));
  }
  std::shared_ptr<const LaneNetwork> network;
  RouteSearch search;
  RouteMap map;
  SearchRequest request;
};

Town& town_of(benchmark::State& state) {
  static Town small(5), large(66);
  Town& town = state.range(0) == 0 ? small : large;
  state.SetLabel(std::to_string(town.network->size()) + " lanes");
  return town;
}

void Cycle(benchmark::State& state) {
  Town& town = town_of(state);
  double along = 10.0;
  for (auto _ : state) {
    along = along > 60.0 ? 10.0 : along + 0.5;
    benchmark::DoNotOptimize(town.map.update(town.pose(along), 10.0));
  }
}
BENCHMARK(Cycle)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void Search(benchmark::State& state) {
  Town& town = town_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(town.search.find(town.request));
}
BENCHMARK(Search)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void Lines(benchmark::State& state) {
  Town& town = town_of(state);
  ReferenceLineMaker maker(town.network, ReferenceLineParam{});
  double along = 10.0;
  for (auto _ : state) {
    along = along > 60.0 ? 10.0 : along + 0.5;
    const Pose2 pose = town.pose(along);
    state.PauseTiming();
    const RouteUpdate update = town.map.update(pose, 10.0);
    state.ResumeTiming();
    benchmark::DoNotOptimize(maker.make(update.segments, pose.position()));
  }
}
BENCHMARK(Lines)->Arg(0)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace relative_map::core
