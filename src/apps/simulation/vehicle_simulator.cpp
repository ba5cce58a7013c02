#include "vehicle_simulator.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <relative_map/Chassis.h>
#include <relative_map/LocalizationEstimate.h>
#include <relative_map/NavigationInfo.h>
#include <ros/ros.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>

#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/simulation/recording_errors.hpp"

namespace relative_map {

namespace {

constexpr core::Duration kMaxLag = std::chrono::seconds(2);        // behind the clock that is caught up with
constexpr core::Duration kStandingTime = std::chrono::seconds(2);  // at the end of a line
constexpr const char* kLocalMapFrame = "local_map";

constexpr const char* kUsage =
    R"(Usage: rosrun relative_map vehicle_simulator _navigation_lines:="FILE..." [_PARAMETER:=VALUE]...

A car that drives along one of these lines (.smoothed files, from left to right), and publishes what a car with sensors
does: navigation, localization, chassis, perception/lane_markers, its transforms, and where it truly is. As a whole, with
the map and rviz: roslaunch relative_map demo.launch navigation_lines:="FILE..."

  _drive_line:=N             index of the line that it follows, from 0 (the one in the middle)
  _max_speed:=V              [m/s] on straights
  _seed:=N                   of the sensors' noise: the same seed gives the same drive
  _standing:=T               [s] at the start, before it drives off (0)
  _publish_tf:=BOOL          false: another node says on tf where the vehicle is (true)
  _publish_navigation:=BOOL  false: another node publishes the lines (true)
  _exit_at_end:=BOOL         true: the node ends when the car has come to the end of its line
  _repeat:=BOOL              true: it starts again there

What its sensors and lines may be wrong by is in config/simulator_errors.yaml, as private parameters; all is off unless
that file is loaded. A parameter that is unknown or impossible keeps it from starting. Exit codes: 0 done, 1 not started.
)";

core::Duration period_of(double rate) {
  return core::from_seconds(1.0 / rate);
}

geometry_msgs::Quaternion to_message(const Eigen::Quaterniond& rotation) {
  geometry_msgs::Quaternion message;
  message.x = rotation.x();
  message.y = rotation.y();
  message.z = rotation.z();
  message.w = rotation.w();
  return message;
}

LaneMarker to_message(const core::LaneMarker& marker) {
  LaneMarker message;
  message.lane_type = static_cast<uint8_t>(marker.type);
  message.quality = marker.quality;
  message.model_degree = 3;
  message.c0_position = marker.cubic.c0;
  message.c1_heading_angle = marker.cubic.c1;
  message.c2_curvature = marker.cubic.c2;
  message.c3_curvature_derivative = marker.cubic.c3;
  message.longitude_start = marker.longitude_start;
  message.longitude_end = marker.view_range;
  message.view_range = marker.view_range;
  return message;
}

Pose to_pose(const core::Localization& localization) {
  Pose pose;
  pose.position.x = localization.position.x();
  pose.position.y = localization.position.y();
  pose.orientation = to_message(localization.map_from_body);
  pose.heading = localization.heading;
  pose.euler_angles.z = localization.heading;
  pose.linear_velocity.x = localization.linear_velocity.x();
  pose.linear_velocity.y = localization.linear_velocity.y();
  // Driving on a plane, the body turns about the map's vertical axis.
  pose.angular_velocity.z = pose.angular_velocity_vrf.z = localization.angular_velocity_body.z();
  geometry_msgs::Vector3 not_given;
  not_given.x = not_given.y = not_given.z = std::nan("");
  pose.linear_acceleration = pose.linear_acceleration_vrf = not_given;
  return pose;
}

}  // namespace

