// What a vehicle's sensors really send: good, bad and missing.
#include "relative_map/localization/localizer.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "support.hpp"

namespace relative_map::core {
namespace {

using testing::HasSubstr;

LocalizerParam local_param(Method method = Method::kInertial) {
  LocalizerParam param;
  param.method = method;
  param.reference = {Projection::kLocal, 0, true, 48.0, 11.0, 500.0};
  return param;
}

/// Feeds a drive, with what `change` makes of each event's readings.
struct Feed {
  explicit Feed(const LocalizerParam& param) : localizer(param) {}

  void add(const Event& event) {
    if (const auto* imu = std::get_if<ImuSample>(&event.data)) {
      if (with_imu) localizer.add_imu(event.stamp, *imu);
    } else if (const auto* fix = std::get_if<PositionFix>(&event.data)) {
      localizer.add_fix(event.stamp, {fix->place, fix->covariance, true, 2});
    } else if (const auto* velocity = std::get_if<VelocityFix>(&event.data)) {
      localizer.add_fix_velocity(event.stamp, velocity->velocity, 0.05);
    }
    take();
  }
  void take() {
    for (PoseEstimate& estimate : localizer.take_estimates()) estimates.push_back(std::move(estimate));
    for (std::string& remark : localizer.take_remarks()) remarks.push_back(std::move(remark));
  }
  bool said(const std::string& part) const {
    return std::any_of(remarks.begin(), remarks.end(),
                       [&part](const std::string& remark) { return remark.find(part) != std::string::npos; });
  }

