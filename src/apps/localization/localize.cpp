// Runs the localizer over a bag of sensors: no master, no clock, and the same poses each time.
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "bag_input.hpp"
#include "command_line.hpp"
#include "relative_map/io/text.hpp"
#include "relative_map/io/whole_file.hpp"
#include "relative_map/ros/localizer/localizer_engine.hpp"
#include "relative_map/ros/setup/urdf_frames.hpp"
#include "whole_bag.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    "usage: rosrun relative_map localize IN.bag OUT.bag [--config FILE] [--urdf FILE]\n"
    "\n"
    "Finds the vehicle's pose from the sensors in IN.bag, and writes it to OUT.bag on /localization and "
    "/odometry,\n"
    "each at its measurement's time. Topics that are read, as far as they are there: /fix, /fix_velocity, "
    "/heading,\n"
    "/imu, /wheel_odometry, /chassis, /map_pose, /tf_static, /tf. Without /imu the planar method is taken.\n"
    "\n"
    "  --config FILE   parameters as in config/localization.yaml\n"
    "  --urdf FILE     the vehicle, for where its sensors are\n";

const std::set<std::string> kTopics = {"/localization", "/odometry"};
const std::set<std::string> kInputs = {"fix",     "fix_velocity", "heading", "imu", "wheel_odometry",
                                       "chassis", "map_pose"};

struct Arguments {
  std::string input, output, config, urdf;
};

Arguments parse(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--config", "--urdf"});
  line.files(2, 2, "IN.bag and OUT.bag");
  Arguments arguments{line.files()[0], line.files()[1], line.text("--config"), line.text("--urdf")};
  try {
    core::expect_not_among(arguments.output, {arguments.input});
  } catch (const std::runtime_error&) {
    throw UsageError("IN.bag and OUT.bag are the same file");
  }
  core::expect_not_among(arguments.output, {arguments.config, arguments.urdf});
  return arguments;
}

/// A sensor's place does not change, whichever topic tells it.
void load_transforms(const rosbag::Bag& bag, tf2::BufferCore& transforms) {
  for (const rosbag::MessageInstance& instance :
       rosbag::View(bag, rosbag::TopicQuery(std::vector<std::string>{"/tf", "tf"}))) {
    const auto message = instance.instantiate<tf2_msgs::TFMessage>();
    if (!message) continue;
    add_transforms(*message, true, transforms);
  }
  load_static_transforms(bag, transforms);
}

/// Complaints that differ in their numbers only are one, with a count.
class Complaints {
 public:
  void add(const std::vector<std::string>& remarks) {
    static const std::regex kNumber("[0-9]+(\\.[0-9]+)?");
    for (const std::string& remark : remarks) {
      auto& [first, count] = all_[std::regex_replace(remark, kNumber, "#")];
      if (++count == 1) first = remark;
    }
  }
  void print() const {
    for (const auto& [unused, entry] : all_) {
      std::fprintf(stderr, "%s (%zu times)\n", entry.first.c_str(), entry.second);
    }
  }

 private:
  std::map<std::string, std::pair<std::string, std::size_t>> all_;
};

class Localize {
 public:
  Localize(const LocalizerNodeConfig& config, const tf2::BufferCore& transforms, const rosbag::Bag& input,
           WholeBag& output)
      : input_(input), output_(output), engine_(config, link_transforms(transforms), 0.0) {}

  void run() {
    rosbag::View view(input_, [](const rosbag::ConnectionInfo* connection) {
      return kInputs.count(frame_name(connection->topic)) > 0;
    });
    if (view.size() == 0) {
      throw std::runtime_error(
          "it has none of the topics /fix, /fix_velocity, /heading, /imu, /wheel_odometry, /chassis, "
          "/map_pose");
    }
    ProgressBar progress;
    std::size_t done = 0;
    for (const rosbag::MessageInstance& message : view) {
      deliver(message);
      for (const core::PoseEstimate& estimate : engine_.take_estimates()) write(estimate);
      complaints_.add(engine_.take_remarks());
      progress.show(static_cast<double>(++done) / view.size());
    }
  }

