// Predicts recorded traffic: what was seen so far in, what may come out, one JSON object a road user and
// start.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "command_line.hpp"
#include "relative_map/io/traffic_scene.hpp"
#include "relative_map/prediction/road_user_prediction.hpp"
#include "relative_map/ros/setup/prediction_parameters.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    R"(usage: predict_scene SCENE_DIR OUT.jsonl [options]

Reads SCENE_DIR/tracks.csv and lanes.json, plays them at their own stamps as a sensor would have seen them, and
writes at each start one line a road user but the vehicle's own:
  {"t", "id", "type", "priority", "lane", "modes": [{"p", "lane", "xy": [[x, y], ...], "sigma": [[along, across], ...]}]}
The points are 0.1 s apart, the first 0.1 s after t; likeliest mode first.

  --config FILE   parameters as YAML, see config/prediction.yaml
  --noise SIGMA   [m] white noise on the positions (default 0)
  --seed N        of the noise (default 1)
  --velocities    the sensor gives velocities, too
  --every S       [s] between starts (default 1.0)
  --after S       [s] of history before the first start of a road user (default 1.0)
  --horizon S     [s] how far ahead, at most 8 (default 8)
)";

struct Arguments {
  std::string scene, output, config;
  double noise = 0.0, every = 1.0, after = 1.0, horizon = 8.0;
  std::uint32_t seed = 1;
  bool velocities = false;
};

Arguments parse(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--config", "--noise", "--seed", "--every", "--after", "--horizon"},
                         {"--velocities"});
  const std::vector<std::string>& files = line.files(2, 2, "SCENE_DIR and OUT.jsonl");
  Arguments arguments;
  arguments.scene = files[0];
  arguments.output = files[1];
  arguments.config = line.text("--config");
  arguments.noise = line.number("--noise", 0.0, 0.0, 100.0);
  arguments.seed = static_cast<std::uint32_t>(line.number("--seed", 1.0, 0.0, 4e9));
  arguments.velocities = line.has("--velocities");
  arguments.every = line.number("--every", 1.0, 0.1, 1e6);
  arguments.after = line.number("--after", 1.0, 0.0, 1e6);
  arguments.horizon = line.number("--horizon", 8.0, 0.1, 8.0);
  return arguments;
}

/// Millimetres are enough, and keep the file small.
double rounded(double value) {
  return std::round(value * 1e3) / 1e3;
}

nlohmann::ordered_json to_json(const core::TrafficScene& scene, double t, const core::PredictedRoadUser& user,
                               std::size_t points) {
  static const char* const kPriorities[] = {"", "CAUTION", "NORMAL", "IGNORE"};
  nlohmann::ordered_json object;
  object["t"] = rounded(t);
  object["id"] = scene.names.at(user.seen.id);
  object["type"] = scene.types.at(user.seen.id);
  object["priority"] = kPriorities[static_cast<int>(user.priority)];
  object["lane"] = user.lane_id;
  object["modes"] = nlohmann::ordered_json::array();
  for (const core::PredictedTrajectory& trajectory : user.trajectories) {
    nlohmann::ordered_json mode;
    mode["p"] = std::round(trajectory.probability * 1e6) / 1e6;
    mode["lane"] = trajectory.lane_id;
    for (std::size_t i = 1; i <= points; ++i) {
      const core::TrajectoryPoint& point = trajectory.points[i];
      mode["xy"].push_back({rounded(point.position.x()), rounded(point.position.y())});
      mode["sigma"].push_back({rounded(point.sigma_along), rounded(point.sigma_across)});
    }
    object["modes"].push_back(std::move(mode));
  }
  return object;
}

