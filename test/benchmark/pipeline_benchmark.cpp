// Times of a tick, of the check of its map, and of the intake of lines.
#include <benchmark/benchmark.h>

#include "relative_map/pipeline/map_check.hpp"
#include "scenes.hpp"

namespace relative_map::core::benchmarks {
namespace {

std::size_t points_of(const RelativeMap& map) {
  std::size_t points = 0;
  for (const Lane& lane : map.lanes) points += lane.path.size();
  return points;
}

/// A whole tick: newest pose in, map out; the check is timed by itself.
void time_ticks(benchmark::State& state, const Scene& scene, bool with_markers) {
  RelativeMapPipeline pipeline = pipeline_of(scene, with_markers);
  Time now = from_seconds(1.0);
  RelativeMap map;
  for (auto _ : state) {
    map = tick(pipeline, scene, now);
    benchmark::DoNotOptimize(map);
  }
  if (map.lanes.empty()) state.SkipWithError(map.status.message.c_str());
  state.counters["points"] = static_cast<double>(points_of(map));
}

void time_check(benchmark::State& state, const Scene& scene) {
  RelativeMapPipeline pipeline = pipeline_of(scene, false);
  Time now = from_seconds(1.0);
  const RelativeMap map = tick(pipeline, scene, now);
  if (!check_map(map, {}).empty()) state.SkipWithError("the map breaks the contract");
  for (auto _ : state) benchmark::DoNotOptimize(check_map(map, {}));
  state.counters["points"] = static_cast<double>(points_of(map));
}

template <class Timing>
void with_recorded_lines(benchmark::State& state, Timing timing) {
  if (const std::optional<Scene> scene = recorded_lines()) {
    timing(*scene);
  } else {
    state.SkipWithError("the reference data is not there: set RELATIVE_MAP_REFERENCE_DATA");
  }
}

void TickRecordedLines(benchmark::State& state) {
  with_recorded_lines(state, [&](const Scene& scene) { time_ticks(state, scene, false); });
}
void TickRecordedLinesFused(benchmark::State& state) {
  with_recorded_lines(state, [&](const Scene& scene) { time_ticks(state, scene, true); });
}
void CheckRecordedLines(benchmark::State& state) {
  with_recorded_lines(state, [&](const Scene& scene) { time_check(state, scene); });
}
void TickFiveLanes(benchmark::State& state) {
  time_ticks(state, parallel_lines(5, 10000.0, 0.5), false);
}
void CheckFiveLanes(benchmark::State& state) {
  time_check(state, parallel_lines(5, 10000.0, 0.5));
}
void TickOneLine(benchmark::State& state) {
  time_ticks(state, parallel_lines(1, 0.1 * static_cast<double>(state.range(0)), 0.1), false);
}
void TickManyLines(benchmark::State& state) {
  time_ticks(state, scattered_lines(static_cast<std::size_t>(state.range(0))), false);
}
void CheckOneLine(benchmark::State& state) {
  time_check(state, parallel_lines(1, 0.1 * static_cast<double>(state.range(0)), 0.1));
}

void time_intake(benchmark::State& state, const Scene& scene) {
  for (auto _ : state) benchmark::DoNotOptimize(prepare_navigation_lines(scene.navigation, {}));
}
void IntakeRecordedLines(benchmark::State& state) {
  with_recorded_lines(state, [&](const Scene& scene) { time_intake(state, scene); });
}
void IntakeOneLine(benchmark::State& state) {
  time_intake(state, parallel_lines(1, 0.1 * static_cast<double>(state.range(0)), 0.1));
}
void IntakeClosedLoop(benchmark::State& state) {
  time_intake(state, closed_loop(10000.0, 0.1));
}

BENCHMARK(TickRecordedLines)->Unit(benchmark::kMicrosecond);
BENCHMARK(TickRecordedLinesFused)->Unit(benchmark::kMicrosecond);
BENCHMARK(CheckRecordedLines)->Unit(benchmark::kMicrosecond);
BENCHMARK(TickFiveLanes)->Unit(benchmark::kMicrosecond);
BENCHMARK(CheckFiveLanes)->Unit(benchmark::kMicrosecond);
BENCHMARK(TickOneLine)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMicrosecond);
BENCHMARK(TickManyLines)->Arg(10000)->Unit(benchmark::kMicrosecond);
BENCHMARK(CheckOneLine)->Arg(100000)->Unit(benchmark::kMicrosecond);
BENCHMARK(IntakeRecordedLines)->Unit(benchmark::kMillisecond);
BENCHMARK(IntakeOneLine)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK(IntakeClosedLoop)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relative_map::core::benchmarks
