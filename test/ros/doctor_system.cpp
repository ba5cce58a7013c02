#include "doctor_system.hpp"

#include <cmath>

namespace relative_map::doctor::test {

namespace {

using core::Point2;
using core::Pose2;

constexpr double kSpeed = 10.0;   // [m/s]
constexpr double kKappa = 0.01;   // [1/m]
constexpr double kSeconds = 5.0;  // of listening
constexpr double kLever = 1.0;    // [m] of imu_link ahead of base_link
const ros::Time kBegin(1700000000, 0);
const Pose2 kLineStart(Point2(448000.0, 4425000.0), 0.6);

/// base_link, so many seconds after the doctor began to listen.
Pose2 vehicle(double seconds) {
  return core::test::along_arc(kLineStart, kKappa, 100.0 + kSpeed * seconds);
}

/// One that is sent each `period` [s] and takes 10 ms to come.
template <class Message, class Make>
void fill(Input<Message>& input, double period, Make make) {
  for (int i = 1; i <= std::lround(kSeconds / period); ++i) {
    const double t = i * period;
    Message message = make(t);
    message.header.stamp = kBegin + ros::Duration(t - 0.01);
    input.messages.push_back({kBegin + ros::Duration(t), relative_map::test::shared(message)});
  }
}

LocalizationEstimate localization(double seconds) {
  const Pose2 base = vehicle(seconds);
  LocalizationEstimate message =
      relative_map::test::localization(base.to_parent(Pose2(Point2(kLever, 0.0), 0.0)), ros::Time());
  const double yaw_rate = kSpeed * kKappa;
  const Point2 velocity = base.rotate_to_parent(Point2(kSpeed, yaw_rate * kLever));
  relative_map::test::set_xyz(message.pose.linear_velocity, {velocity.x(), velocity.y(), 0.0});
  message.pose.angular_velocity_vrf.z = yaw_rate;
  message.child_frame_id = "imu_link";
  return message;
}

NavigationInfo navigation() {
  NavigationInfo info;
  info.header.frame_id = "map";
  info.navigation_path = {
      relative_map::test::navigation_path(core::test::arc(kLineStart, kKappa, 400.0, 1.0), "bend", 0)};
  return info;
}

Topic topic(const std::string& name, const std::string& type, const std::string& publisher) {
  Topic result;
  result.name = name;
  result.type = "relative_map/" + type;
  result.publishers = {{publisher, "http://127.0.0.1:4000/", result.type, true, ""}};
  result.subscribers = {"/relative_map_manager"};
  return result;
}

}  // namespace

Places healthy_places() {
  Places places;
  places["imu_link"] = Eigen::Isometry3d(Eigen::Translation3d(kLever, 0.0, 0.5));
  places["camera_link"] = Eigen::Isometry3d(Eigen::Translation3d(1.8, 0.0, 1.3));
  return places;
}

Observations healthy_system() {
  Observations seen;
  seen.node_has_parameters = true;
  seen.listened = kSeconds;
  seen.begin = kBegin;
  seen.end = kBegin + ros::Duration(kSeconds);
  seen.navigation.topic = topic("/navigation", "NavigationInfo", "/recorder");
  seen.localization.topic = topic("/localization", "LocalizationEstimate", "/ins");
  seen.chassis.topic = topic("/chassis", "Chassis", "/can");
  seen.lane_markers.topic = topic("/perception/lane_markers", "LaneMarkers", "/camera");
  seen.map_topic = topic("/relative_map", "MapMsg", "/relative_map_manager");

  seen.navigation.messages.push_back({kBegin, relative_map::test::shared(navigation())});
  fill(seen.localization, 0.05, localization);
  fill(seen.chassis, 0.05, [](double) {
    Chassis chassis;
    chassis.speed_mps = kSpeed;
    chassis.gear_location = Chassis::GEAR_DRIVE;
    return chassis;
  });
  fill(seen.lane_markers, 0.1,
       [](double) { return relative_map::test::lane_markers(ros::Time(), 0.0, "camera_link"); });
  for (int i = 1; i <= 50; ++i) seen.maps.push_back({kBegin + ros::Duration(0.1 * i), {}, {}});

  seen.transforms = transforms_of(healthy_places());
  return seen;
}

void stop(Observations& seen) {
  const Pose first = seen.localization.messages[0].message->pose;
  change(seen.localization, [&](LocalizationEstimate& message) {
    message.pose = first;
    message.pose.linear_velocity = message.pose.angular_velocity_vrf = geometry_msgs::Vector3();
  });
  change(seen.chassis, [](Chassis& chassis) { chassis.speed_mps = 0.0; });
}

}  // namespace relative_map::doctor::test
