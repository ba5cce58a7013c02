// What a tick of prediction takes: a frame of road users seen and all of them predicted. It must stay flat in
// the length of the history.
#include <benchmark/benchmark.h>

#include "support/traffic.hpp"

namespace relative_map::core {
namespace {

/// Five lanes, as dense as a relative map has them.
TrafficLanes motorway() {
  TrafficLanes lanes;
  for (int i = 0; i < 5; ++i) {
    TrafficLane lane;
    lane.id = std::to_string(i);
    lane.left_width = lane.right_width = 1.75;
    for (double x = 0.0; x <= 300.0; x += 0.5) lane.center.emplace_back(x, 3.5 * i + 2e-4 * x * x);
    if (i > 0) lane.right_neighbor = std::to_string(i - 1);
    if (i < 4) lane.left_neighbor = std::to_string(i + 1);
    lanes.lanes.push_back(lane);
  }
  return lanes;
}

SeenRoadUsers frame(int count, int step) {
  SeenRoadUsers frame;
  frame.stamp = at_seconds(1000.0 + 0.1 * step);
  for (int i = 0; i < count; ++i) {
    const double x = std::fmod(13.0 * i + 0.5 * step * (1.0 + 0.1 * (i % 5)), 280.0);
    frame.users.push_back(test::seen(i, x, 3.5 * (i % 5) + 2e-4 * x * x));
  }
  return frame;
}

/// Arguments: road users, seconds of history.
void tick(benchmark::State& state) {
  const auto count = static_cast<int>(state.range(0));
  RoadUserPrediction prediction{PredictionConfig{}};
  const LaneView lanes(motorway());
  EgoVehicle ego;
  ego.pose = Pose2({100.0, 5.0}, 0.0);
  int step = 0;
  for (; step < 10 * state.range(1); ++step) prediction.see(frame(count, step), ego);
  for (auto _ : state) {
    prediction.see(frame(count, step), ego);
    benchmark::DoNotOptimize(prediction.predict(at_seconds(1000.0 + 0.1 * step), ego, lanes));
    ++step;
  }
}
BENCHMARK(tick)->Args({10, 7})->Args({100, 1})->Args({100, 7})->Args({100, 60})->Args({300, 7})->Unit(
    benchmark::kMillisecond);

}  // namespace
}  // namespace relative_map::core
