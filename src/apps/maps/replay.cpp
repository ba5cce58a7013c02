// Runs the node's own pipeline over a bag: no master, no clock, and the same maps each time.
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2/buffer_core.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bag_input.hpp"
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

/// [s] Exact, and of any size: ros::Duration holds 68 years, and throws where a stamp is scrap.
double seconds_between(const ros::Time& from, const ros::Time& to) {
  return 1e-9 * static_cast<double>(static_cast<std::int64_t>(to.toNSec() - from.toNSec()));
}

struct Arguments {
  std::string input, output, config, urdf;
};

/// A call that can't be carried out as it was written.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

Arguments parse(const std::vector<std::string>& words) {
  Arguments arguments;
  std::vector<std::string> files;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--config" || words[i] == "--urdf") {
      if (i + 1 == words.size()) throw UsageError(words[i] + " needs a file");
      (words[i] == "--config" ? arguments.config : arguments.urdf) = words[i + 1];
      ++i;
    } else if (words[i].size() > 1 && words[i].front() == '-') {
      throw UsageError("unknown option " + words[i]);
    } else {
      files.push_back(words[i]);
    }
  }
  if (files.size() != 2) throw UsageError("two bags are needed: IN.bag and OUT.bag");
  arguments.input = files[0];
  arguments.output = files[1];
  std::error_code not_there;
  if (arguments.input == arguments.output ||
      std::filesystem::equivalent(arguments.input, arguments.output, not_there)) {
    throw UsageError("IN.bag and OUT.bag are the same file");
  }
  return arguments;
}

std::string read_file(const std::string& file) {
  std::ifstream stream(file);
  std::stringstream text;
  if (!stream || !(text << stream.rdbuf())) throw std::runtime_error(file + ": can't be read, or is empty");
  return text.str();
}

/// A bar on a terminal; silent elsewhere.
class ProgressBar {
 public:
  explicit ProgressBar(double length) : length_(length), shown_(isatty(STDERR_FILENO) != 0) {}
  ~ProgressBar() {
    if (shown_) std::fputs("\n", stderr);
  }
  void show(double done) {
    const int percent = length_ > 0.0 ? static_cast<int>(100.0 * done / length_) : 100;
    if (!shown_ || percent == last_percent_) return;
    last_percent_ = percent;
    const std::string bar(static_cast<std::size_t>(percent / 2), '#');
    std::fprintf(stderr, "\r[%-50s] %3d %%", bar.c_str(), percent);
  }

 private:
  double length_;
  bool shown_;
  int last_percent_ = -1;
};

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
    ProgressBar progress(seconds_between(start, view.getEndTime()));
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
      progress.show(seconds_between(start, now));
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
  const auto lines = MapEngine::prepare(to_message(load_lines(files, "")), config.pipeline);
  expect_all_loaded(*lines, files.size());
  return lines;
}

void run(const Arguments& arguments) {
  const ParameterSet parameters = arguments.config.empty() ? ParameterSet() : read_yaml(arguments.config);
  const std::string urdf = arguments.urdf.empty() ? "" : read_file(arguments.urdf);
  const NodeConfig config = make_node_config(parameters, urdf);
  const auto lines = configured_lines(arguments.config, config);

  expect_bag_writable(arguments.output);
  rosbag::Bag input;
  open_bag(arguments.input, input);
  WholeBag output(arguments.output);
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
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 1 && (words[0] == "--help" || words[0] == "-h")) {
    std::cout << relative_map::kUsage;
    return 0;
  }
  try {
    relative_map::run(relative_map::parse(words));
  } catch (const relative_map::UsageError& fault) {
    std::cerr << "replay: " << fault.what() << "\n\n" << relative_map::kUsage;
    return 2;
  } catch (const std::exception& fault) {
    std::cerr << "replay: " << fault.what() << "\n";
    return 1;
  }
  return 0;
}
