#include <map>

#include "engine.hpp"
#include "property/ugly_drive.hpp"
#include "relative_map/ros/messages/message_check.hpp"

// No messages, however ugly, get a map out that breaks the contract, nor one that the check had to replace.
namespace relative_map {
namespace {

using core::test::Random;
using core::test::UglyDrive;
using core::test::UglyInputs;

constexpr std::uint64_t kDrives = 5000;
constexpr int kSteps = 12;

LaneMarker message_of(const core::LaneMarker& marker) {
  LaneMarker message;
  message.lane_type = static_cast<uint8_t>(marker.type);
  message.quality = marker.quality;
  message.c0_position = marker.cubic.c0;
  message.c1_heading_angle = marker.cubic.c1;
  message.c2_curvature = marker.cubic.c2;
  message.c3_curvature_derivative = marker.cubic.c3;
  message.longitude_start = marker.longitude_start;
  message.view_range = marker.view_range;
  return message;
}

/// The inputs of an ugly drive as messages, with frames, links and gears that are at times as ugly.
class UglyMessages {
 public:
  explicit UglyMessages(std::uint64_t seed) : drive_(seed), random_(seed + 1000000) {
    NodeConfig config;
    if (random_.chance(0.2)) config.orientation_convention = OrientationConvention::kRfu;
    engine_ = std::make_unique<test::Engine>(config);
    engine_->mount("base_link", "imu_link", Eigen::Isometry3d(Eigen::Translation3d(0.4, 0.1, 0.5)));
    engine_->mount("base_link", "camera", Eigen::Isometry3d(Eigen::Translation3d(1.9, 0.0, 1.2)));
  }

  MapMsgPtr step() {
    const UglyInputs inputs = drive_.next();
    if (inputs.config) (*engine_)->set_config(*inputs.config);
    if (inputs.lines) engine_->set_lines(to_message(core::NavigationInfo{frame(), *inputs.lines}));
    if (random_.chance(0.01)) (*engine_)->reset();
    const ros::Time now = to_ros(drive_.now());
    if (inputs.localization) (*engine_)->on_localization(test::shared(message_of(*inputs.localization)), now);
    if (inputs.chassis) (*engine_)->on_chassis(test::shared(message_of(*inputs.chassis)), now);
    if (inputs.markers) (*engine_)->on_lane_markers(test::shared(message_of(*inputs.markers)), now);
    return (*engine_)->tick(now);
  }

 private:
  std::string frame() { return random_.chance(0.95) ? "map" : random_.chance(0.5) ? "/map" : "odom"; }
  ros::Time stamp(core::Time time) { return random_.chance(0.05) ? ros::Time() : to_ros(time); }

  LocalizationEstimate message_of(const core::Localization& input) {
    LocalizationEstimate message;
    message.header.stamp = stamp(input.stamp);
    message.header.frame_id = frame();
    const char* const links[] = {"", "base_link", "/base_link", "imu_link", "no_such_link"};
    message.child_frame_id = links[random_.integer(0, random_.chance(0.1) ? 4 : 3)];
    test::set_xyz(message.pose.position, input.position);
    message.pose.heading = random_.chance(0.2) ? test::kNaN : input.heading;
    message.pose.orientation = test::quaternion(input.map_from_body);
    test::set_xyz(message.pose.linear_velocity, input.linear_velocity);
    test::set_xyz(message.pose.angular_velocity_vrf, input.angular_velocity_body);
    return message;
  }

  Chassis message_of(const core::Chassis& input) {
    Chassis message;
    message.header.stamp = stamp(input.stamp);
    message.speed_mps = input.speed;
    message.gear_location = static_cast<uint8_t>(random_.integer(0, 8));
    return message;
  }

  LaneMarkers message_of(const core::LaneMarkers& input) {
    LaneMarkers message;
    message.header.stamp = stamp(input.stamp);
    message.header.frame_id = random_.chance(0.5) ? "base_link" : random_.chance(0.9) ? "camera" : "lens";
    message.left_lane_marker = relative_map::message_of(input.left);
    message.right_lane_marker = relative_map::message_of(input.right);
    if (random_.chance(0.3)) message.next_left_lane_marker.push_back(message.left_lane_marker);
    if (random_.chance(0.3)) message.next_right_lane_marker.push_back(message.right_lane_marker);
    return message;
  }

  UglyDrive drive_;
  Random random_;
  std::unique_ptr<test::Engine> engine_;
};

TEST(UglyMessages, NeverMakeAMapThatBreaksTheContract) {
  std::map<int, int> statuses;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    UglyMessages messages(seed);
    core::MapContext context{"base_link", std::nullopt};
    for (int step = 0; step < kSteps; ++step) {
      const MapMsgPtr map = messages.step();
      if (!map) continue;  // the same pose as before
      for (const core::Violation& violation : check_message(*map, context)) {
        ADD_FAILURE() << "seed " << seed << ", step " << step << ": " << violation.row << ": "
                      << violation.what;
      }
      EXPECT_NE(map->status.code, MapStatus::CONTRACT_VIOLATION)
          << "seed " << seed << ", step " << step << ": " << map->status.message;
      context.previous_sequence_num = map->sequence_num;
      ++statuses[map->status.code];
    }
    ASSERT_FALSE(HasFailure()) << "the first one is enough";
  }
  // They have been everywhere.
  EXPECT_GT(statuses[MapStatus::OK], 2000);
  for (const int code : {MapStatus::NO_LOCALIZATION, MapStatus::STALE_LOCALIZATION,
                         MapStatus::INVALID_LOCALIZATION, MapStatus::NO_NAVIGATION_LINE, MapStatus::OFF_ROUTE,
                         MapStatus::LINE_END, MapStatus::FRAME_MISMATCH, MapStatus::NO_TRANSFORM}) {
    EXPECT_GT(statuses[code], 20) << "status " << code;
  }
}

}  // namespace
}  // namespace relative_map
