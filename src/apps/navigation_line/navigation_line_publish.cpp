// navigation_line publish: the navigator.
#include <relative_map/NavigationInfo.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>
#include <cstdio>

#include "master.hpp"
#include "navigation_line_command.hpp"
#include "orderly_end.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/tools/line_edit.hpp"

namespace relative_map {
namespace {

using Remappings = std::map<std::string, std::string>;
using Words = std::vector<std::string>;

std::vector<double> priorities_of(const CommandLine& line, std::size_t count) {
  std::vector<double> priorities;
  for (std::size_t i = 0; i < count; ++i) priorities.push_back(static_cast<double>(i));
  if (!line.has("--priority")) return priorities;
  priorities = parse_numbers("--priority", line.text("--priority"), count, count);
  for (double priority : priorities) {
    if (!(priority >= 0.0 && priority <= 1e9 && priority == std::floor(priority))) {
      throw UsageError("--priority must be whole numbers from 0 on, one a file");
    }
  }
  return priorities;
}

int run_publish(const Words& words, const Remappings& remappings) {
  const CommandLine line(words, {"--priority", "--frame", "--duration", "--spacing"}, {"--by-curvature"});
  const Words& files = line.files(1, 1000, "one or more files");
  const std::vector<double> priorities = priorities_of(line, files.size());
  const double spacing = line.number("--spacing", 0.0, 0.01, 1000.0);
  core::LineHeader header;
  header.frame_id = line.text("--frame");
  core::NavigationInfo info;
  for (std::size_t i = 0; i < files.size(); ++i) {
    core::LineFile file = load_line(files[i]);
    if (const std::string why = core::merge(header, file.header); !why.empty()) {
      throw std::runtime_error(files[i] + ": does not fit to the others: " + why);
    }
    if (line.has("--by-curvature") || spacing > 0.0) {
      const core::EditableLine in = core::make_editable(file.line);
      file.line = core::make_recorded(
          spacing > 0.0 ? core::resample(in, spacing)
                        : core::resample_by_curvature(in, core::default_curvature_spacing()));
    }
    file.line.priority = static_cast<std::uint32_t>(priorities[i]);
    info.lines.push_back(std::move(file.line));
  }
  for (std::size_t i = 0; i < files.size(); ++i) print_written(files[i], info.lines[i]);
  info.frame_id = header.frame_id.empty() ? "map" : header.frame_id;

  ros::init(remappings, "navigator");
  wait_for_master();
  end_in_order();
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<NavigationInfo>("navigation", 1, true);
  NavigationInfo message = to_message(info);
  message.header.stamp = ros::Time::now();
  publisher.publish(message);
  std::printf("published %zu lines in frame '%s' on %s; runs on for those that come later\n",
              info.lines.size(), info.frame_id.c_str(), publisher.getTopic().c_str());
  std::fflush(stdout);
  const double duration = line.number("--duration", 0.0, 0.0, 1e9);
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(duration);
  while (ros::ok() && (duration <= 0.0 || ros::WallTime::now() < end)) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  }
  return 0;
}

}  // namespace

const Command kPublish = {"publish", "the navigator: lines for the map node",
                          R"(Usage: navigation_line publish FILE... [OPTION]...

Publishes the lines on `navigation`, latched, and runs until it is interrupted. The first file has priority 0, which is
the best. Files must be of one frame and zone, as far as they say.

  --priority P,P,...   another order: a whole number for each file
  --by-curvature       with points resampled: 3.0, 1.0, 0.4, 0.1 m above 0, 0.002, 0.008, 0.02 1/m
  --spacing D          [m] with points resampled evenly
  --frame NAME         the map frame (the files'; if they name none: map)
  --duration S         [s] end by itself

Example: rosrun relative_map navigation_line publish middle.smoothed left.smoothed right.smoothed
)",
                          run_publish};

}  // namespace relative_map