VehicleSimulator::VehicleSimulator(ros::NodeHandle nh, SimulatorParameters parameters)
    : parameters_(std::move(parameters)),
      vehicle_(parameters_.lines[parameters_.drive_line], parameters_.simulation),
      sensors_{{{period_of(parameters_.localization_rate), &VehicleSimulator::publish_localization},
                {period_of(parameters_.chassis_rate), &VehicleSimulator::publish_chassis},
                {period_of(parameters_.lane_marker_rate), &VehicleSimulator::take_image}}} {
  localization_publisher_ = nh.advertise<LocalizationEstimate>("localization", 10);
  chassis_publisher_ = nh.advertise<Chassis>("chassis", 10);
  lane_markers_publisher_ = nh.advertise<LaneMarkers>("perception/lane_markers", 10);
  truth_publisher_ = ros::NodeHandle("~").advertise<geometry_msgs::PoseStamped>("truth", 200);
  if (parameters_.publish_navigation) {
    navigation_publisher_ = nh.advertise<NavigationInfo>("navigation", 1, true);
  }
}

void VehicleSimulator::run() {
  ros::Time::waitForValid();
  start_ = to_core(ros::Time::now());
  publish_navigation();
  while (ros::ok()) {
    Sensor& sensor = next_sensor();
    publish_lane_markers(sensor.due);
    wait_until(sensor.due);
    vehicle_.step(core::to_seconds(sensor.due - vehicle_.time()));
    if (finished()) return;
    (this->*sensor.publish)();
    sensor.due += sensor.period;
  }
}

VehicleSimulator::Sensor& VehicleSimulator::next_sensor() {
  return *std::min_element(sensors_.begin(), sensors_.end(),
                           [](const Sensor& a, const Sensor& b) { return a.due < b.due; });
}

void VehicleSimulator::wait_until(core::Duration due) {
  const core::Duration lag = to_core(ros::Time::now()) - (start_ + due);
  if (std::chrono::abs(lag) > kMaxLag) {  // the machine slept, or the clock was set: drive on from here
    start_ += lag;
  } else if (lag < core::Duration::zero()) {
    ros::Time::sleepUntil(to_ros(start_ + due));
  }
}

bool VehicleSimulator::finished() {
  if (!vehicle_.at_end()) return false;
  if (!stopped_at_) {
    ROS_INFO("The vehicle has come to the end of its line");
    stopped_at_ = vehicle_.time();
  }
  if (vehicle_.time() - *stopped_at_ < kStandingTime) return false;
  if (parameters_.repeat) {
    ROS_INFO("The vehicle starts again");
    stopped_at_.reset();
    vehicle_.restart();
  }
  return parameters_.exit_at_end;
}

ros::Time VehicleSimulator::stamp() const {
  return to_ros(start_ + vehicle_.time());
}

void VehicleSimulator::publish_navigation() {
  // rviz computes in single precision: it needs a frame whose origin is near.
  const core::LinePoint& first = parameters_.lines.front().points.front();
  geometry_msgs::TransformStamped map_from_local_map;
  map_from_local_map.header.stamp = stamp();
  map_from_local_map.header.frame_id = parameters_.map_frame;
  map_from_local_map.child_frame_id = kLocalMapFrame;
  map_from_local_map.transform.translation.x = first.x;
  map_from_local_map.transform.translation.y = first.y;
  map_from_local_map.transform.rotation.w = 1.0;
  static_broadcaster_.sendTransform(map_from_local_map);

  if (!parameters_.publish_navigation) return;
  core::NavigationInfo recorded{parameters_.map_frame, {}};
  for (const core::RecordedLine& line : parameters_.lines) {
    // Each line was recorded on a drive of its own.
    const std::uint64_t seed = parameters_.simulation.seed + 1000000 * (recorded.lines.size() + 1);
    recorded.lines.push_back(core::record_line(line, parameters_.simulation.errors.recording, seed));
  }
  NavigationInfo message = to_message(recorded);
  message.header.stamp = stamp();
  navigation_publisher_.publish(message);
}

