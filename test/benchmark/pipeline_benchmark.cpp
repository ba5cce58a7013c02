// Times of a tick, of the check of its map, and of the intake of lines.
#include <benchmark/benchmark.h>

#include "relative_map/pipeline/contract/map_check.hpp"
#include "scenes.hpp"

namespace relative_map::core::benchmarks {
namespace {

std::size_t points_of(const RelativeMap& map) {
  std::size_t points = 0;
  for (const Lane& lane : map.lanes) points += lane.path.size();
  return points;
}

/// A whole tick: newest pose in, and an image if a method is given that fuses it, map out; the check is timed
/// by itself.
void time_ticks(benchmark::State& state, const Scene& scene, const std::string& method = "") {
  RelativeMapPipeline pipeline = method.empty() ? pipeline_of(scene) : pipeline_of(scene, method);
  Time now = at_seconds(1.0);
  RelativeMap map;
  for (auto _ : state) {
    if (!method.empty()) see(pipeline, now);
    map = tick(pipeline, scene, now);
    benchmark::DoNotOptimize(map);
  }
  if (map.lanes.empty()) state.SkipWithError(map.status.message.c_str());
  if (!method.empty() && map.fusion.source != Source::kFused) state.SkipWithError("nothing was fused");
  state.counters["points"] = static_cast<double>(points_of(map));
}

void time_check(benchmark::State& state, const Scene& scene) {
  RelativeMapPipeline pipeline = pipeline_of(scene);
  Time now = at_seconds(1.0);
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
  with_recorded_lines(state, [&](const Scene& scene) { time_ticks(state, scene); });
}
void TickRecordedLinesFixedWeight(benchmark::State& state) {
  with_recorded_lines(state, [&](const Scene& scene) { time_ticks(state, scene, "fixed_weight"); });
}
void TickRecordedLinesEstimated(benchmark::State& state) {
  with_recorded_lines(state, [&](const Scene& scene) { time_ticks(state, scene, "estimator"); });
}
void CheckRecordedLines(benchmark::State& state) {
  with_recorded_lines(state, [&](const Scene& scene) { time_check(state, scene); });
}
void TickFiveLanes(benchmark::State& state) {
  time_ticks(state, parallel_lines(5, 10000.0, 0.5));
}
void CheckFiveLanes(benchmark::State& state) {
  time_check(state, parallel_lines(5, 10000.0, 0.5));
}
void TickOneLine(benchmark::State& state) {
  time_ticks(state, parallel_lines(1, 0.1 * static_cast<double>(state.range(0)), 0.1));
}
void TickManyLines(benchmark::State& state) {
  time_ticks(state, scattered_lines(static_cast<std::size_t>(state.range(0))));
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
BENCHMARK(TickRecordedLinesFixedWeight)->Unit(benchmark::kMicrosecond);
BENCHMARK(TickRecordedLinesEstimated)->Unit(benchmark::kMicrosecond);
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
