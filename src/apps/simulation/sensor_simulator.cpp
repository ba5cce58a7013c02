// The sensors that a localizer lives on, for a simulated vehicle whose true pose is published.
#include "relative_map/simulation/sensors/sensor_suite.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

#include "sensor_messages.hpp"
#include "sensor_simulator_parameters.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    R"(Usage: rosrun relative_map sensor_simulator [truth:=TOPIC] [_PARAMETER:=VALUE]...

What the sensors of a vehicle say that drives along `truth` (PoseStamped in the map, as vehicle_simulator publishes it; a
sample of the inertial sensor for each): imu, fix, fix_velocity, wheel_odometry, for `localizer_node`. The ground has hills
and cambers; sensors have noise, biases, scales and delays; satellites are lost in tunnels. All of it as private parameters:
see config/simulator_sensors.yaml. A parameter that is unknown or impossible keeps it from starting. Exit codes: 0 done,
1 not started.
)";

class SensorSimulator {
 public:
  SensorSimulator(ros::NodeHandle nh, const SensorSimulatorConfig& config)
      : config_(config), suite_(config.sensors, config.seed) {
    imu_publisher_ = nh.advertise<sensor_msgs::Imu>("imu", 200);
    fix_publisher_ = nh.advertise<sensor_msgs::NavSatFix>("fix", 50);
    velocity_publisher_ = nh.advertise<geometry_msgs::TwistStamped>("fix_velocity", 50);
    wheels_publisher_ = nh.advertise<geometry_msgs::TwistStamped>("wheel_odometry", 100);
    subscriber_ =
        nh.subscribe("truth", 1000, &SensorSimulator::on_truth, this, ros::TransportHints().tcpNoDelay());
  }

 private:
  void on_truth(const geometry_msgs::PoseStamped& truth) {
    // Seconds since the first pose: stamps since 1970 leave too few digits for accelerations.
    if (!start_) start_ = truth.header.stamp;
    const double now = (truth.header.stamp - *start_).toSec();
    const auto& q = truth.pose.orientation;
    const double heading = std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
    suite_.drive(now, core::Pose2({truth.pose.position.x, truth.pose.position.y}, heading));
    tell_of_tunnels(now);
    for (const core::SimulatedReading& reading : suite_.take(now)) publish(reading);
  }

  void publish(const core::SimulatedReading& reading) {
    const ros::Time stamp = *start_ + ros::Duration(reading.stamp);
    if (const auto* imu = std::get_if<core::SimulatedImu>(&reading.data)) {
      publish(imu_publisher_, to_message(*imu), stamp);
    } else if (const auto* fix = std::get_if<core::SimulatedFix>(&reading.data)) {
      publish(fix_publisher_, to_message(*fix), stamp);
    } else if (const auto* velocity = std::get_if<core::SimulatedVelocity>(&reading.data)) {
      publish(velocity_publisher_, to_message(*velocity), stamp);
    } else {
      const auto& wheels = std::get<core::SimulatedWheels>(reading.data);
      publish(wheels_publisher_, to_message(wheels, config_.base_frame), stamp);
    }
  }
  template <class Message>
  static void publish(ros::Publisher& publisher, Message message, const ros::Time& stamp) {
    message.header.stamp = stamp;
    publisher.publish(message);
  }

  void tell_of_tunnels(double now) {
    const bool tunnel = suite_.quality_at(now) == core::FixQuality::kNone;
    if (tunnel != in_tunnel_) ROS_INFO("%s", tunnel ? "Into a tunnel: no satellites" : "Out of the tunnel");
    in_tunnel_ = tunnel;
  }

  SensorSimulatorConfig config_;
  core::SensorSuite suite_;
  std::optional<ros::Time> start_;
  bool in_tunnel_ = false;
  ros::Publisher imu_publisher_, fix_publisher_, velocity_publisher_, wheels_publisher_;
  ros::Subscriber subscriber_;
};

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  if (argc == 2 && (std::string(argv[1]) == "--help" || std::string(argv[1]) == "-h")) {
    std::fputs(relative_map::kUsage, stdout);
    return 0;
  }
  ros::init(argc, argv, "sensor_simulator");
  ros::NodeHandle nh, private_nh("~");
  try {
    const relative_map::SensorSimulator simulator(
        nh, relative_map::make_sensor_simulator_config(relative_map::parameters_of(private_nh)));
    ros::spin();
  } catch (const std::exception& fault) {
    ROS_FATAL("the sensor simulator cannot start: %s", fault.what());
    return 1;
  }
  return 0;
}