void VehicleSimulator::publish_localization() {
  const core::Localization localization = vehicle_.measure_localization();
  LocalizationEstimate message;
  message.header.stamp = message.measurement_time = stamp();
  message.header.frame_id = parameters_.map_frame;
  message.child_frame_id = parameters_.base_frame;
  message.pose = to_pose(localization);
  const core::NoiseParam& noise = parameters_.simulation.noise;
  const core::LocalizationErrorParam& errors = parameters_.simulation.errors.localization;
  message.uncertainty.position_std_dev.x = message.uncertainty.position_std_dev.y =
      std::hypot(noise.localization_position, errors.bias);
  message.uncertainty.orientation_std_dev.z = std::hypot(noise.localization_heading, errors.heading_bias);
  message.status.code = LocalizationStatus::OK;
  localization_publisher_.publish(message);
  if (parameters_.publish_tf) broadcast(localization);
  publish_truth();
}

/// Where the vehicle really is at the stamp of the localization: what maps can be judged by.
void VehicleSimulator::publish_truth() {
  const core::Pose2 pose = vehicle_.map_from_base();
  geometry_msgs::PoseStamped message;
  message.header.stamp = stamp();
  message.header.frame_id = parameters_.map_frame;
  message.pose.position.x = pose.position().x();
  message.pose.position.y = pose.position().y();
  message.pose.orientation =
      to_message(Eigen::Quaterniond(Eigen::AngleAxisd(pose.heading(), Eigen::Vector3d::UnitZ())));
  truth_publisher_.publish(message);
}

/// What the localization believes, since on a vehicle nobody knows better.
void VehicleSimulator::broadcast(const core::Localization& localization) {
  geometry_msgs::TransformStamped map_from_base;
  map_from_base.header.stamp = stamp();
  map_from_base.header.frame_id = parameters_.map_frame;
  map_from_base.child_frame_id = parameters_.base_frame;
  map_from_base.transform.translation.x = localization.position.x();
  map_from_base.transform.translation.y = localization.position.y();
  map_from_base.transform.rotation = to_message(localization.map_from_body);
  broadcaster_.sendTransform(map_from_base);
}

void VehicleSimulator::publish_chassis() {
  Chassis message;
  message.header.stamp = stamp();
  message.header.frame_id = parameters_.base_frame;
  message.engine_started = true;
  message.speed_mps = vehicle_.measure_chassis().speed;
  message.gear_location = Chassis::GEAR_DRIVE;
  message.driving_mode = Chassis::COMPLETE_AUTO_DRIVE;
  chassis_publisher_.publish(message);
}

void VehicleSimulator::take_image() {
  const core::LaneMarkers markers = vehicle_.measure_lane_markers();
  LaneMarkers message;
  message.header.stamp = stamp();
  message.header.frame_id = parameters_.base_frame;
  message.left_lane_marker = to_message(markers.left);
  message.right_lane_marker = to_message(markers.right);
  for (const core::LaneMarker& marker : markers.next_left) {
    message.next_left_lane_marker.push_back(to_message(marker));
  }
  for (const core::LaneMarker& marker : markers.next_right) {
    message.next_right_lane_marker.push_back(to_message(marker));
  }
  core::Duration due = vehicle_.time() + vehicle_.marker_latency();
  if (!late_markers_.empty()) due = std::max(due, late_markers_.back().due);  // none overtakes another
  late_markers_.push_back({due, message});
}

/// Those that are due by `until`, each at its time.
void VehicleSimulator::publish_lane_markers(core::Duration until) {
  for (; !late_markers_.empty() && late_markers_.front().due <= until; late_markers_.pop_front()) {
    wait_until(late_markers_.front().due);
    lane_markers_publisher_.publish(late_markers_.front().message);
  }
}

}  // namespace relative_map

int main(int argc, char** argv) {
  if (argc == 2 && (std::string(argv[1]) == "--help" || std::string(argv[1]) == "-h")) {
    std::fputs(relative_map::kUsage, stdout);
    return 0;
  }
  ros::init(argc, argv, "vehicle_simulator");
  ros::NodeHandle nh, private_nh("~");
  try {
    relative_map::VehicleSimulator(nh, relative_map::read_simulator_parameters(private_nh)).run();
  } catch (const std::exception& fault) {
    ROS_FATAL("%s", fault.what());
    return 1;
  }
  return 0;
}
