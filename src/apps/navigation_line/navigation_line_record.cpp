// navigation_line record: a line from poses in a bag, or as they come in.
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <relative_map/LocalizationEstimate.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/NavSatFix.h>
#include <tf2_ros/transform_listener.h>
#include <topic_tools/shape_shifter.h>

#include <cstdio>
#include <sstream>

#include "bag_input.hpp"
#include "navigation_line_command.hpp"
#include "pose_collector.hpp"

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
          const ros::Time now = ros::Time::now();
          if (type == "relative_map/LocalizationEstimate") {
            poses.add(*message->instantiate<LocalizationEstimate>(), now);
          } else if (type == "nav_msgs/Odometry") {
            poses.add(*message->instantiate<nav_msgs::Odometry>(), now);
          } else if (type == "geometry_msgs/PoseStamped") {
            poses.add(*message->instantiate<geometry_msgs::PoseStamped>(), now);
          } else if (type == "sensor_msgs/NavSatFix") {
            poses.add(*message->instantiate<sensor_msgs::NavSatFix>(), now);
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
    // Now, and not when the drive is over.
    if (const std::string missing = poses.missing_transform(); !missing.empty())
      fault = topic + ": " + missing;
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

OrientationConvention convention_of(const CommandLine& line) {
  const std::string word = line.text("--orientation-convention", "flu");
  if (word == "flu") return OrientationConvention::kFlu;
  if (word == "rfu") return OrientationConvention::kRfu;
  throw UsageError("--orientation-convention must be flu or rfu, not '" + word + "'");
}

std::string listed(const std::set<std::string>& links) {
  std::string list;
  for (const std::string& link : links) list += (list.empty() ? "'" : ", '") + link + "'";
  return list;
}

/// Throws if poses were carried by orientations that can't be right.
void expect_sense(const PoseCollector& poses, const core::Recording& recording) {
  if (!recording.fault.empty()) throw std::runtime_error(recording.fault);
  if (poses.links().empty() || recording.headings_used) return;
  throw std::runtime_error("its poses are of " + listed(poses.links()) +
                           ", and can't be carried by their orientations, which lie across the motion in " +
                           std::to_string(recording.sideways) + " of " + std::to_string(recording.moving) +
                           " moving poses: are they filled, and is --orientation-convention right?");
}

/// What a person should know of the recording, a line each.
void print_remarks(const PoseCollector& poses, const core::Recording& recording,
                   const std::string& base_frame, std::size_t without_direction) {
  if (!recording.outliers.empty()) {
    const auto farthest = std::max_element(
        recording.outliers.begin(), recording.outliers.end(),
        [](const core::PoseOutlier& a, const core::PoseOutlier& b) { return a.distance < b.distance; });
    std::printf("%zu poses left out as outliers, the farthest by %.1f m at stamp %.3f\n",
                recording.outliers.size(), farthest->distance, farthest->stamp);
  }
  if (!poses.links().empty()) {
    std::printf("carried from %s to '%s'; %zu poses left out for want of an orientation\n",
                listed(poses.links()).c_str(), base_frame.c_str(), without_direction);
  }
  if (!poses.antenna().empty()) {
    std::printf(
        "the line is where the receiver '%s' was, and not '%s': fixes have no heading to be carried by\n",
        poses.antenna().c_str(), base_frame.c_str());
  }
  if (!recording.headings_used) {
    std::printf(
        "the orientations are not used, since they lie across the motion in %zu of %zu moving poses\n",
        recording.sideways, recording.moving);
  }
}

/// From the bag that is named, or from what is published. `source` is what a fault is about.
void collect(const CommandLine& line, const std::string& source, const Remappings& remappings,
             tf2_ros::Buffer& transforms, PoseCollector& poses) {
  if (line.has("--live")) {
    ros::init(remappings, "navigation_line_record");
    const tf2_ros::TransformListener listener(transforms);
    listen(source, line.number("--duration", 0.0, 0.0, 1e6), poses);
  } else {
    rosbag::Bag bag;
    open_bag(source, bag);
    load_static_transforms(bag, transforms);
    ProgressBar bar;
    read_poses(bag, source, line.text("--topic"), poses, [&](double done) { bar.show(done); });
  }
  if (poses.size() == 0 && poses.without_fix() > 0) {
    throw std::runtime_error(source + ": none of its " + std::to_string(poses.without_fix()) +
                             " messages has a fix");
  }
}

int run_record(const Words& words, const Remappings& remappings) {
  const CommandLine line(words,
                         {"--topic", "--spacing", "--utm", "--origin", "--frame", "--duration", "--max-jump",
                          "--base-frame", "--orientation-convention"},
                         {"--live", "--local"});
  const bool live = line.has("--live");
  const Words& files = line.files(live ? 1 : 2, live ? 1 : 2, live ? "OUT" : "BAG and OUT");
  core::RecorderParam param;
  param.spacing = line.number("--spacing", param.spacing, 0.01, 100.0);
  param.max_jump = line.number("--max-jump", param.max_jump, 0.1, 1e5);
  const std::string base_frame = frame_name(line.text("--base-frame", "base_link"));
  const OrientationConvention convention = convention_of(line);
  expect_savable(files.back());

  const std::string source = live ? line.text("--topic", "localization") : files[0];
  tf2_ros::Buffer transforms;
  PoseCollector poses(base_frame, convention, link_transforms(transforms));
  collect(line, source, remappings, transforms, poses);
  core::LineFile file;
  core::Recording recording;
  CarriedPoses carried;
  try {
    file.header.reference = wanted_reference(line, poses);
    carried = poses.poses(file.header.reference);
    if (carried.poses.empty() && carried.without_direction > 0) {
      throw std::runtime_error("none of its poses has an orientation to be carried from " +
                               listed(poses.links()) + " to '" + base_frame + "' by");
    }
    recording = core::record_line(carried.poses, param);
    expect_sense(poses, recording);
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
  print_remarks(poses, recording, base_frame, carried.without_direction);
  return 0;
}

}  // namespace

const Command kRecord = {"record", "a line from a drive, in a bag or live",
                         R"(Usage: navigation_line record BAG OUT [OPTION]...
       navigation_line record --live OUT [OPTION]...

Records the way that was driven forward, from relative_map/LocalizationEstimate, nav_msgs/Odometry,
geometry_msgs/PoseStamped or sensor_msgs/NavSatFix. Standing still adds nothing; reversing takes the line back to where
the vehicle goes forward again; single poses that jump away are left out. OUT begins with a line that names the frame,
and the zone or origin. Poses of another link (child_frame_id) are carried to the base frame by /tf_static, in the bag or
live; those of PoseStamped are taken to be of the base frame, and a NavSatFix has no heading to be carried by.

  --topic TOPIC            of the poses (the only one in the bag; live: localization)
  --spacing D              [m] of the line's points (0.5)
  --live                   from what is published, until Ctrl-C or for --duration S seconds
  --base-frame NAME        of the vehicle, whose way the line is (base_link)
  --orientation-convention flu|rfu   of LocalizationEstimate: rfu is Apollo's, whose yaw is heading - 90 degrees (flu)
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
