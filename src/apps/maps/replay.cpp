// Runs the node's own pipeline over a bag: no master, no clock, and the same maps each time.
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
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
#include "replay_inputs.hpp"
#include "whole_bag.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    "usage: rosrun relative_map replay IN.bag... OUT.bag [--config FILE] [--urdf FILE] [--namespace NS] "
    "[TOPIC:=OTHER ...]\n"
    "\n"
    "Plays the inputs in IN.bag (navigation, localization, chassis, perception/lane_markers, tf, tf_static) "
    "through\n"
    "the map's pipeline and writes the maps to OUT.bag on /relative_map, each at its tick's time. Several "
    "bags "
    "are the\n"
    "parts of one recording.\n"
    "\n"
    "The same bag gives the same maps, byte for byte, each time. They are not those of the drive itself: "
    "there, "
    "ticks\n"
    "fell at other moments and messages came in between; of a pose that both made a map for, the maps are "
    "equal.\n"
    "\n"
    "  --config FILE   parameters as in config/relative_map.yaml; its navigation_lines are driven on until "
    "IN.bag "
    "has others\n"
    "  --urdf FILE     the vehicle, for its footprint\n"
    "  --namespace NS  of the vehicle in IN.bag, e.g. /car1; its maps go to /car1/relative_map\n"
    "  TOPIC:=OTHER    remaps an input, relative_map, /tf or /tf_static, as for the node\n"
    "\n"
    "A pause of more than a minute without input, as where a clock was set, gets maps for its first minute "
    "only.\n";

constexpr double kLongestPause = 60.0;  // [s] without input that is filled with empty maps

/// [s] Exact, and of any size: ros::Duration holds 68 years, and throws where a stamp is scrap.
double seconds_between(const ros::Time& from, const ros::Time& to) {
  return 1e-9 * static_cast<double>(static_cast<std::int64_t>(to.toNSec() - from.toNSec()));
}

struct Arguments {
  std::vector<std::string> inputs;
  std::string output, config, urdf, name_space;
  std::vector<std::string> remappings;
};

Arguments parse(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--config", "--urdf", "--namespace"});
  Arguments arguments;
  std::vector<std::string> bags;
  for (const std::string& word : line.files()) {
    (word.find(":=") == std::string::npos ? bags : arguments.remappings).push_back(word);
  }
  if (bags.size() < 2) throw UsageError("two bags are needed: IN.bag and OUT.bag");
  arguments.output = bags.back();
  arguments.inputs.assign(bags.begin(), bags.end() - 1);
  arguments.config = line.text("--config");
  arguments.urdf = line.text("--urdf");
  arguments.name_space = line.text("--namespace");
  try {
    core::expect_not_among(arguments.output, arguments.inputs);
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
  Replay(const NodeConfig& config, const ReplayBags& inputs, const InputTopics& topics, WholeBag& output)
      : config_(config),
        inputs_(inputs),
        topics_(topics),
        output_(output),
        engine_(config, link_transforms(transforms_)) {}

  /// Drives on these until the bag has others.
  void set_lines(const std::shared_ptr<const core::NavigationLines>& lines) {
    engine_.set_navigation_lines(lines);
  }

  void run() {
    load_static_transforms();
    rosbag::View inputs, all;
    const auto is_input = [this](const std::string& topic) { return topics_.reads(topic); };
    const auto is_wanted = [this](const std::string& topic) {
      return topics_.reads(topic) || topics_.is_tf(topic);
    };
    inputs_.query(is_input, inputs);
    inputs_.query(is_wanted, all);
    if (inputs.size() == 0) throw std::runtime_error("it has none of the topics " + topics_.listed());
    const ros::Time start = inputs.getBeginTime(), end = inputs.getEndTime();
    const double length = seconds_between(start, end);
    ProgressBar progress;
    std::uint64_t tick = 0;
    // Computed from the start each time: a sum of periods would drift.
    const auto tick_time = [&] {
      const auto since_start =
          static_cast<std::uint64_t>(std::llround(1e9 * static_cast<double>(tick) / config_.rate));
      return ros::Time().fromNSec(start.toNSec() + since_start);
    };
    ros::Time last = start;
    for (const rosbag::MessageInstance& message : all) {
      const ros::Time now = message.getTime();
      const bool pauses = seconds_between(last, now) > kLongestPause;
      if (!is_input(message.getTopic())) {  // transforms alone make no maps
        if (now > start && now <= end && !pauses) {
          for (; tick_time() < now; ++tick) publish(tick_time());
        }
        deliver(message);
        continue;
      }
      if (pauses) {
        const ros::Time last_map = last + ros::Duration(kLongestPause);
        for (; tick_time() < last_map; ++tick) publish(tick_time());
        std::fprintf(stderr, "no input for %.0f s from %.3f on: only the first %.0f s of them get maps\n",
                     seconds_between(last, now), last.toSec(), kLongestPause);
        tick = static_cast<std::uint64_t>(seconds_between(start, now) * config_.rate);  // on the same grid
      }
      for (; tick_time() < now; ++tick) publish(tick_time());
      deliver(message);
      last = now;
      progress.show(length > 0.0 ? seconds_between(start, now) / length : 1.0);
    }
    for (; tick_time() <= end; ++tick) publish(tick_time());
  }

  void print_summary(double seconds) const {
    std::printf("%zu maps, %zu of them empty, in %.2f s\n", maps_, empty_, seconds);
    for (const auto& [reason, count] : reasons_) std::printf("  %s: %zu\n", reason.c_str(), count);
  }

 private:
  /// They hold from the beginning on, whenever they were recorded.
  void load_static_transforms() {
    rosbag::View view;
    const auto is_static = [this](const std::string& topic) { return topics_.is_static_tf(topic); };
    inputs_.query(is_static, view);
    for (const rosbag::MessageInstance& instance : view) {
      if (const auto message = instance.instantiate<tf2_msgs::TFMessage>()) {
        add_transforms(*message, true, transforms_);
      }
    }
  }

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
    } else if (const auto transforms = message.instantiate<tf2_msgs::TFMessage>()) {
      add_transforms(*transforms, false, transforms_);
    } else if (mistyped_.insert({message.getTopic(), message.getDataType()}).second) {
      std::cerr << message.getTopic() << " has type " << message.getDataType()
                << ", which is not read from it\n";
    }
  }

  void publish(const ros::Time& now) {
    const MapMsgPtr map = engine_.tick(now);
    if (!map) return;
    output_.write(topics_.resolved("relative_map"), now, *map);
    ++maps_;
    if (map->status.code == MapStatus::OK) return;
    ++empty_;
    ++reasons_[status_name(static_cast<core::StatusCode>(map->status.code))];
  }

  const NodeConfig& config_;
  const ReplayBags& inputs_;
  const InputTopics& topics_;
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
  const auto lines =
      MapEngine::prepare(to_message(load_lines(files, config.map_frame, notes)), config.pipeline);
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

  const InputTopics topics(arguments.name_space, arguments.remappings);
  const std::set<std::string> written = {topics.resolved("relative_map")};
  expect_bag_writable(arguments.output, written);
  const ReplayBags inputs(arguments.inputs);
  WholeBag output(arguments.output, written);
  Replay replay(config, inputs, topics, output);
  if (lines) replay.set_lines(lines);
  const auto start = std::chrono::steady_clock::now();
  try {
    replay.run();
    output.close();
  } catch (const std::exception& fault) {
    throw std::runtime_error(arguments.inputs.front() + ": can't be replayed: " + fault.what());
  }
  replay.print_summary(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("replay", relative_map::kUsage, argc, argv, relative_map::run);
}