  Localizer localizer;
  bool with_imu = true;
  std::vector<PoseEstimate> estimates;
  std::vector<std::string> remarks;
};

double error_of(const PoseEstimate& estimate, KnownDrive& drive) {
  return (estimate.position - drive.position_at(seconds_since_epoch(estimate.stamp))).head<2>().norm();
}

/// A status of OK is never a wrong pose.
void expect_honest(const std::vector<PoseEstimate>& estimates) {
  KnownDrive drive;
  for (const PoseEstimate& estimate : estimates) {
    if (estimate.code != EstimateCode::kOk) continue;
    EXPECT_LT(error_of(estimate, drive), 0.6) << seconds_since_epoch(estimate.stamp);
  }
}

TEST(Localizer, InertialPosesAreInOrderAndRight) {
  Feed feed(local_param());
  for (const Event& event : sense(KnownDrive(), 40.0, DriveNoise(), 1)) feed.add(event);
  ASSERT_GT(feed.estimates.size(), 2000u);
  KnownDrive drive;
  for (std::size_t i = 1; i < feed.estimates.size(); ++i) {
    EXPECT_GT(feed.estimates[i].stamp, feed.estimates[i - 1].stamp);
  }
  EXPECT_EQ(feed.estimates.back().code, EstimateCode::kOk) << feed.estimates.back().message;
  EXPECT_LT(error_of(feed.estimates.back(), drive), 0.1);
  EXPECT_TRUE(feed.remarks.empty());
  expect_honest(feed.estimates);
}

TEST(Localizer, PlanarNeedsNoInertialSensor) {
  LocalizerParam param = local_param(Method::kPlanar);
  Feed feed(param);
  feed.with_imu = false;
  KnownDrive drive;
  double next = 0.0;
  for (const Event& event : sense(KnownDrive(), 60.0, DriveNoise(), 2)) {
    const double t = seconds_since_epoch(event.stamp);
    for (; next <= t; next += 0.05) {
      feed.localizer.add_wheels(at_seconds(next),
                                {1.01 * drive.speed_at(next), drive.yaw_rate_at(next) + 0.004, true});
    }
    if (event.source == Sensor::kFix) feed.add(event);
  }
  feed.take();
  ASSERT_FALSE(feed.estimates.empty());
  const PoseEstimate& last = feed.estimates.back();
  EXPECT_LT(error_of(last, drive), 0.3);
  EXPECT_NEAR(std::remainder(last.heading - drive.heading_at(seconds_since_epoch(last.stamp)), 2.0 * M_PI),
              0.0, 0.03);
}

TEST(Localizer, PlanarTakesFixesAlone) {
  Feed feed(local_param(Method::kPlanar));
  feed.with_imu = false;
  for (const Event& event : sense(KnownDrive(), 60.0, DriveNoise(), 3)) feed.add(event);
  ASSERT_FALSE(feed.estimates.empty());
  KnownDrive drive;
  EXPECT_LT(error_of(feed.estimates.back(), drive), 0.5);
}

TEST(Localizer, RtkIsThePoseOfTheFix) {
  LocalizerParam param = local_param(Method::kRtk);
  param.inertial.antenna = {1.0, 0.2, 1.5};
  Feed feed(param);
  const TangentPlane plane({11.0, 48.0, 500.0});
  const double yaw = 0.4;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int i = 0; i < 100; ++i) {
    feed.localizer.add_imu(at_seconds(0.01 * i),
                           {{0.0, 0.0, 0.2}, {0.5, 0.0, normal_gravity(48.0 * M_PI / 180.0, 500.0)}});
  }
  feed.localizer.add_heading(at_seconds(0.505), yaw, 0.01);
  const Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity() * 1e-4;
  feed.localizer.add_fix(at_seconds(0.505),
                         {plane.to_earth(turn * param.inertial.antenna), covariance, true, 2});
  feed.localizer.add_imu(at_seconds(1.0), {});
  feed.take();
  ASSERT_EQ(feed.estimates.size(), 1u);
  const PoseEstimate& estimate = feed.estimates[0];
  EXPECT_LT(estimate.position.norm(), 1e-6);
  EXPECT_NEAR(estimate.heading, yaw, 1e-6);
  EXPECT_NEAR(estimate.rate_body.z(), 0.2, 1e-12);
  EXPECT_LT((estimate.acceleration_body - Eigen::Vector3d(0.5, 0.0, 0.0)).norm(), 1e-5);
}

TEST(Localizer, RtkSaysWhatIsMissing) {
  Feed feed(local_param(Method::kRtk));
  const TangentPlane plane({11.0, 48.0, 500.0});
  const FixReading fix{plane.to_earth({5.0, 0.0, 0.0}), Eigen::Matrix3d::Identity() * 1e-4, true, 2};
  feed.localizer.add_imu(at_seconds(0.0), {});
  feed.localizer.add_fix(at_seconds(0.1), fix);
  feed.localizer.add_imu(at_seconds(0.3), {});  // 0.3 s apart: nothing is interpolated
  feed.take();
  ASSERT_EQ(feed.estimates.size(), 1u);
  EXPECT_EQ(feed.estimates[0].code, EstimateCode::kError);
  EXPECT_TRUE(std::isnan(feed.estimates[0].heading));
  EXPECT_TRUE(std::isnan(feed.estimates[0].rate_body.z()));
  EXPECT_THAT(feed.estimates[0].message, HasSubstr("heading"));
  EXPECT_THAT(feed.estimates[0].message, HasSubstr("apart"));
  feed.localizer.add_fix(at_seconds(0.05), fix);  // an older one
  feed.localizer.add_fix(at_seconds(0.1), fix);   // the same
  feed.localizer.add_imu(at_seconds(0.4), {});
  feed.take();
  EXPECT_EQ(feed.estimates.size(), 1u);
}

TEST(Localizer, BadMessagesCostASentence) {
  Feed feed(local_param());
  std::vector<Event> events = sense(KnownDrive(), 50.0, DriveNoise(), 4);
  Feed clean(local_param());
  for (const Event& event : events) clean.add(event);
  int i = 0;
  for (const Event& event : events) {
    feed.add(event);
    if (++i % 500 != 0) continue;
    const Time stamp = event.stamp;
    feed.localizer.add_imu(stamp + Duration(1), {{NAN, 0.0, 0.0}, {0.0, 0.0, 9.8}});
    feed.localizer.add_imu(stamp + Duration(2), {{0.0, 0.0, 90.0}, {0.0, 0.0, 9.8}});
    feed.localizer.add_fix(stamp + Duration(3), {{NAN, 48.0, 500.0}, Eigen::Matrix3d::Identity(), true, 2});
    feed.localizer.add_fix(stamp + Duration(4),
                           {{11.0, 48.0, 500.0}, Eigen::Matrix3d::Identity() * 1e-4, true, -1});
    feed.localizer.add_fix(stamp + Duration(5),
                           {{11.0, -48.0, 500.0}, Eigen::Matrix3d::Identity() * 1e-4, true, 2});
    feed.localizer.add_fix(stamp + Duration(6),
                           {{0.0, 0.0, 0.0}, Eigen::Matrix3d::Identity() * 1e-4, true, 2});
    feed.localizer.add_fix(stamp - from_seconds(30.0),
                           {{11.0, 48.0, 500.0}, Eigen::Matrix3d::Identity(), true, 2});
    feed.localizer.add_fix(stamp + from_seconds(3600.0),
                           {{11.0, 48.0, 500.0}, Eigen::Matrix3d::Identity(), true, 2});
    feed.localizer.add_wheels(stamp, {NAN, kNotGiven, true});
    feed.localizer.add_wheels(stamp, {500.0, kNotGiven, true});
    feed.localizer.add_fix_velocity(stamp + Duration(7), {NAN, 0.0, 0.0}, 0.1);
    feed.localizer.add_heading(stamp, NAN, 0.1);
    feed.localizer.add_map_pose(stamp, MapPoseReading());
  }
  feed.take();
  for (const char* part : {"not finite", "in degrees", "no fix", "200 km", "both 0", "stamp lies far", "km/h",
                           "covariance is not given"}) {
    EXPECT_TRUE(feed.said(part)) << part;
  }
  ASSERT_EQ(feed.estimates.size(), clean.estimates.size());
  EXPECT_EQ(feed.estimates.back().position, clean.estimates.back().position);
}

TEST(Localizer, UnknownCovarianceIsNotOk) {
  Feed feed(local_param());
  for (const Event& event : sense(KnownDrive(), 40.0, DriveNoise(), 5)) {
    if (const auto* fix = std::get_if<PositionFix>(&event.data)) {
      feed.localizer.add_fix(event.stamp, {fix->place, Eigen::Matrix3d::Zero(), false, 0});
      feed.take();
    } else {
      feed.add(event);
    }
  }
  EXPECT_TRUE(feed.said("covariance is unknown"));
  ASSERT_FALSE(feed.estimates.empty());
  EXPECT_EQ(feed.estimates.back().code, EstimateCode::kError);
  EXPECT_GT(feed.estimates.back().horizontal_stddev(), 1.0);
}

TEST(Localizer, ARecordingThatStartsAgainIsFollowed) {
  Feed feed(local_param());
  const std::vector<Event> events = sense(KnownDrive(), 30.0, DriveNoise(), 6);
  for (const Event& event : events) feed.add(event);
  for (const Event& event : events) feed.add(event);
  EXPECT_TRUE(feed.said("jumped for good"));
  EXPECT_EQ(feed.estimates.back().code, EstimateCode::kOk) << feed.estimates.back().message;
  KnownDrive drive;
  EXPECT_LT(error_of(feed.estimates.back(), drive), 0.2);
}

TEST(Localizer, AStuckWheelSpeedIsNotBelieved) {
  Feed feed(local_param());
  KnownDrive drive;
  drive.stand = 5.0;
  double next = 0.0;
  for (const Event& event : sense(drive, 60.0, DriveNoise(), 7)) {
    const double t = seconds_since_epoch(event.stamp);
    // It sticks at what it was at 10 s, halfway up to its speed; no fixes from 30 s on.
    for (; next <= t; next += 0.02)
      feed.localizer.add_wheels(at_seconds(next), {drive.speed_at(std::min(next, 10.0)), kNotGiven, true});
    if (event.source == Sensor::kImu || t < 30.0) feed.add(event);
  }
  feed.take();
  KnownDrive truth;
  const PoseEstimate& last = feed.estimates.back();
  EXPECT_LT(error_of(last, truth),
            3.0 * std::hypot(last.horizontal_stddev(), last.horizontal_stddev()) + 0.5);
  expect_honest(feed.estimates);
}

TEST(Localizer, ASilentInertialSensorIsNotOk) {
  Feed feed(local_param());
  for (const Event& event : sense(KnownDrive(), 60.0, DriveNoise(), 8)) {
    if (event.source == Sensor::kImu && event.stamp > at_seconds(40.0)) continue;
    feed.add(event);
  }
  EXPECT_NE(feed.estimates.back().code, EstimateCode::kOk);
  expect_honest(feed.estimates);
}

TEST(Localizer, HeadingIsTurnedIntoTheGrid) {
  LocalizerParam param = local_param();
  param.reference = GeoReference();
  param.reference.projection = Projection::kUtm;
  param.reference.zone = 32;
  Feed utm(param), local(local_param());
  for (const Event& event : sense(KnownDrive(), 30.0, DriveNoise(), 9)) {
    utm.add(event);
    local.add(event);
  }
  const MapProjection map(param.reference);
  const Eigen::Matrix3d turn = map.to_map({11.0, 48.0, 500.0}).map_from_local;
  const double convergence = std::atan2(turn(1, 0), turn(0, 0));
  EXPECT_GT(convergence, 0.02);  // two degrees east of the middle of the zone
  EXPECT_NEAR(utm.estimates.back().heading - local.estimates.back().heading, convergence, 1e-4);
}

}  // namespace
}  // namespace relative_map::core