/// The output comes out whole or not at all.
class WholeFile {
 public:
  explicit WholeFile(const std::string& path) : path_(path), temporary_(path + ".part"), stream_(temporary_) {
    if (!stream_) throw std::runtime_error(path + ": can't be written");
  }
  ~WholeFile() {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
  std::ostream& stream() { return stream_; }
  void close() {
    stream_.close();
    if (!stream_) throw std::runtime_error(path_ + ": can't be written");
    std::filesystem::rename(temporary_, path_);
  }

 private:
  std::string path_, temporary_;
  std::ofstream stream_;
};

class SceneRun {
 public:
  SceneRun(const Arguments& arguments, const core::TrafficScene& scene, const core::PredictionConfig& config)
      : arguments_(arguments),
        scene_(scene),
        lanes_(scene.lanes),
        prediction_(config, load_network(config)),
        random_(arguments.seed) {}

  void run(std::ostream& out) {
    std::size_t first = 0;
    const auto& samples = scene_.samples;
    while (first < samples.size()) {
      std::size_t last = first;
      while (last < samples.size() && samples[last].stamp == samples[first].stamp) ++last;
      frame(first, last);
      const double t = core::seconds_since_epoch(samples[first].stamp);
      if (is_start(t)) predict(t, out);
      first = last;
    }
  }

 private:
  /// On the grid of `every`, counted from the first stamp.
  bool is_start(double t) {
    const double since = t - core::seconds_since_epoch(scene_.samples.front().stamp);
    const double periods = (since + 1e-6) / arguments_.every;
    if (std::floor(periods) <= last_start_) return false;
    last_start_ = std::floor(periods);
    return true;
  }

  void frame(std::size_t first, std::size_t last) {
    core::SeenRoadUsers frame;
    frame.stamp = scene_.samples[first].stamp;
    std::normal_distribution<double> noise(0.0, 1.0);
    for (std::size_t i = first; i < last; ++i) {
      const core::SceneSample& sample = scene_.samples[i];
      core::SeenRoadUser seen = sample.seen;
      if (sample.ego) {
        ego_.pose = core::Pose2(seen.position, std::isfinite(seen.heading) ? seen.heading : 0.0);
        ego_.speed = seen.velocity.allFinite() ? seen.velocity.norm() : 0.0;
        continue;
      }
      // Drawn for each in turn, whatever is used of it: the same seed, the same noise.
      const double dx = noise(random_), dy = noise(random_);
      seen.position += arguments_.noise * core::Point2(dx, dy);
      if (!arguments_.velocities) seen.velocity.setConstant(core::kNotGiven);
      first_seen_.emplace(seen.id, frame.stamp);
      frame.users.push_back(seen);
    }
    prediction_.see(frame, ego_);
    now_ = frame.stamp;
  }

  void predict(double t, std::ostream& out) {
    const core::Prediction prediction = prediction_.predict(now_, ego_, lanes_);
    const auto points = static_cast<std::size_t>(std::lround(arguments_.horizon / core::kPredictionStep));
    for (const core::PredictedRoadUser& user : prediction.users) {
      if (core::to_seconds(now_ - first_seen_.at(user.seen.id)) < arguments_.after - 1e-6) continue;
      out << to_json(scene_, t, user, points).dump() << "\n";
    }
  }

  const Arguments& arguments_;
  const core::TrafficScene& scene_;
  core::LaneView lanes_;
  core::RoadUserPrediction prediction_;
  std::mt19937 random_;
  core::EgoVehicle ego_;
  std::map<int, core::Time> first_seen_;
  core::Time now_{};
  double last_start_ = -1.0;
};

int run(const std::vector<std::string>& words) {
  const Arguments arguments = parse(words);
  const core::PredictionConfig config = arguments.config.empty()
                                            ? core::PredictionConfig()
                                            : make_prediction_config(read_yaml(arguments.config)).prediction;
  const core::TrafficScene scene = core::read_traffic_scene(arguments.scene);
  WholeFile output(arguments.output);
  SceneRun(arguments, scene, config).run(output.stream());
  output.close();
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("predict_scene", relative_map::kUsage, argc, argv, relative_map::run);
}
