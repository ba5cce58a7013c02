#include "pose_collector.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <relative_map/LocalizationEstimate.h>
#include <rosbag/view.h>
#include <sensor_msgs/NavSatFix.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "bag_input.hpp"
#include "relative_map/geometry/statistics.hpp"
#include "relative_map/pipeline/motion/input_check.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"

namespace relative_map {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kLostAtOnce = 5;  // messages, of those that a publisher counts

core::Time stamp_or(const ros::Time& stamp, const ros::Time& received) {
  return to_core(stamp.isZero() ? received : stamp);
}

core::Localization to_localization(const std_msgs::Header& header, const geometry_msgs::Pose& pose,
                                   const ros::Time& received) {
  core::Localization localization;
  localization.stamp = stamp_or(header.stamp, received);
  localization.position = {pose.position.x, pose.position.y, pose.position.z};
  const geometry_msgs::Quaternion& q = pose.orientation;
  localization.map_from_body = Eigen::Quaterniond(q.w, q.x, q.y, q.z);
  localization.heading = kNaN;
  return localization;
}

/// [m] of east and north, the greater one; NaN: not stated.
double deviation_of(const sensor_msgs::NavSatFix& fix) {
  if (fix.position_covariance_type == sensor_msgs::NavSatFix::COVARIANCE_TYPE_UNKNOWN) return kNaN;
  const double variance = std::max(fix.position_covariance[0], fix.position_covariance[4]);
  return variance > 0.0 ? std::sqrt(variance) : kNaN;
}

/// The node whose message this was; empty where the bag does not tell.
std::string publisher_of(const rosbag::MessageInstance& instance) {
  const auto header = instance.getConnectionHeader();
  const auto found = header ? header->find("callerid") : ros::M_string::iterator();
  return header && found != header->end() ? found->second : "";
}

/// NaN where neither heading nor orientation gives it.
double heading_of(const core::Localization& checked) {
  if (std::isfinite(checked.heading)) return checked.heading;
  if (checked.map_from_body.coeffs().isZero()) return kNaN;
  const Eigen::Vector3d forward = checked.map_from_body * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

}  // namespace

const std::vector<std::string>& PoseCollector::types() {
  static const std::vector<std::string> kTypes = {"relative_map/LocalizationEstimate", "nav_msgs/Odometry",
                                                  "geometry_msgs/PoseStamped", "sensor_msgs/NavSatFix"};
  return kTypes;
}

PoseCollector::PoseCollector(std::string base_frame, OrientationConvention convention,
                             LinkTransforms transforms)
    : base_frame_(std::move(base_frame)), convention_(convention), transforms_(std::move(transforms)) {}

bool PoseCollector::note_source(const std_msgs::Header& header, const std::string& publisher,
                                const std::string& frame, const ros::Time& received) {
  if (!only_.empty() && only_ != publisher && only_ != frame) {
    ++of_others_;
    return false;
  }
  arrival_ = {core::seconds_since_epoch(to_core(received)), header.seq};
  const std::string of_frame = frame.empty() ? "" : "frame '" + frame + "'";
  const std::string name = publisher.empty() ? of_frame : "'" + publisher + "' " + of_frame;
  const auto [source, is_new] = sources_.insert({name, {arrival_.received, arrival_.received}});
  if (!is_new) {
    source->second.first = std::min(source->second.first, arrival_.received);
    source->second.last = std::max(source->second.last, arrival_.received);
  }
  return true;
}

void PoseCollector::expect_one_source() const {
  for (auto a = sources_.begin(); a != sources_.end(); ++a) {
    for (auto b = std::next(a); b != sources_.end(); ++b) {
      // A node that was started anew has another name, but not at the same time.
      if (a->second.first > b->second.last || b->second.first > a->second.last) continue;
      throw std::runtime_error("its poses come from several sources at once, " + a->first + " and " +
                               b->first + ": name the node or the frame of one by --source");
    }
  }
}

void PoseCollector::note_frame(const std::string& frame) {
  const std::string name = frame_name(frame);
  if (has_frame_ && name != frame_) {
    throw std::runtime_error("the poses change from frame '" + frame_ + "' to '" + name + "'");
  }
  frame_ = name;
  has_frame_ = true;
}

void PoseCollector::add_pose(const core::Localization& pose, const std::string& frame,
                             const std::string& link) {
  note_frame(frame);
  const std::string name = link.empty() ? base_frame_ : frame_name(link);
  if (name != base_frame_) links_.insert(name);
  poses_.push_back({pose, name, arrival_});
}

template <>
void PoseCollector::add(const LocalizationEstimate& message, const ros::Time& received,
                        const std::string& publisher) {
  if (!note_source(message.header, publisher, "", received)) return;
  add_pose(to_core(message, convention_, received), message.header.frame_id, message.child_frame_id);
}

template <>
void PoseCollector::add(const nav_msgs::Odometry& message, const ros::Time& received,
                        const std::string& publisher) {
  if (!note_source(message.header, publisher, "", received)) return;
  add_pose(to_localization(message.header, message.pose.pose, received), message.header.frame_id,
           message.child_frame_id);
}

template <>
void PoseCollector::add(const geometry_msgs::PoseStamped& message, const ros::Time& received,
                        const std::string& publisher) {
  if (!note_source(message.header, publisher, "", received)) return;
  add_pose(to_localization(message.header, message.pose, received), message.header.frame_id, "");
}

template <>
void PoseCollector::add(const sensor_msgs::NavSatFix& message, const ros::Time& received,
                        const std::string& publisher) {
  const std::string link = frame_name(message.header.frame_id);
  if (!note_source(message.header, publisher, link, received)) return;
  const bool unset = message.latitude == 0.0 && message.longitude == 0.0;  // far out at sea
  const bool fix = message.status.status >= sensor_msgs::NavSatStatus::STATUS_FIX && !unset &&
                   std::isfinite(message.latitude) && std::isfinite(message.longitude);
  if (!fix) {
    ++without_fix_;
    return;
  }
  antenna_ = link == base_frame_ ? "" : link;
  places_.push_back({message.longitude, message.latitude, message.altitude});
  core::RecordedPose pose;
  pose.stamp = core::seconds_since_epoch(stamp_or(message.header.stamp, received));
  pose.heading = kNaN;
  pose.deviation = deviation_of(message);
  fixes_.push_back(pose);
  fix_arrivals_.push_back(arrival_);
}

double PoseCollector::stated_deviation() const {
  std::vector<double> deviations;
  for (const core::RecordedPose& pose : fixes_) deviations.push_back(pose.deviation);
  return core::median(std::move(deviations));
}

/// A clock that was set back while a bag was recorded puts its messages among those before. Their publisher
/// has counted them: where each step back in time lies between numbers that follow each other, these give the
/// order.
std::vector<core::RecordedPose> PoseCollector::in_order_of_sending(
    const std::vector<core::RecordedPose>& poses, const std::vector<Arrival>& arrivals) const {
  std::vector<std::size_t> order(poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<std::size_t> counted = order;
  std::stable_sort(counted.begin(), counted.end(),
                   [&](std::size_t a, std::size_t b) { return arrivals[a].sequence < arrivals[b].sequence; });
  bool by_number = true;
  for (std::size_t i = 1; i < counted.size() && by_number; ++i) {
    const Arrival &before = arrivals[counted[i - 1]], &now = arrivals[counted[i]];
    by_number = now.sequence > before.sequence &&
                (now.received >= before.received || now.sequence - before.sequence <= kLostAtOnce);
  }
  std::vector<core::RecordedPose> ordered;
  for (std::size_t i : by_number ? counted : order) {
    ordered.push_back(poses[i]);
    ordered.back().received = arrivals[i].received;
  }
  return ordered;
}

std::string PoseCollector::missing_transform() const {
  for (const std::string& link : links_) {
    if (transforms_(link, base_frame_, ros::Time())) continue;
    return "its poses are of '" + link + "', and there is no transform from that to '" + base_frame_ +
           "' in /tf_static: record it, too, or name the frame that the line shall be of by --base-frame";
  }
  return "";
}

CarriedPoses PoseCollector::poses(core::GeoReference& reference) const {
  if (const std::string fault = missing_transform(); !fault.empty()) throw std::runtime_error(fault);
  expect_one_source();
  CarriedPoses result;
  std::vector<Arrival> arrivals;
  for (const LinkPose& entry : poses_) {
    const core::Checked<core::Localization> checked = core::check_localization(entry.pose);
    core::Localization pose = checked.input;
    double heading = checked.refusal ? kNaN : heading_of(pose);
    if (entry.link != base_frame_) {
      if (!std::isfinite(heading)) {
        ++result.without_direction;
        continue;
      }
      pose = core::carry_to_base(pose, *transforms_(entry.link, base_frame_, ros::Time()));
      heading = pose.heading;
    }
    result.poses.push_back({core::seconds_since_epoch(pose.stamp), pose.position.x(), pose.position.y(),
                            pose.position.z(), heading});
    arrivals.push_back(entry.arrival);
  }
  if (geographic()) {
    if (reference.projection == core::Projection::kNone) reference = core::utm_zone_of(places_);
    const std::vector<core::LinePoint> points = core::project(places_, reference);
    for (std::size_t i = 0; i < points.size(); ++i) {
      core::RecordedPose pose = fixes_[i];
      pose.x = points[i].x;
      pose.y = points[i].y;
      pose.z = points[i].z;
      result.poses.push_back(pose);
      arrivals.push_back(fix_arrivals_[i]);
    }
  }
  result.poses = in_order_of_sending(result.poses, arrivals);
  result.clock_steps = core::mend_clock(result.poses);
  return result;
}

void read_poses(const rosbag::Bag& bag, const std::string& path, const std::string& topic,
                PoseCollector& poses, const std::function<void(double)>& progress) {
  const std::string name = find_topic(bag, path, topic, PoseCollector::types());
  try {
    rosbag::View view(bag, rosbag::TopicQuery(name));
    std::size_t done = 0;
    for (const rosbag::MessageInstance& instance : view) {
      progress(static_cast<double>(++done) / static_cast<double>(view.size()));
      const ros::Time received = instance.getTime();
      const std::string publisher = publisher_of(instance);
      if (const auto localization = instance.instantiate<LocalizationEstimate>()) {
        poses.add(*localization, received, publisher);
      } else if (const auto odometry = instance.instantiate<nav_msgs::Odometry>()) {
        poses.add(*odometry, received, publisher);
      } else if (const auto pose = instance.instantiate<geometry_msgs::PoseStamped>()) {
        poses.add(*pose, received, publisher);
      } else if (const auto fix = instance.instantiate<sensor_msgs::NavSatFix>()) {
        poses.add(*fix, received, publisher);
      } else {
        throw std::runtime_error(instance.getDataType() + " is of another definition than here");
      }
    }
  } catch (const std::exception& fault) {
    throw std::runtime_error(path + ", topic " + name + ": " + fault.what());
  }
}

}  // namespace relative_map
