#include "relative_map/ros/lidar/ndt_localizer_node.hpp"

#include <relative_map/LidarMatch.h>

#include <algorithm>
#include <cmath>

#include "relative_map/localization/clouds/cloud_filters.hpp"
#include "relative_map/ros/messages/cloud_conversions.hpp"
#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

/// None where the numbers are no pose.
std::optional<Eigen::Isometry3d> pose_of(const geometry_msgs::Pose& pose) {
  const Eigen::Quaterniond q(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z);
  const Eigen::Vector3d position(pose.position.x, pose.position.y, pose.position.z);
  if (!position.allFinite() || !q.coeffs().allFinite() || std::abs(q.norm() - 1.0) > 0.01)
    return std::nullopt;
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = q.normalized().toRotationMatrix();
  result.translation() = position;
  return result;
}

geometry_msgs::Pose message_of(const Eigen::Isometry3d& pose) {
  geometry_msgs::Pose message;
  const Eigen::Quaterniond q(pose.linear());
  message.position.x = pose.translation().x();
  message.position.y = pose.translation().y();
  message.position.z = pose.translation().z();
  message.orientation.x = q.x();
  message.orientation.y = q.y();
  message.orientation.z = q.z();
  message.orientation.w = q.w();
  return message;
}

template <class Array>
void fill(const core::Matrix6& covariance, Array& array) {
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) array[6 * r + c] = covariance(r, c);
  }
}

Eigen::Vector3d vector_of(const geometry_msgs::Vector3& v) {
  const Eigen::Vector3d vector(v.x, v.y, v.z);
  return vector.allFinite() ? vector : Eigen::Vector3d::Zero();
}

}  // namespace

NdtLocalizerNode::NdtLocalizerNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : nh_(nh),
      private_nh_(private_nh),
      config_(make_ndt_config(parameters_of(private_nh))),
      transform_listener_(transforms_),
      link_transforms_(link_transforms(transforms_)),
      engine_(config_),
      diagnostics_(nh, private_nh, private_nh.getNamespace()) {
  pose_publisher_ = nh_.advertise<geometry_msgs::PoseWithCovarianceStamped>("map_pose", 10);
  verdict_publisher_ = private_nh_.advertise<LidarMatch>("match", 10);
  align_service_ = private_nh_.advertiseService("align", &NdtLocalizerNode::on_align, this);
  odometry_subscriber_ =
      nh_.subscribe("odometry", 50, &NdtLocalizerNode::on_odometry, this, ros::TransportHints().tcpNoDelay());
  initial_pose_subscriber_ = nh_.subscribe("initialpose", 1, &NdtLocalizerNode::on_initial_pose, this);
  // One cloud: while it is matched, older ones are worth less than the next.
  points_subscriber_ =
      nh_.subscribe("points", 1, &NdtLocalizerNode::on_points, this, ros::TransportHints().tcpNoDelay());
  diagnostics_.setHardwareID("none");
  diagnostics_.add("NDT localizer",
                   [this](diagnostic_updater::DiagnosticStatusWrapper& status) { summarize(status); });
  diagnostics_timer_ = nh_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  ROS_INFO_STREAM("map: " << engine_.info().tiles.size() << " tiles in frame '" << engine_.info().frame_id
                          << "', voxels of " << engine_.info().resolution << " m");
}

NdtLocalizerNode::~NdtLocalizerNode() {
  // A nodelet is unloaded while its callbacks run on: each of them must have ended before any member goes.
  diagnostics_timer_.stop();
  for (ros::Subscriber* subscriber :
       {&points_subscriber_, &odometry_subscriber_, &initial_pose_subscriber_}) {
    subscriber->shutdown();
  }
  align_service_.shutdown();
}

void NdtLocalizerNode::complain(const std::string& sentence) {
  if (log_.due(sentence, ros::WallTime::now())) ROS_WARN_STREAM("points: " << sentence);
}

core::PointCloud NdtLocalizerNode::base_cloud(const sensor_msgs::PointCloud2& message, std::string& fault) {
  core::PointCloud cloud = to_core(message, fault);
  if (fault.empty() && cloud.empty()) fault = "the cloud has no points";
  if (!fault.empty()) return cloud;
  const std::string frame = frame_name(message.header.frame_id);
  const auto base_from_lidar = link_transforms_(config_.base_frame, frame, message.header.stamp);
  if (!base_from_lidar) {
    fault = "no transform from '" + frame + "' to '" + config_.base_frame + "'";
    return cloud;
  }
  // About the sensor: the vehicle's own body is near to it, and not to the rear axle.
  return core::transformed(core::crop(cloud, config_.near, config_.far), *base_from_lidar);
}

