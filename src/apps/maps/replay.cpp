// Runs the node's own pipeline over a bag: no master, no clock, and the same maps each time.
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2/buffer_core.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "bag_input.hpp"
#include "command_line.hpp"
#include "relative_map/io/text.hpp"
#include "relative_map/io/whole_file.hpp"
#include "relative_map/ros/health/diagnostics.hpp"
#include "relative_map/ros/map/map_engine.hpp"
#include "relative_map/ros/setup/line_loader.hpp"
#include "whole_bag.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    "usage: rosrun relative_map replay IN.bag OUT.bag [--config FILE] [--urdf FILE]\n"
    "\n"
    "Plays the inputs in IN.bag (navigation, localization, chassis, perception/lane_markers, tf_static) "
    "through\n"
    "the map's pipeline and writes the maps to OUT.bag on /relative_map, each at its tick's time.\n"
    "\n"
    "  --config FILE   parameters as in config/relative_map.yaml; its navigation_lines are driven on until "
    "IN.bag "
    "has others\n"
    "  --urdf FILE     the vehicle, for its footprint\n"
    "\n"
    "A pause of more than a minute without input, as where a clock was set, gets maps for its first minute "
    "only.\n";

constexpr double kLongestPause = 60.0;  // [s] without input that is filled with empty maps
const std::set<std::string> kTopics = {"/relative_map"};

/// [s] Exact, and of any size: ros::Duration holds 68 years, and throws where a stamp is scrap.
double seconds_between(const ros::Time& from, const ros::Time& to) {
  return 1e-9 * static_cast<double>(static_cast<std::int64_t>(to.toNSec() - from.toNSec()));
}

struct Arguments {
  std::string input, output, config, urdf;
};

Arguments parse(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--config", "--urdf"});
  if (line.files().size() != 2) throw UsageError("two bags are needed: IN.bag and OUT.bag");
  Arguments arguments{line.files()[0], line.files()[1], line.text("--config"), line.text("--urdf")};
  try {
    core::expect_not_among(arguments.output, {arguments.input});
  } catch (const std::runtime_error&) {
    throw UsageError("IN.bag and OUT.bag are the same file");
  }
  core::expect_not_among(arguments.output, {arguments.config, arguments.urdf});
  return arguments;
}

std::string read_urdf(const std::string& path) {
  const std::string text = core::read_text(path);
  if (core::trimmed(text).empty()) throw std::runtime_error(path + ": is empty");
  return text;
}

class Replay {
 public:
  Replay(const NodeConfig& config, const rosbag::Bag& input, WholeBag& output)
      : config_(config), input_(input), output_(output), engine_(config, link_transforms(transforms_)) {}

  /// Drives on these until the bag has others.
  void set_lines(const std::shared_ptr<const core::NavigationLines>& lines) {
    engine_.set_navigation_lines(lines);
  }

  void run() {
    load_static_transforms(input_, transforms_);
    rosbag::View view(input_, [](const rosbag::ConnectionInfo* connection) {
      const std::string topic = frame_name(connection->topic);
      return topic == "navigation" || topic == "localization" || topic == "chassis" ||
             topic == "perception/lane_markers";
    });
    if (view.size() == 0) {
      throw std::runtime_error(
          "it has none of the topics /navigation, /localization, /chassis, /perception/lane_markers");
    }
    const ros::Time start = view.getBeginTime();
    const double length = seconds_between(start, view.getEndTime());
    ProgressBar progress;
    std::uint64_t tick = 0;
    // Computed from the start each time: a sum of periods would drift.
    const auto tick_time = [&] {
      const auto since_start =
          static_cast<std::uint64_t>(std::llround(1e9 * static_cast<double>(tick) / config_.rate));
      return ros::Time().fromNSec(start.toNSec() + since_start);
    };
    ros::Time last = start;
    for (const rosbag::MessageInstance& message : view) {
      const ros::Time now = message.getTime();
      if (seconds_between(last, now) > kLongestPause) {
        const ros::Time end = last + ros::Duration(kLongestPause);
        for (; tick_time() < end; ++tick) publish(tick_time());
        std::fprintf(stderr, "no input for %.0f s from %.3f on: only the first %.0f s of them get maps\n",
                     seconds_between(last, now), last.toSec(), kLongestPause);
        tick = static_cast<std::uint64_t>(seconds_between(start, now) * config_.rate);  // on the same grid
      }
      for (; tick_time() < now; ++tick) publish(tick_time());
      deliver(message);
      last = now;
      progress.show(length > 0.0 ? seconds_between(start, now) / length : 1.0);
    }
    for (; tick_time() <= view.getEndTime(); ++tick) publish(tick_time());
  }