  void print_summary(double seconds) {
    complaints_.print();
    std::printf("%zu poses in %.2f s: %zu OK, %zu WARNING, %zu ERROR\n", ok_ + warning_ + error_, seconds,
                ok_, warning_, error_);
    const core::LocalizerReport report = engine_.localizer().report();
    static const char* const kNames[] = {"imu",     "wheels",       "fix",        "fix_velocity",
                                         "heading", "map position", "map heading"};
    for (int source = 1; source < core::kSources; ++source) {
      const core::SourceHealth& health = report.health[source];
      if (!health.heard()) continue;
      std::printf("%s: %zu used, %zu refused; innovation %.2f of what was expected, noise x%.1f\n",
                  kNames[source], static_cast<std::size_t>(health.accepted),
                  static_cast<std::size_t>(health.refused), std::sqrt(health.nis),
                  std::sqrt(health.noise_scale));
    }
    if (report.alignments > 0) {
      std::printf(
          "aligned %d times, made less certain %d times; wheel scale %.4f; mount yaw %.2f pitch %.2f deg; "
          "imu stamped %.3f +- %.3f s after the fixes\n",
          report.alignments, report.inflations, report.wheel_scale, report.mount_yaw * 180.0 / M_PI,
          report.mount_pitch * 180.0 / M_PI, report.stamp_offset, report.stamp_offset_stddev);
    }
  }

 private:
  void deliver(const rosbag::MessageInstance& message) {
    const std::string topic = frame_name(message.getTopic());
    const ros::Time received = message.getTime();
    const bool read =
        (topic == "imu" &&
         take<sensor_msgs::Imu>(message, [&](const auto& m) { engine_.on_imu(m, received); })) ||
        (topic == "fix" &&
         take<sensor_msgs::NavSatFix>(message, [&](const auto& m) { engine_.on_fix(m, received); })) ||
        (topic == "fix_velocity" &&
         (take<geometry_msgs::TwistStamped>(message,
                                            [&](const auto& m) { engine_.on_fix_velocity(m, received); }) ||
          take<geometry_msgs::TwistWithCovarianceStamped>(
              message, [&](const auto& m) { engine_.on_fix_velocity(m, received); }))) ||
        (topic == "heading" &&
         take<sensor_msgs::Imu>(message, [&](const auto& m) { engine_.on_heading(m, received); })) ||
        (topic == "wheel_odometry" &&
         (take<geometry_msgs::TwistStamped>(message,
                                            [&](const auto& m) { engine_.on_wheels(m, received); }) ||
          take<nav_msgs::Odometry>(message, [&](const auto& m) { engine_.on_wheels(m, received); }))) ||
        (topic == "chassis" &&
         take<Chassis>(message, [&](const auto& m) { engine_.on_chassis(m, received); })) ||
        (topic == "map_pose" && take<geometry_msgs::PoseWithCovarianceStamped>(
                                    message, [&](const auto& m) { engine_.on_map_pose(m, received); }));
    if (!read) {
      complaints_.add(
          {message.getTopic() + " has type " + message.getDataType() + ", which is not read from it"});
    }
  }

  template <class Message, class Handler>
  bool take(const rosbag::MessageInstance& instance, const Handler& handler) {
    const auto message = instance.instantiate<Message>();
    if (message) handler(*message);
    return message != nullptr;
  }

  void write(const core::PoseEstimate& estimate) {
    const ros::Time stamp = to_ros(estimate.stamp);
    output_.write("/localization", stamp, to_message(estimate, engine_.config()));
    if (const auto odometry = to_odometry(estimate, engine_.config())) {
      output_.write("/odometry", stamp, *odometry);
    }
    ++(estimate.code == core::EstimateCode::kOk        ? ok_
       : estimate.code == core::EstimateCode::kWarning ? warning_
                                                       : error_);
  }

  const rosbag::Bag& input_;
  WholeBag& output_;
  LocalizerEngine engine_;
  Complaints complaints_;
  std::size_t ok_ = 0, warning_ = 0, error_ = 0;
};

bool has_topic(const rosbag::Bag& bag, const std::string& name) {
  rosbag::View view(bag, [&name](const rosbag::ConnectionInfo* connection) {
    return frame_name(connection->topic) == name;
  });
  return view.size() > 0;
}

int run(const std::vector<std::string>& words) {
  const Arguments arguments = parse(words);
  LocalizerNodeConfig config =
      make_localizer_config(arguments.config.empty() ? ParameterSet() : read_yaml(arguments.config));
  tf2::BufferCore transforms;
  if (!arguments.urdf.empty()) add_urdf_frames(core::read_text(arguments.urdf), transforms);
  expect_bag_writable(arguments.output, kTopics);
  rosbag::Bag input;
  open_bag(arguments.input, input);
  load_transforms(input, transforms);
  if (config.localizer.method == core::Method::kInertial && !has_topic(input, "imu")) {
    std::cerr << "there is no /imu: the planar method is taken\n";
    config.localizer.method = core::Method::kPlanar;
  }
  WholeBag output(arguments.output, kTopics);
  Localize localize(config, transforms, input, output);
  const auto start = std::chrono::steady_clock::now();
  try {
    localize.run();
    output.close();
  } catch (const std::exception& fault) {
    throw std::runtime_error(arguments.input + ": can't be localized: " + fault.what());
  }
  localize.print_summary(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("localize", relative_map::kUsage, argc, argv, relative_map::run);
}
