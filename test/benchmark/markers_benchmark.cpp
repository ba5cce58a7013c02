// The time that rviz costs the node: markers of a map, and their bytes.
#include <benchmark/benchmark.h>

#include "relative_map/ros/setup/raw_line.hpp"
#include "relative_map/ros/view/map_markers.hpp"
#include "ros/engine.hpp"

namespace relative_map {
namespace {

const ros::Time kStamp(100.0);

/// The map of three straight lanes with a point each `spacing` [m], fused with markers.
MapMsg fused_map(test::Engine& engine, double spacing) {
  NavigationInfo info;
  info.header.frame_id = "map";
  for (int i = 0; i < 3; ++i) {
    const core::Pose2 start(core::Point2(0.0, test::kLaneWidth * (1 - i)), 0.0);
    info.navigation_path.push_back(test::navigation_path(core::test::straight(start, 400.0, spacing),
                                                         std::to_string(i), static_cast<uint32_t>(i)));
  }
  engine.set_lines(info);
  engine.drive_to(core::Pose2(core::Point2(20.0, 0.0), 0.0), kStamp);
  engine->on_lane_markers(test::shared(test::lane_markers(kStamp)), kStamp);
  return engine.map_at(kStamp);
}

void Markers(benchmark::State& state) {
  test::Engine engine;
  const MapMsg map = fused_map(engine, 0.01 * static_cast<double>(state.range(0)));
  RawLine raw_line(OrientationConvention::kFlu, [](auto&, auto&) { return std::nullopt; });
  std::size_t bytes = 0, markers = 0;
  for (auto _ : state) {
    const auto array =
        MapMarkers().draw(map, core::Footprint(), raw_line.beside(map, engine->navigation_lines(), 15.0));
    bytes = ros::serialization::serializeMessage(array).num_bytes;
    markers = array.markers.size();
  }
  state.counters["kB"] = 1e-3 * static_cast<double>(bytes);
  state.counters["markers"] = static_cast<double>(markers);
}
BENCHMARK(Markers)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relative_map
