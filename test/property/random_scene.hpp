#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "relative_map/simulation/road.hpp"
#include "support/scene.hpp"

// Drives on random roads: good ones, bad ones, and broken ones. A seed gives the same drive each time.
namespace relative_map::core::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

 private:
  std::mt19937_64 engine_;
};

/// What is there, and how much may be wrong with it.
struct SceneParam {
  bool odd_lines = true;     ///< that merge, swing, are cut, thinned, noisy or twice there
  bool wild_markers = true;  ///< that are not the paint beside the lane
  bool faults = true;        ///< numbers that are missing or make no sense
};

/// One drive, step by step.
class RandomDrive {
 public:
  RandomDrive(std::uint64_t seed, const SceneParam& param);

  const PipelineConfig& config() const { return config_; }
  const std::vector<RecordedLine>& lines() const { return lines_; }

  /// Drives on and gives the pipeline all inputs of that moment.
  void step(RelativeMapPipeline& pipeline);
  Time now() const { return now_; }
  const Pose2& pose() const { return pose_; }

 private:
  void make_config();
  void make_road();
  void make_lines();
  RecordedLine odd_line(int number);
  LaneMarkers markers();
  LaneMarker paint(double l);
  Cubic wild_cubic();

  Random random_;
  SceneParam param_;
  PipelineConfig config_;
  RoadShape road_;
  std::vector<RecordedLine> lines_;
  std::vector<double> offsets_;  ///< [m] of the lines from the road
  double s_ = 0.0, l_ = 0.0, turn_ = 0.0, speed_ = 10.0;
  Pose2 pose_;
  Time now_ = at_seconds(100.0);
};

}  // namespace relative_map::core::test
