// navigation_line record: a line from poses in a bag, or as they come in.
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <relative_map/LocalizationEstimate.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/NavSatFix.h>
#include <tf2_ros/transform_listener.h>
#include <topic_tools/shape_shifter.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "bag_input.hpp"
#include "drive_journal.hpp"
#include "master.hpp"
#include "navigation_line_command.hpp"
#include "orderly_end.hpp"
#include "pose_collector.hpp"

namespace relative_map {
namespace {

using Remappings = std::map<std::string, std::string>;
using Words = std::vector<std::string>;

constexpr std::size_t kMostRemarks = 5;  // of one kind

/// Time that no one sets: as long as the computer runs, and from the time of ROS on.
class SteadyClock {
 public:
  SteadyClock() : start_(ros::Time::now()), steady_start_(ros::SteadyTime::now()) {
    if (start_.isZero()) start_ = ros::Time(ros::WallTime::now().toSec());
  }
  ros::Time now() const { return start_ + ros::Duration((ros::SteadyTime::now() - steady_start_).toSec()); }

 private:
  ros::Time start_;
  ros::SteadyTime steady_start_;
};

void add_to(PoseCollector& poses, const DriveJournal::Event& event, const ros::Time& received) {
  const topic_tools::ShapeShifter& message = *event.getConstMessage();
  const std::string type = message.getDataType(), publisher = event.getPublisherName();
  if (type == "relative_map/LocalizationEstimate") {
    poses.add(*message.instantiate<LocalizationEstimate>(), received, publisher);
  } else if (type == "nav_msgs/Odometry") {
    poses.add(*message.instantiate<nav_msgs::Odometry>(), received, publisher);
  } else if (type == "geometry_msgs/PoseStamped") {
    poses.add(*message.instantiate<geometry_msgs::PoseStamped>(), received, publisher);
  } else if (type == "sensor_msgs/NavSatFix") {
    poses.add(*message.instantiate<sensor_msgs::NavSatFix>(), received, publisher);
  } else {
    throw std::runtime_error("is of type " + type + ", which holds no poses that are read here");
  }
}

/// Collects what is published until it is interrupted, or `duration` [s] have passed. Throws for what makes
/// no sense from the beginning; what comes after a good beginning ends the recording and is told, and what
/// there is by then is kept.
void listen(const std::string& topic, double duration, DriveJournal& journal, PoseCollector& poses) {
  ros::NodeHandle nh;
  const SteadyClock clock;
  std::string fault;
  const std::string name = nh.resolveName(topic);
  const boost::function<void(const DriveJournal::Event&)> receive = [&](const DriveJournal::Event& event) {
    try {
      journal.add(name, clock.now(), event);
      add_to(poses, event, clock.now());
    } catch (const std::exception& error) {
      fault = topic + ": " + error.what();
    }
  };
  ros::SubscribeOptions options;
  options.topic = name;
  options.queue_size = 1000;
  options.md5sum = ros::message_traits::md5sum<topic_tools::ShapeShifter>();
  options.datatype = ros::message_traits::datatype<topic_tools::ShapeShifter>();
  options.helper = boost::make_shared<
      ros::SubscriptionCallbackHelperT<const ros::MessageEvent<topic_tools::ShapeShifter const>&>>(receive);
  const ros::Subscriber subscriber = nh.subscribe(options);
  const boost::function<void(const tf2_msgs::TFMessageConstPtr&)> keep_transforms =
      [&](const tf2_msgs::TFMessageConstPtr& transforms) { journal.add(clock.now(), *transforms); };
  const ros::Subscriber transforms = nh.subscribe<tf2_msgs::TFMessage>("/tf_static", 100, keep_transforms);
  std::fprintf(stderr, "recording %s; interrupt with Ctrl-C to finish\n", name.c_str());
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(duration);
  ros::WallTime told = ros::WallTime::now();
  std::string missing;
  while (ros::ok() && fault.empty() && missing.empty() && (duration <= 0.0 || ros::WallTime::now() < end)) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
    if (ros::WallTime::now() - told < ros::WallDuration(5.0)) continue;
    told = ros::WallTime::now();
    std::fprintf(stderr, "%zu poses\n", poses.size());
    missing = poses.missing_transform();  // now, and not when the drive is over
  }
  if (!missing.empty()) {
    journal.remove();  // of some seconds
    throw std::runtime_error(topic + ": " + missing);
  }
  if (poses.size() == 0) {
    journal.remove();
    throw std::runtime_error(!fault.empty() ? fault : "nothing that can be used was published on " + topic);
  }
  if (!fault.empty()) std::fprintf(stderr, "%s: recorded until then\n", fault.c_str());
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

void print_clock_steps(const std::vector<core::ClockStep>& steps) {
  for (std::size_t i = 0; i < std::min(steps.size(), kMostRemarks); ++i) {
    const core::ClockStep& step = steps[i];
    if (step.step == 0.0) {
      std::printf("the stamps stand still at %.3f", step.stamp);
    } else {
      std::printf("the clock of the stamps was set %s by %.3f s, to %.3f",
                  step.step < 0.0 ? "back" : "forward", std::abs(step.step), step.stamp);
    }
    std::printf(": taken out, by the times when the poses came\n");
  }
  if (steps.size() > kMostRemarks) std::printf("and so %zu times more\n", steps.size() - kMostRemarks);
}

void print_way(const PoseCollector& poses, const core::Recording& recording) {
  const core::WayShares& way = recording.way;
  std::printf("%.0f m of the way are kept (%.0f %%), %.0f m are lost, %.0f m were reversed\n", way.kept,
              100.0 * way.share(), way.lost, way.reversed);
  if (recording.doubtful > 0 || recording.scattered > 0) {
    std::printf("%zu poses left out that are stated to be worse than --max-noise, %zu that scatter by more\n",
                recording.doubtful, recording.scattered);
  }
  const double stated = poses.stated_deviation();
  if (std::isfinite(stated)) {
    std::printf(
        "the receiver states a standard deviation of %.2f m, and so far the line may lie beside the road; "
        "from "
        "fix to fix it is %.2f m\n",
        stated, recording.noise);
  }
  if (poses.of_others() > 0) std::printf("%zu poses of other sources left out\n", poses.of_others());
}

/// What a person should know of the recording, a line each.
void print_remarks(const PoseCollector& poses, const core::Recording& recording,
                   const std::string& base_frame, const CarriedPoses& carried) {
  print_way(poses, recording);
  print_clock_steps(carried.clock_steps);
  if (!recording.outliers.empty()) {
    const auto farthest = std::max_element(
        recording.outliers.begin(), recording.outliers.end(),
        [](const core::PoseOutlier& a, const core::PoseOutlier& b) { return a.distance < b.distance; });
    std::printf("%zu poses left out as outliers, the farthest by %.1f m at stamp %.3f\n",
                recording.outliers.size(), farthest->distance, farthest->stamp);
  }
  if (!poses.links().empty()) {
    std::printf("carried from %s to '%s'; %zu poses left out for want of an orientation\n",
                listed(poses.links()).c_str(), base_frame.c_str(), carried.without_direction);
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
void collect(const CommandLine& line, const std::string& source, tf2_ros::Buffer& transforms,
             DriveJournal* journal, PoseCollector& poses) {
  if (journal != nullptr) {
    const tf2_ros::TransformListener listener(transforms);
    listen(source, line.number("--duration", 0.0, 0.0, 1e6), *journal, poses);
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

/// The end of a sentence about a fault.
std::string kept_in(const DriveJournal* journal) {
  if (journal == nullptr || journal->place().empty()) return "";
  return "; what was received is kept in " + journal->place();
}

int run_record(const Words& words, const Remappings& remappings) {
  const CommandLine line(words,
                         {"--topic", "--spacing", "--utm", "--origin", "--frame", "--duration", "--max-jump",
                          "--base-frame", "--orientation-convention", "--max-noise", "--source"},
                         {"--live", "--local"});
  const bool live = line.has("--live");
  const Words& files = line.files(live ? 1 : 2, live ? 1 : 2, live ? "OUT" : "BAG and OUT");
  core::RecorderParam param;
  param.spacing = line.number("--spacing", param.spacing, 0.01, 100.0);
  param.max_jump = line.number("--max-jump", param.max_jump, 0.1, 1e5);
  const std::string base_frame = frame_name(line.text("--base-frame", "base_link"));
  const OrientationConvention convention = convention_of(line);
  param.max_noise = line.number("--max-noise", param.max_noise, 0.01, 1000.0);
  if (live) {
    expect_savable(files.back(), {});
  } else {
    expect_savable(files.back(), {files[0]});
  }

  const std::string source = live ? line.text("--topic", "localization") : files[0];
  tf2_ros::Buffer transforms;
  PoseCollector poses(base_frame, convention, link_transforms(transforms));
  poses.listen_to(line.text("--source"));
  if (live) {
    ros::init(remappings, "navigation_line_record");
    wait_for_master();
    end_in_order();
  }
  const auto journal = live ? std::make_unique<DriveJournal>(files.back()) : nullptr;
  collect(line, source, transforms, journal.get(), poses);
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
  } catch (const UsageError& fault) {
    throw UsageError(fault.what() + kept_in(journal.get()));
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(source + ": " + fault.what() + kept_in(journal.get()));
  }
  file.header.frame_id = line.text("--frame", poses.frame().empty() ? "map" : poses.frame());
  file.line = recording.line;
  file.line.name = core::line_name(files.back());
  try {
    save_line(files.back(), file);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(fault.what() + kept_in(journal.get()));
  }
  if (journal) journal->remove();
  print_written(files.back(), file.line);
  std::printf(
      "%zu poses, %zu of them standing, %zu reversing (%zu points taken back), %zu without a fix; frame "
      "'%s', %s\n",
      poses.size() + poses.without_fix(), recording.standing, recording.reversing, recording.taken_back,
      poses.without_fix(), file.header.frame_id.c_str(), core::describe(file.header.reference).c_str());
  print_remarks(poses, recording, base_frame, carried);
  return 0;
}

}  // namespace

const Command kRecord = {"record", "a line from a drive, in a bag or live",
                         R"(Usage: navigation_line record BAG OUT [OPTION]...
       navigation_line record --live OUT [OPTION]...

Records the way that was driven forward, from relative_map/LocalizationEstimate, nav_msgs/Odometry,
geometry_msgs/PoseStamped or sensor_msgs/NavSatFix. Standing still adds nothing; reversing takes the line back to where
the vehicle goes forward again; single poses that jump away are left out, and so are those that
are stated, or seen, to be worse than --max-noise; what share of the way is kept is said, and less than half is refused.
A clock that is set back or forward meanwhile is told, and does no harm. Live, all is also written to OUT.recording.bag as
it comes in, until OUT is whole: if the power fails, save it by rosbag reindex, and record from it. OUT begins with a line that names the frame,
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
  --max-jump D             [m] between poses, more is a fault where no car is that fast (50)
  --max-noise D            [m] standard deviation of a pose: worse ones are left out (5)
  --source NAME            where several publish on the topic: the node or the frame whose poses are taken

Example: navigation_line record drive.bag raw.smoothed --topic /localization --utm 50N
         navigation_line record gps.bag raw.smoothed --local
)",
                         run_record};

}  // namespace relative_map
