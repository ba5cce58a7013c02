// navigation_line record: a line from poses in a bag, or as they come in.
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <relative_map/LocalizationEstimate.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/NavSatFix.h>
#include <topic_tools/shape_shifter.h>

#include <cstdio>

#include "navigation_line_bag.hpp"
#include "navigation_line_command.hpp"

namespace relative_map {
namespace {

using Remappings = std::map<std::string, std::string>;
using Words = std::vector<std::string>;

/// Collects what is published until it is interrupted, or `duration` [s] have passed.
void listen(const std::string& topic, double duration, PoseCollector& poses) {
  ros::NodeHandle nh;
  std::string fault;
  const boost::function<void(const topic_tools::ShapeShifter::ConstPtr&)> receive =
      [&](const topic_tools::ShapeShifter::ConstPtr& message) {
        try {
          const std::string type = message->getDataType();
          if (type == "relative_map/LocalizationEstimate") {
            poses.add(*message->instantiate<LocalizationEstimate>());
          } else if (type == "nav_msgs/Odometry") {
            poses.add(*message->instantiate<nav_msgs::Odometry>());
          } else if (type == "geometry_msgs/PoseStamped") {
            poses.add(*message->instantiate<geometry_msgs::PoseStamped>());
          } else if (type == "sensor_msgs/NavSatFix") {
            poses.add(*message->instantiate<sensor_msgs::NavSatFix>());
          } else {
            fault = topic + " is of type " + type + ", which holds no poses that are read here";
          }
        } catch (const std::exception& error) {
          fault = topic + ": " + error.what();
        }
      };
  const ros::Subscriber subscriber = nh.subscribe(topic, 1000, receive);
  std::fprintf(stderr, "recording %s; interrupt with Ctrl-C to finish\n", subscriber.getTopic().c_str());
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(duration);
  ros::WallTime told = ros::WallTime::now();
  while (ros::ok() && fault.empty() && (duration <= 0.0 || ros::WallTime::now() < end)) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
    if (ros::WallTime::now() - told < ros::WallDuration(5.0)) continue;
    told = ros::WallTime::now();
    std::fprintf(stderr, "%zu poses\n", poses.size());
  }
  if (!fault.empty()) throw std::runtime_error(fault);
  if (poses.size() == 0) throw std::runtime_error("nothing that can be used was published on " + topic);
}

core::GeoReference wanted_reference(const CommandLine& line, const PoseCollector& poses) {
  core::GeoReference reference = reference_of(line);
  if (!line.has("--local") || !poses.geographic()) return reference;
  if (reference.projection != core::Projection::kNone) {
    throw UsageError("--local excludes --utm and --origin");
  }
  const core::GeoPoint& first = poses.places().front();
  reference.projection = core::Projection::kLocal;
  reference.latitude = first.latitude;
  reference.longitude = first.longitude;
  reference.altitude = std::isfinite(first.altitude) ? first.altitude : 0.0;
  return reference;
}

int run_record(const Words& words, const Remappings& remappings) {
  const CommandLine line(words,
                         {"--topic", "--spacing", "--utm", "--origin", "--frame", "--duration", "--max-jump"},
                         {"--live", "--local"});
  const bool live = line.has("--live");
  const Words& files = line.files(live ? 1 : 2, live ? 1 : 2, live ? "OUT" : "BAG and OUT");
  core::RecorderParam param;
  param.spacing = line.number("--spacing", param.spacing, 0.01, 100.0);
  param.max_jump = line.number("--max-jump", param.max_jump, 0.1, 1e5);

  PoseCollector poses;
  std::string source = live ? line.text("--topic", "localization") : files[0];
  if (live) {
    ros::init(remappings, "navigation_line_record");
    listen(source, line.number("--duration", 0.0, 0.0, 1e6), poses);
  } else {
    ProgressBar bar;
    read_poses(source, line.text("--topic"), poses, [&](double done) { bar.show(done); });
  }
  core::LineFile file;
  core::Recording recording;
  try {
    if (poses.size() == 0 && poses.without_fix() > 0) {
      throw std::runtime_error("none of its " + std::to_string(poses.without_fix()) + " messages has a fix");
    }
    file.header.reference = wanted_reference(line, poses);
    recording = core::record_line(poses.poses(file.header.reference), param);
    if (!recording.fault.empty()) throw std::runtime_error(recording.fault);
  } catch (const UsageError&) {
    throw;
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(source + ": " + fault.what());
  }
  file.header.frame_id = line.text("--frame", poses.frame().empty() ? "map" : poses.frame());
  file.line = recording.line;
  file.line.name = core::line_name(files.back());
  save_line(files.back(), file);
  print_written(files.back(), file.line);
  std::printf(
      "%zu poses, %zu of them standing, %zu reversing (%zu points taken back), %zu without a fix; frame "
      "'%s', %s\n",
      poses.size() + poses.without_fix(), recording.standing, recording.reversing, recording.taken_back,
      poses.without_fix(), file.header.frame_id.c_str(), core::describe(file.header.reference).c_str());
  return 0;
}

}  // namespace

const Command kRecord = {"record", "a line from a drive, in a bag or live",
                         R"(Usage: navigation_line record BAG OUT [OPTION]...
       navigation_line record --live OUT [OPTION]...

Records the way that was driven forward, from relative_map/LocalizationEstimate, nav_msgs/Odometry,
geometry_msgs/PoseStamped or sensor_msgs/NavSatFix. Standing still adds nothing; reversing takes the line back to where
the vehicle goes forward again. OUT begins with a line that names the frame, and the zone or origin.

  --topic TOPIC            of the poses (the only one in the bag; live: localization)
  --spacing D              [m] of the line's points (0.5)
  --live                   from what is published, until Ctrl-C or for --duration S seconds
  --frame NAME             of the map, in the file's first line (the poses'; of NavSatFix: map)
  --utm ZONE               NavSatFix goes to this zone, like 50N, or what the localization's coordinates are in
                           (the zone that all fixes lie in)
  --origin LAT,LON[,ALT]   the same for ENU about a place
  --local                  NavSatFix: ENU about the first fix
  --max-jump D             [m] between poses, more is a fault (50)

Example: navigation_line record drive.bag raw.smoothed --topic /localization --utm 50N
         navigation_line record gps.bag raw.smoothed --local
)",
                         run_record};

}  // namespace relative_map
