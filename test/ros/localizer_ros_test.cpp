// The localizer's parameters, and what its messages say.
#include <gmock/gmock.h>

#include <cmath>

#include "relative_map/ros/localizer/localizer_engine.hpp"

namespace relative_map {
namespace {

using testing::HasSubstr;

std::string refusal_of(const ParameterSet& parameters) {
  try {
    make_localizer_config(parameters);
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "";
}

TEST(LocalizerParameters, TheFileHasTheDefaults) {
  const ParameterSet file = read_yaml(RELATIVE_MAP_SOURCE_DIR "/config/localization.yaml");
  const LocalizerNodeConfig of_file = make_localizer_config(file), of_none = make_localizer_config({});
  EXPECT_EQ(of_file.localizer.method, of_none.localizer.method);
  EXPECT_EQ(of_file.localizer.rate, of_none.localizer.rate);
  EXPECT_EQ(of_file.max_age_fix, of_none.max_age_fix);
  const auto numbers = [](const core::LocalizerParam& param) {
    const core::InertialParam& i = param.inertial;
    return std::vector<double>{i.noise.gyro_noise,
                               i.noise.accel_noise,
                               i.noise.gyro_bias_walk,
                               i.noise.accel_bias_walk,
                               i.gate_probability,
                               i.nhc_lateral,
                               i.nhc_vertical,
                               i.nhc_yaw_rate,
                               i.nhc_min_speed,
                               i.zero_velocity_stddev,
                               i.zero_rate_stddev,
                               i.still_rate,
                               i.still_force,
                               i.wheel_speed_stddev,
                               i.wheel_scale_stddev,
                               i.mount_stddev,
                               i.stamp_offset_stddev,
                               i.course_speed,
                               i.tilt_stddev,
                               i.yaw_stddev,
                               i.gyro_bias_stddev,
                               i.accel_bias_stddev,
                               i.ok_stddev,
                               i.warning_stddev,
                               i.max_yaw_stddev,
                               param.planar.acceleration,
                               param.planar.yaw_acceleration,
                               param.planar.yaw_rate_stddev,
                               param.planar.yaw_rate_bias,
                               param.planar.slip,
                               param.rtk.max_wait,
                               param.rtk.max_bracket,
                               param.rtk.course_speed,
                               param.rtk.ok_stddev,
                               param.rtk.warning_stddev,
                               param.assumed.fix,
                               param.assumed.fix_velocity,
                               param.assumed.heading};
  };
  EXPECT_EQ(numbers(of_file.localizer), numbers(of_none.localizer));
}

TEST(LocalizerParameters, EveryFaultIsNamed) {
  const std::string text = refusal_of({{"method", std::string("guess")},
                                       {"projection", std::string("61N")},
                                       {"imu_grade", std::string("gold")},
                                       {"rate", 0.0},
                                       {"rolling/lateral", -1.0},
                                       {"stamp_offset/imu", 5.0},
                                       {"nhc", 3},
                                       {"no_such_key", 1.0}});
  for (const char* part : {"guess", "61N", "gold", "rate", "rolling/lateral", "stamp_offset",
                           "nhc must be true or false", "no_such_key"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(LocalizerParameters, ProjectionIsAZoneOrAnOrigin) {
  const auto reference = [](const std::string& text) {
    return make_localizer_config({{"projection", text}}).localizer.reference;
  };
  EXPECT_EQ(reference("33S").zone, 33);
  EXPECT_FALSE(reference("33S").north);
  EXPECT_EQ(reference("48.1, 11.5").longitude, 11.5);
  EXPECT_EQ(reference("48.1,11.5,520").altitude, 520.0);
  EXPECT_THAT(refusal_of({{"projection", std::string("48.1, 11.5, 520, 7")}}), HasSubstr("origin"));
  EXPECT_THAT(refusal_of({{"projection", std::string("148.1, 11.5")}}), HasSubstr("origin"));
}

TEST(LocalizerMessages, WhatIsNotKnownIsNaN) {
  core::PoseEstimate estimate;
  estimate.position = {1.0, 2.0, 3.0};
  estimate.message = "aligning";
  const LocalizationEstimate message = to_message(estimate, LocalizerNodeConfig());
  EXPECT_EQ(message.pose.position.y, 2.0);
  EXPECT_TRUE(std::isnan(message.pose.heading));
  EXPECT_TRUE(std::isnan(message.pose.orientation.w));
  EXPECT_EQ(message.status.code, LocalizationStatus::ERROR);
  EXPECT_FALSE(to_odometry(estimate, LocalizerNodeConfig()).has_value());
}

TEST(LocalizerEngine, TurnsTheSensorIntoTheBody) {
  // The inertial sensor lies on its side; gravity is on its y.
  LocalizerNodeConfig config;
  config.localizer.reference = {core::Projection::kLocal, 0, true, 48.0, 11.0, 0.0};
  const LinkTransforms transforms = [](const std::string&, const std::string& source, const ros::Time&) {
    Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
    if (source == "imu")
      transform.linear() = Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitX()).toRotationMatrix();
    return std::optional<Eigen::Isometry3d>(transform);
  };
  LocalizerEngine engine(config, transforms, 0.0);
  for (int i = 0; i < 1000; ++i) {
    const ros::Time now(1000.0 + 0.01 * i);
    sensor_msgs::Imu imu;
    imu.header.frame_id = "imu";
    imu.header.stamp = now;
    imu.linear_acceleration.y = 9.81;
    engine.on_imu(imu, now);
    if (i % 20 != 0) continue;
    sensor_msgs::NavSatFix fix;
    fix.header = imu.header;
    fix.header.frame_id = "gps";
    fix.latitude = 48.0;
    fix.longitude = 11.0;
    fix.altitude = 10.0;
    fix.status.status = 2;
    fix.position_covariance = {1e-4, 0, 0, 0, 1e-4, 0, 0, 0, 1e-4};
    fix.position_covariance_type = 2;
    engine.on_fix(fix, now);
    sensor_msgs::Imu heading;
    heading.header = fix.header;
    heading.orientation.w = 1.0;
    heading.orientation_covariance[8] = 1e-4;
    if (i > 300) engine.on_heading(heading, now);
  }
  const auto estimates = engine.take_estimates();
  ASSERT_FALSE(estimates.empty());
  const core::PoseEstimate& last = estimates.back();
  EXPECT_EQ(last.code, core::EstimateCode::kOk) << last.message;
  EXPECT_NEAR(last.heading, 0.0, 0.05);
  EXPECT_GT((last.map_from_body * Eigen::Vector3d::UnitZ()).z(), 0.999);
  EXPECT_LT(last.acceleration_body.norm(), 0.1);
  EXPECT_TRUE(engine.take_remarks().empty());
}

TEST(LocalizerEngine, SaysWhatItDoesNotKnowOfFrames) {
  const LinkTransforms none = [](const std::string&, const std::string&, const ros::Time&) {
    return std::optional<Eigen::Isometry3d>();
  };
  LocalizerEngine engine(LocalizerNodeConfig(), none, 0.0);
  sensor_msgs::Imu imu;
  imu.header.frame_id = "somewhere";
  engine.on_imu(imu, ros::Time(1.0));
  EXPECT_THAT(engine.take_remarks(), testing::Contains(HasSubstr("'somewhere'")));
  engine.on_imu(imu, ros::Time(1.01));
  EXPECT_THAT(engine.take_remarks(), testing::IsEmpty());
  sensor_msgs::Imu heading;
  engine.on_heading(heading, ros::Time(1.0));
  EXPECT_THAT(engine.take_remarks(), testing::Contains(HasSubstr("no orientation")));
}

}  // namespace
}  // namespace relative_map