void NdtLocalizerNode::on_points(const sensor_msgs::PointCloud2ConstPtr& message) {
  const ros::WallTime begin = ros::WallTime::now();
  last_cloud_ = begin;
  core::PointCloud cloud = base_cloud(*message, last_fault_);
  if (!last_fault_.empty()) return complain(last_fault_);
  last_ = engine_.on_cloud(std::move(cloud), message->header.stamp.toSec());
  last_seconds_ = (ros::WallTime::now() - begin).toSec();
  for (const std::string& fault : last_.map_faults) {
    if (log_.due(fault, ros::WallTime::now())) ROS_ERROR_STREAM("map: " << fault);
  }
  if (!last_.verdict.believed) complain(last_.verdict.reasons.empty() ? "" : last_.verdict.reasons.front());
  publish(last_, message->header.stamp, last_seconds_);
}

void NdtLocalizerNode::publish(const NdtEngineResult& result, const ros::Time& stamp, double seconds) {
  LidarMatch match;
  match.header.stamp = stamp;
  match.header.frame_id = engine_.info().frame_id;
  match.child_frame_id = config_.base_frame;
  match.believed = result.verdict.believed;
  match.reasons = result.verdict.reasons;
  match.remarks = result.verdict.remarks;
  match.pose = message_of(result.map_from_base);
  fill(result.verdict.uncertainty.covariance, match.covariance);
  match.likelihood = result.verdict.likelihood;
  match.upright_likelihood = result.verdict.upright_likelihood;
  match.overlap = result.verdict.overlap;
  match.condition = result.verdict.uncertainty.condition;
  match.correction = result.correction;
  match.iterations = result.iterations;
  match.refused_in_a_row = result.refused_in_a_row;
  match.match_time = seconds;
  verdict_publisher_.publish(match);
  if (!result.verdict.believed) return;
  geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header = match.header;
  pose.pose.pose = match.pose;
  fill(result.verdict.uncertainty.covariance, pose.pose.covariance);
  pose_publisher_.publish(pose);
}

void NdtLocalizerNode::on_odometry(const nav_msgs::OdometryConstPtr& message) {
  const std::string frame = frame_name(message->header.frame_id);
  if (frame != engine_.info().frame_id) {
    complain("odometry is in frame '" + frame + "', but the map in '" + engine_.info().frame_id + "'");
    return;
  }
  if (frame_name(message->child_frame_id) != config_.base_frame) {
    complain("odometry is of '" + frame_name(message->child_frame_id) + "', not of '" + config_.base_frame +
             "'");
    return;
  }
  const auto pose = pose_of(message->pose.pose);
  if (!pose)
    return complain("odometry is no pose: its numbers are not finite, or its quaternion is not of length 1");
  ExpectedPose odometry;
  odometry.stamp = message->header.stamp.toSec();
  odometry.map_from_base = *pose;
  odometry.velocity = vector_of(message->twist.twist.linear);
  odometry.angular_velocity = vector_of(message->twist.twist.angular);
  engine_.on_odometry(odometry);
}

void NdtLocalizerNode::on_initial_pose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
  const auto pose = pose_of(message->pose.pose);
  const std::string frame = frame_name(message->header.frame_id);
  if (!pose || frame != engine_.info().frame_id) {
    ROS_WARN_STREAM(
        "initialpose: " << (pose ? "it is in frame '" + frame + "', not the map's" : "it is no pose"));
    return;
  }
  const auto& covariance = message->pose.covariance;
  const double spread = std::sqrt(std::max(0.0, std::max(covariance[0], covariance[7])));
  const double yaw_spread = std::sqrt(std::max(0.0, covariance[35]));
  const double radius = std::clamp(3.0 * spread, config_.start_radius, 30.0);
  // No covariance: nothing is known of the direction.
  const double yaw_range = yaw_spread > 0.0 ? std::clamp(3.0 * yaw_spread, 0.2, 3.14159265) : 3.14159265;
  engine_.start_at(*pose, radius, yaw_range);
}

bool NdtLocalizerNode::on_align(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.message = engine_.start_again();
  response.success = response.message.empty();
  if (response.success) response.message = "the place is searched with the next cloud";
  return true;
}

void NdtLocalizerNode::summarize(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  if (last_cloud_.isZero() || (ros::WallTime::now() - last_cloud_).toSec() > 2.0) {
    status.summary(DiagnosticStatus::WARN, "no clouds come");
  } else if (!last_fault_.empty()) {
    status.summary(DiagnosticStatus::ERROR, last_fault_);
  } else if (last_.verdict.believed) {
    status.summary(DiagnosticStatus::OK,
                   last_.verdict.remarks.empty() ? "the place is known" : last_.verdict.remarks.front());
  } else {
    const bool lost = last_.refused_in_a_row >= config_.refusals;
    status.summary(
        lost ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN,
        last_.verdict.reasons.empty() ? "no cloud was matched yet" : last_.verdict.reasons.front());
  }
  status.add("likelihood", last_.verdict.likelihood);
  status.add("likelihood of what stands on the ground", last_.verdict.upright_likelihood);
  status.add("overlap", last_.verdict.overlap);
  status.add("condition", last_.verdict.uncertainty.condition);
  status.add("correction [m]", last_.correction);
  status.add("refused in a row", last_.refused_in_a_row);
  status.add("time of a match [ms]", 1e3 * last_seconds_);
}

}  // namespace relative_map