  void print_summary(double seconds) const {
    std::printf("%zu maps, %zu of them empty, in %.2f s\n", maps_, empty_, seconds);
    for (const auto& [reason, count] : reasons_) std::printf("  %s: %zu\n", reason.c_str(), count);
  }

 private:
  void deliver(const rosbag::MessageInstance& message) {
    const ros::Time received = message.getTime();
    if (const auto lines = message.instantiate<NavigationInfo>()) {
      const auto prepared = MapEngine::prepare(*lines, config_.pipeline);
      for (const std::string& fault : prepared->faults) std::cerr << "navigation: " << fault << "\n";
      engine_.set_navigation_lines(prepared);
    } else if (const auto localization = message.instantiate<LocalizationEstimate>()) {
      engine_.on_localization(localization, received);
    } else if (const auto chassis = message.instantiate<Chassis>()) {
      engine_.on_chassis(chassis, received);
    } else if (const auto markers = message.instantiate<LaneMarkers>()) {
      engine_.on_lane_markers(markers, received);
    } else if (mistyped_.insert({message.getTopic(), message.getDataType()}).second) {
      std::cerr << message.getTopic() << " has type " << message.getDataType()
                << ", which is not read from it\n";
    }
  }

  void publish(const ros::Time& now) {
    const MapMsgPtr map = engine_.tick(now);
    if (!map) return;
    output_.write("/relative_map", now, *map);
    ++maps_;
    if (map->status.code == MapStatus::OK) return;
    ++empty_;
    ++reasons_[status_name(static_cast<core::StatusCode>(map->status.code))];
  }

  const NodeConfig& config_;
  const rosbag::Bag& input_;
  WholeBag& output_;
  tf2::BufferCore transforms_;
  MapEngine engine_;
  std::size_t maps_ = 0, empty_ = 0;
  std::map<std::string, std::size_t> reasons_;
  std::map<std::string, std::string> mistyped_;  ///< topic to type
};

/// Those that the configuration names, as the node loads them; null: none.
std::shared_ptr<const core::NavigationLines> configured_lines(const std::string& config_file,
                                                              const NodeConfig& config) {
  const std::vector<std::string> files =
      config_file.empty() ? std::vector<std::string>() : line_files(config_file);
  if (files.empty()) return nullptr;
  std::vector<std::string> notes;
  const auto lines = MapEngine::prepare(to_message(load_lines(files, "", notes)), config.pipeline);
  for (const std::string& note : notes) std::cerr << note << "\n";
  expect_all_loaded(*lines, files.size());
  return lines;
}

int run(const std::vector<std::string>& words) {
  const Arguments arguments = parse(words);
  const ParameterSet parameters = arguments.config.empty() ? ParameterSet() : read_yaml(arguments.config);
  const std::string urdf = arguments.urdf.empty() ? "" : read_urdf(arguments.urdf);
  const NodeConfig config = make_node_config(parameters, urdf);
  const auto lines = configured_lines(arguments.config, config);

  expect_bag_writable(arguments.output, kTopics);
  rosbag::Bag input;
  open_bag(arguments.input, input);
  WholeBag output(arguments.output, kTopics);
  Replay replay(config, input, output);
  if (lines) replay.set_lines(lines);
  const auto start = std::chrono::steady_clock::now();
  try {
    replay.run();
    output.close();
  } catch (const std::exception& fault) {
    throw std::runtime_error(arguments.input + ": can't be replayed: " + fault.what());
  }
  replay.print_summary(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("replay", relative_map::kUsage, argc, argv, relative_map::run);
}
