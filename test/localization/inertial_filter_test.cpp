// The inertial filter on drives that are known in closed form.
#include <gmock/gmock.h>

#include <algorithm>

#include "relative_map/localization/event_history.hpp"
#include "relative_map/localization/inertial_filter/inertial_estimate.hpp"
#include "support.hpp"

namespace relative_map::core {
namespace {

using History = EventHistory<InertialFilter>;

struct FilterRun {
  explicit FilterRun(const InertialParam& param = InertialParam())
      : history(InertialFilter(param), InertialState(), from_seconds(2.0), from_seconds(0.2)) {}
  void feed(const std::vector<Event>& events) {
    for (const Event& event : events) history.add(event);
  }
  PoseEstimate estimate() const {
    return make_estimate(history.state(), InertialParam(),
                         MapProjection({Projection::kLocal, 0, true, 48.0, 11.0, 500.0}));
  }
  /// [m] of the estimate, at its own time.
  double error(KnownDrive drive) const {
    const PoseEstimate found = estimate();
    return (found.position - drive.position_at(seconds_since_epoch(found.stamp))).head<2>().norm();
  }
  History history;
};

double t_of(const InertialState& state) {
  return seconds_since_epoch(state.time);
}

TEST(InertialFilter, AlignsAndFollows) {
  KnownDrive drive;
  FilterRun run;
  run.feed(sense(drive, 60.0, DriveNoise(), 1));
  const InertialState& state = run.history.state();
  ASSERT_EQ(state.mode, FilterMode::kRunning);
  EXPECT_LT(run.error(drive), 0.05);
  EXPECT_LT(std::abs(std::remainder(state.nav.yaw() - drive.heading_at(t_of(state)), 2.0 * M_PI)), 0.01);
  EXPECT_LT((state.nav.gyro_bias - DriveNoise().gyro_bias).norm(), 0.002);
  EXPECT_EQ(state.of(Sensor::kFix).refused, 0u);
}

TEST(InertialFilter, IsTheSameWhateverTheOrderOfArrival) {
  const std::vector<Event> events = sense(KnownDrive(), 30.0, DriveNoise(), 2);
  FilterRun in_order;
  in_order.feed(events);
  for (const unsigned seed : {1u, 2u, 3u}) {
    // Each event comes up to 0.9 s after its stamp.
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> delay(0.0, 0.9);
    std::vector<std::pair<double, Event>> arrivals;
    for (const Event& event : events)
      arrivals.emplace_back(seconds_since_epoch(event.stamp) + delay(random), event);
    std::sort(arrivals.begin(), arrivals.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    FilterRun shuffled;
    for (const auto& [unused, event] : arrivals) EXPECT_EQ(shuffled.history.add(event), Taken::kTaken);
    const InertialState &a = in_order.history.state(), &b = shuffled.history.state();
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.nav.position, b.nav.position);
    EXPECT_EQ(a.nav.attitude, b.nav.attitude);
    EXPECT_EQ(a.nav.gyro_bias, b.nav.gyro_bias);
    EXPECT_EQ(a.error.covariance(), b.error.covariance());
    EXPECT_EQ(a.of(Sensor::kFix).nis, b.of(Sensor::kFix).nis);
  }
}

TEST(InertialFilter, TakesEachMeasurementOnceAndNoneThatIsTooOld) {
  const std::vector<Event> events = sense(KnownDrive(), 10.0, DriveNoise(), 2);
  FilterRun run;
  run.feed(events);
  EXPECT_EQ(run.history.add(events.back()), Taken::kTwice);
  EXPECT_EQ(run.history.add(events.front()), Taken::kTooOld);
}

TEST(InertialFilter, SaysHowMuchItKnows) {
  // Normalized squared error of the place: two degrees of freedom, over drives of their own.
  double sum = 0.0;
  const int drives = 20;
  for (int i = 0; i < drives; ++i) {
    KnownDrive drive;
    DriveNoise noise;
    noise.fix = 0.3;
    noise.gyro = 2e-3;
    noise.accel = 5e-2;
    FilterRun run;
    run.feed(sense(drive, 40.3, noise, 100 + i));
    const InertialState& state = run.history.state();
    ASSERT_EQ(state.mode, FilterMode::kRunning);
    const Eigen::Vector3d found =
        TangentPlane(drive.origin).to_plane(state.plane.to_earth(state.nav.position));
    const Eigen::Vector2d error = (found - drive.position_at(t_of(state))).head<2>();
    const Eigen::Matrix2d p = state.error.covariance().topLeftCorner<2, 2>();
    sum += error.dot(p.inverse() * error) / 2.0;
  }
  EXPECT_GT(sum / drives, 0.3);
  EXPECT_LT(sum / drives, 1.8);
}

TEST(InertialFilter, KeepsToTheRoadWithoutFixes) {
  KnownDrive drive;
  std::vector<Event> events = sense(drive, 90.0, DriveNoise(), 4);
  const auto lost = [](const Event& event) {
    return event.source != Sensor::kImu && event.stamp > at_seconds(70.0);
  };
  events.erase(std::remove_if(events.begin(), events.end(), lost), events.end());
  FilterRun run;
  run.feed(events);
  const InertialState& state = run.history.state();
  const double error = run.error(drive);
  const double stddev = std::sqrt(state.error.covariance().topLeftCorner<2, 2>().trace());
  EXPECT_LT(error, 5.0);
  EXPECT_LT(error, 3.0 * stddev);
  const MapProjection map({Projection::kLocal, 0, true, 48.0, 11.0, 500.0});
  const PoseEstimate estimate = make_estimate(state, InertialParam(), map);
  EXPECT_NE(estimate.code, EstimateCode::kOk);
  EXPECT_THAT(estimate.message, testing::HasSubstr("last fix used 20."));
}

TEST(InertialFilter, IsNotLockedOutByAJump) {
  // All fixes are 30 m to the north from one time on: after a while they are believed, but never with a small
  // sigma while that is in doubt.
  KnownDrive drive;
  std::vector<Event> events = sense(drive, 90.0, DriveNoise(), 5);
  const TangentPlane plane(drive.origin);
  for (Event& event : events) {
    if (event.source != Sensor::kFix || event.stamp < at_seconds(50.0)) continue;
    PositionFix& fix = std::get<PositionFix>(event.data);
    fix.place = plane.to_earth(plane.to_plane(fix.place) + Eigen::Vector3d(0.0, 30.0, 0.0));
  }
  FilterRun run;
  const MapProjection map({Projection::kLocal, 0, true, 48.0, 11.0, 500.0});
  for (const Event& event : events) {
    run.history.add(event);
    const InertialState& state = run.history.state();
    const PoseEstimate estimate = make_estimate(state, InertialParam(), map);
    if (state.time > at_seconds(50.0) && estimate.code == EstimateCode::kOk &&
        event.stamp < at_seconds(60.0)) {
      EXPECT_LT(run.error(drive), 1.0);  // OK is where it was before the jump
    }
  }
  const InertialState& state = run.history.state();
  ASSERT_EQ(state.mode, FilterMode::kRunning);
  EXPECT_GT(state.inflations, 0);
  const Eigen::Vector3d found = plane.to_plane(state.plane.to_earth(state.nav.position));
  EXPECT_LT((found - drive.position_at(t_of(state)) - Eigen::Vector3d(0.0, 30.0, 0.0)).head<2>().norm(), 1.0);
}

TEST(InertialFilter, OneWildFixChangesNothing) {
  std::vector<Event> events = sense(KnownDrive(), 40.0, DriveNoise(), 6);
  FilterRun clean, stray;
  clean.feed(events);
  for (Event& event : events) {
    if (event.source == Sensor::kFix && event.stamp == at_seconds(30.5)) {
      std::get<PositionFix>(event.data).place.latitude += 0.01;
    }
  }
  stray.feed(events);
  EXPECT_EQ(stray.history.state().of(Sensor::kFix).refused, 1u);
  EXPECT_LT((clean.history.state().nav.position - stray.history.state().nav.position).norm(), 0.1);
}

TEST(InertialFilter, FindsLateStamps) {
  // The fixes are late; from positions alone, as receivers smooth their velocity.
  DriveNoise noise;
  noise.fix_late = 0.1;
  KnownDrive drive;
  FilterRun run;
  for (const Event& event : sense(drive, 120.0, noise, 7)) {
    if (event.source != Sensor::kFixVelocity || event.stamp < at_seconds(12.0)) run.history.add(event);
  }
  const InertialState& state = run.history.state();
  EXPECT_NEAR(state.nav.stamp_offset, -0.1, 0.02) << state.error.stddev(error::kStampOffset);
  EXPECT_LT(run.error(drive), 0.3);
}

TEST(InertialFilter, ASilentSensorIsToldAndBridged) {
  KnownDrive drive;
  std::vector<Event> events = sense(drive, 60.0, DriveNoise(), 8);
  const auto lost = [](const Event& event) {
    return event.source == Sensor::kImu && event.stamp > at_seconds(40.0) && event.stamp < at_seconds(41.5);
  };
  events.erase(std::remove_if(events.begin(), events.end(), lost), events.end());
  FilterRun run;
  const MapProjection map({Projection::kLocal, 0, true, 48.0, 11.0, 500.0});
  bool told = false;
  for (const Event& event : events) {
    run.history.add(event);
    const PoseEstimate estimate = make_estimate(run.history.state(), InertialParam(), map);
    told = told || estimate.message.find("silent") != std::string::npos;
  }
  EXPECT_TRUE(told);
  EXPECT_EQ(run.history.state().mode, FilterMode::kRunning);
  EXPECT_LT(run.error(drive), 0.2);
}

TEST(InertialFilter, ANewPlaneChangesNothing) {
  KnownDrive drive;
  drive.speed = 60.0;
  drive.acceleration = 3.0;
  drive.weave = 0.0;
  FilterRun run;
  run.feed(sense(drive, 130.0, DriveNoise(), 9));
  const InertialState& state = run.history.state();
  EXPECT_LT(state.nav.position.norm(), 5000.0);
  EXPECT_LT(run.error(drive), 0.5);
  EXPECT_EQ(state.of(Sensor::kFix).refused, 0u);
}

}  // namespace
}  // namespace relative_map::core
