// The filter that the estimator is compared with is a fair one: it works where it should.
#include "relative_map/simulation/reference_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "relative_map/simulation/world.hpp"

namespace relative_map::core {
namespace {

std::vector<ReferenceFilter::Sample> samples_of(double offset, double heading) {
  std::vector<ReferenceFilter::Sample> samples;
  for (double x = 0.0; x <= 30.0; x += 5.0) samples.push_back({x, offset + heading * x, 1.0});
  return samples;
}

TEST(ReferenceFilter, FindsOffsetHeadingAndWidths) {
  ReferenceFilter filter;
  const double before = filter.offset_stddev();
  for (int i = 0; i < 100; ++i) {
    filter.predict(0.08);
    EXPECT_TRUE(filter.update(true, samples_of(0.6 + 1.9, 0.01)));
    EXPECT_TRUE(filter.update(false, samples_of(0.6 - 1.9, 0.01)));
  }
  EXPECT_NEAR(filter.offset(), 0.6, 0.01);
  EXPECT_NEAR(filter.heading(), 0.01, 1e-3);
  EXPECT_NEAR(filter.half_width(true), 1.9, 0.01);
  EXPECT_NEAR(filter.half_width(false), 1.9, 0.01);
  EXPECT_LT(filter.offset_stddev(), 0.2 * before);
}

TEST(ReferenceFilter, LeavesOtherPaintOutUntilItDoubts) {
  ReferenceFilter filter;
  for (int i = 0; i < 50; ++i) {
    filter.predict(0.08);
    filter.update(true, samples_of(1.75, 0.0));
    filter.update(false, samples_of(-1.75, 0.0));
  }
  EXPECT_FALSE(filter.update(true, samples_of(4.0, 0.0)));
  EXPECT_NEAR(filter.offset(), 0.0, 1e-3);
  filter.doubt();
  EXPECT_TRUE(filter.update(true, samples_of(4.0, 0.0)));
  EXPECT_GT(filter.offset(), 1.5);
}

/// Errors of a drive's maps [m] 10 m ahead.
double error_of(const AccuracyScene& scene, const AccuracyMethod& method) {
  AccuracyRow row;
  row.add(map_drive(record_drive(scene), method, scene.lane_source));
  return row.center[2].rms();
}

TEST(ReferenceMapMaker, WithoutErrorsItsLaneIsTheLane) {
  World world = worlds().front();
  world.localization = LocalizationClass();
  world.odometry = OdometryClass();
  world.camera = CameraClass();
  world.recording.errors = {};
  EXPECT_LT(error_of(make_world_scene(world, 1), reference_method()), 0.03);
  EXPECT_LT(error_of(make_world_scene(world, 1, true), reference_method()), 0.1) << "it follows bends late";
}

TEST(ReferenceMapMaker, IsBetterThanTheLineAlone) {
  for (const char* world : {"usual.country", "usual.motorway", "usual.laps", "gnss.datum"}) {
    const AccuracyScene scene = make_world_scene(world, 1);
    const double line = error_of(scene, {"line", "fixed_weight", false});
    EXPECT_LT(error_of(scene, reference_method()), 0.7 * line) << world;
  }
}

TEST(ReferenceMapMaker, MakesNoMapOfNothing) {
  ReferenceMapMaker maker({});
  EXPECT_TRUE(maker.tick(at_seconds(1.0)).lanes.empty());
  maker.deliver({at_seconds(1.0), LaneMarkers()});
  Localization pose;
  pose.stamp = at_seconds(1.0);
  maker.deliver({at_seconds(1.0), pose});
  EXPECT_TRUE(maker.tick(at_seconds(1.0)).lanes.empty());
}

}  // namespace
}  // namespace relative_map::core
