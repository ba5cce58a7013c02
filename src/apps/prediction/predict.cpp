// Runs the node's own prediction over a bag: no master, no clock, and the same predictions each time.
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2/buffer_core.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <set>

#include "bag_input.hpp"
#include "navigation_line_command.hpp"
#include "relative_map/ros/prediction/prediction_engine.hpp"
#include "whole_bag.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    R"(usage: predict IN.bag OUT.bag [--config FILE]

Reads /perception/obstacles, /localization, /relative_map and /planning of IN.bag in the order in which they were
recorded, and writes /prediction. Ticks lie on a fixed grid from the first message.

  --config FILE   parameters as YAML, see config/prediction.yaml
)";

const std::set<std::string> kTopics = {"/prediction"};
constexpr double kLongestPause = 10.0;  // [s] without input: no ticks beyond it

class BagRun {
 public:
  BagRun(const PredictionNodeConfig& config, const rosbag::Bag& input, WholeBag& output)
      : config_(config), input_(input), output_(output), engine_(config, link_transforms(transforms_)) {}

  void run() {
    load_static_transforms(input_, transforms_);
    rosbag::View view(input_, [](const rosbag::ConnectionInfo* connection) {
      const std::string topic = frame_name(connection->topic);
      return topic == "perception/obstacles" || topic == "localization" || topic == "relative_map" ||
             topic == "planning";
    });
    if (view.size() == 0) {
      throw std::runtime_error(
          "it has none of the topics /perception/obstacles, /localization, /relative_map, /planning");
    }
    const ros::Time start = view.getBeginTime();
    const auto tick_time = [&](std::uint64_t tick) {
      const auto since =
          static_cast<std::uint64_t>(std::llround(1e9 * static_cast<double>(tick) / config_.rate));
      return ros::Time().fromNSec(start.toNSec() + since);
    };
    std::uint64_t tick = 0;
    for (const rosbag::MessageInstance& message : view) {
      const ros::Time now = message.getTime();
      if (tick_time(tick) + ros::Duration(kLongestPause) < now) {
        std::cerr << "no input for over " << kLongestPause << " s before " << now << "\n";
        tick = static_cast<std::uint64_t>((now - start).toSec() * config_.rate);
      }
      for (; tick_time(tick) < now; ++tick) publish(tick_time(tick));
      deliver(message);
    }
    for (; tick_time(tick) <= view.getEndTime(); ++tick) publish(tick_time(tick));
    publish(tick_time(tick));
  }

  void print_summary() const {
    std::cout << predictions_ << " predictions, " << empty_ << " of them empty, " << road_users_
              << " road users in all\n";
  }

 private:
  void deliver(const rosbag::MessageInstance& message) {
    const ros::Time received = message.getTime();
    if (const auto localization = message.instantiate<LocalizationEstimate>()) {
      engine_.on_localization(localization, received);
    } else if (const auto obstacles = message.instantiate<PerceptionObstacles>()) {
      engine_.on_obstacles(obstacles, received);
    } else if (const auto map = message.instantiate<MapMsg>()) {
      engine_.on_map(map, received);
    } else if (const auto planning = message.instantiate<ADCTrajectory>()) {
      engine_.on_planning(planning, received);
    } else if (mistyped_.insert(message.getTopic()).second) {
      std::cerr << message.getTopic() << " has type " << message.getDataType()
                << ", which is not read from it\n";
    }
  }

  void publish(const ros::Time& now) {
    const PredictionObstaclesPtr message = engine_.tick(now);
    if (!message) return;
    output_.write("/prediction", now, *message);
    ++predictions_;
    if (message->prediction_obstacle.empty()) ++empty_;
    road_users_ += message->prediction_obstacle.size();
  }

  const PredictionNodeConfig& config_;
  const rosbag::Bag& input_;
  WholeBag& output_;
  tf2::BufferCore transforms_;
  PredictionEngine engine_;
  std::size_t predictions_ = 0, empty_ = 0, road_users_ = 0;
  std::set<std::string> mistyped_;
};

int run(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--config"});
  const std::vector<std::string>& files = line.files(2, 2, "IN.bag and OUT.bag");
  std::error_code not_there;
  if (files[0] == files[1] || std::filesystem::equivalent(files[0], files[1], not_there)) {
    throw UsageError("IN.bag and OUT.bag are the same file");
  }
  const PredictionNodeConfig config =
      make_prediction_config(line.has("--config") ? read_yaml(line.text("--config")) : ParameterSet());
  expect_bag_writable(files[1], kTopics);
  rosbag::Bag input;
  open_bag(files[0], input);
  WholeBag output(files[1], kTopics);
  BagRun bag_run(config, input, output);
  try {
    bag_run.run();
    output.close();
  } catch (const std::exception& fault) {
    throw std::runtime_error(files[0] + ": can't be predicted: " + fault.what());
  }
  bag_run.print_summary();
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("predict", relative_map::kUsage, argc, argv, relative_map::run);
}
