#include "relative_map/simulation/accuracy_benchmark.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "relative_map/simulation/road.hpp"

namespace relative_map::core {
namespace {

AccuracyScene short_scene(const std::string& name, std::uint64_t seed = 1, const ErrorLevel& level = {}) {
  AccuracyScene scene = make_accuracy_scene(name, seed, level);
  scene.duration = 15.0;
  return scene;
}

AccuracyRow row_of(const std::vector<MeasuredMap>& maps) {
  AccuracyRow row;
  for (const MeasuredMap& map : maps) row.add(map);
  return row;
}

TEST(AccuracyBenchmark, EverySceneIsMappedByEveryMethodWithoutAViolation) {
  for (const std::string& name : accuracy_scene_names()) {
    const AccuracyScene scene = short_scene(name);
    const RecordedDrive drive = record_drive(scene);
    for (const AccuracyMethod& method : accuracy_methods()) {
      if (scene.lines.empty() && !method.deliver_markers) continue;
      const AccuracyRow row =
          row_of(map_drive(drive, method.config(scene.lane_source), method.deliver_markers));
      EXPECT_EQ(row.violations, 0u) << name << ", " << method.name << ": " << row.violation;
      EXPECT_EQ(row.center.front().count(), 141u) << name;
      EXPECT_GT(row.usable, scene.group == SceneGroup::kDrifting ? 20u : 50u) << name << ", " << method.name;
    }
  }
}

TEST(AccuracyBenchmark, WithoutErrorsTheLineIsTheLane) {
  for (const char* name : {"motorway", "country", "lane-change"}) {
    const AccuracyScene scene = short_scene(name, 2, {0.0});
    const RecordedDrive drive = record_drive(scene);
    const AccuracyRow row = row_of(map_drive(drive, PipelineConfig(), false));
    // Pose by pose, but for what lies between the vertices of either polyline.
    for (const ErrorStatistics& error : row.center) EXPECT_LT(error.rms(), 1e-3) << name;
    EXPECT_LT(row.half_width.rms(), 2e-3) << name;
    EXPECT_LT(row.jitter_30.rms(), 1e-3) << name;
  }
}

TEST(AccuracyBenchmark, OnAStraightWithoutErrorsNothingIsOff) {
  AccuracyScene scene = short_scene("perfect");
  const RoadShape road = RoadShape(Pose2(Point2(500000.0, 4000000.0), 0.7)).add_straight(800.0);
  scene.reference = road.lane(0.0, 0.1);
  scene.lines = {road.lane(0.0, 0.4)};
  const AccuracyRow row = row_of(map_drive(record_drive(scene), PipelineConfig(), false));
  for (const ErrorStatistics& error : row.center) {
    EXPECT_EQ(error.count(), 141u);
    EXPECT_LT(error.rms(), 1e-6);
  }
}

TEST(AccuracyBenchmark, ErrorsOfTheLineGrowWithTheScale) {
  const auto error = [](double scale) {
    BenchmarkOptions options;
    options.scenes = {"motorway"};
    options.methods = {"line"};
    options.level.scale = scale;
    return run_benchmark(options).rows.at(0).center[2].rms();
  };
  const double usual = error(1.0), twice = error(2.0);
  EXPECT_GT(usual, 0.15);
  EXPECT_LT(usual, 0.6);
  EXPECT_NEAR(twice / usual, 2.0, 0.1);
}

TEST(AccuracyBenchmark, AHarshCameraFailsMoreOften) {
  const auto seen = [](bool harsh) {
    AccuracyScene scene = make_accuracy_scene("motorway", 1, {1.0, harsh});
    int sides = 0, images = 0;
    for (const Delivery& delivery : record_drive(scene).deliveries) {
      const auto* markers = std::get_if<LaneMarkers>(&delivery.message);
      if (markers == nullptr) continue;
      ++images;
      sides += (markers->left.quality > 0.0 ? 1 : 0) + (markers->right.quality > 0.0 ? 1 : 0);
    }
    return 0.5 * sides / images;
  };
  EXPECT_GT(seen(false), 0.85);
  EXPECT_LT(seen(true), seen(false) - 0.02);
}

TEST(AccuracyBenchmark, TheSameSeedGivesTheSameDrive) {
  const RecordedDrive one = record_drive(short_scene("urban", 3)),
                      same = record_drive(short_scene("urban", 3)),
                      other = record_drive(short_scene("urban", 4));
  ASSERT_EQ(one.deliveries.size(), same.deliveries.size());
  const auto last_pose = [](const RecordedDrive& drive) {
    return drive.truth.back().path_from_base.position();
  };
  EXPECT_EQ(last_pose(one), last_pose(same));
  EXPECT_NE(last_pose(one), last_pose(other));
}

TEST(AccuracyBenchmark, MessagesArriveInOrderAndMarkersLate) {
  const RecordedDrive drive = record_drive(short_scene("country"));
  Time before = drive.start;
  double least = 1.0, most = 0.0;
  int localizations = 0, markers = 0;
  for (const Delivery& delivery : drive.deliveries) {
    EXPECT_GE(delivery.time, before);
    before = delivery.time;
    if (std::holds_alternative<Localization>(delivery.message)) ++localizations;
    const auto* message = std::get_if<LaneMarkers>(&delivery.message);
    if (message == nullptr) continue;
    ++markers;
    const double latency = to_seconds(delivery.time - message->stamp);
    least = std::min(least, latency);
    most = std::max(most, latency);
  }
  EXPECT_GE(least, 0.05 - 1e-9);
  EXPECT_LE(most, 0.15 + 1e-9);
  EXPECT_GT(most - least, 0.08);
  EXPECT_GE(localizations, 15 * 50 - 1);
  EXPECT_LE(localizations, 15 * 100 + 1);
  EXPECT_GE(markers, 15 * 10 - 3);
  EXPECT_LE(markers, 15 * 15 + 1);
}

std::vector<LaneMarkers> images_of(const RecordedDrive& drive) {
  std::vector<LaneMarkers> images;
  for (const Delivery& delivery : drive.deliveries) {
    if (const auto* markers = std::get_if<LaneMarkers>(&delivery.message)) images.push_back(*markers);
  }
  return images;
}

TEST(AccuracyBenchmark, BadMarkersAreBadInTheWayTheirSceneSays) {
  AccuracyScene scene = short_scene("bad-frozen");
  scene.marker_fault = MarkerFault::kNone;
  const std::vector<LaneMarkers> good = images_of(record_drive(scene));
  const auto spoilt = [&](MarkerFault fault) {
    scene.marker_fault = fault;
    return images_of(record_drive(scene));
  };
  const std::size_t i = 100;
  ASSERT_GT(good[i].left.quality + good[i].right.quality, 0.0);
  EXPECT_NEAR(spoilt(MarkerFault::kLaneOff)[i].left.cubic.c0, good[i].left.cubic.c0 + 3.5, 1e-12);
  EXPECT_NEAR(spoilt(MarkerFault::kLaneOff)[i].right.cubic.c0, good[i].right.cubic.c0 + 3.5, 1e-12);
  EXPECT_EQ(spoilt(MarkerFault::kMirrored)[i].left.cubic.c0, good[i].right.cubic.c0);
  EXPECT_EQ(spoilt(MarkerFault::kMirrored)[i].right.cubic.c0, good[i].left.cubic.c0);
  EXPECT_EQ(spoilt(MarkerFault::kFrozen)[i].left.cubic.c1, good[0].left.cubic.c1);
  EXPECT_EQ(spoilt(MarkerFault::kFrozen)[i].stamp, good[i].stamp);
  EXPECT_EQ(spoilt(MarkerFault::kFuture)[i].stamp, good[i].stamp + std::chrono::seconds(1));
}

TEST(AccuracyBenchmark, ALineOfOnesOwnIsAScene) {
  RecordedLine line = demo_road(Pose2(Point2(691188.0, 3118142.0), 1.0)).lane(0.0, 0.5, "mine");
  line.priority = 3;
  const AccuracyScene scene = make_line_scene(line, 1, {0.0});
  const AccuracyRow row = row_of(map_drive(record_drive(scene), PipelineConfig(), false));
  EXPECT_EQ(scene.name, "mine");
  EXPECT_EQ(row.usable, row.usable_of);
  EXPECT_LT(row.center[4].rms(), 1e-3);

  BenchmarkOptions options;
  options.seeds = 1;
  options.lines = {line};
  options.methods = {"line"};
  const BenchmarkResult result = run_benchmark(options);
  ASSERT_EQ(result.rows.size(), 1u);
  EXPECT_EQ(result.rows[0].scene, "mine");
  EXPECT_GT(result.rows[0].center[4].rms(), 0.1);
  options.scenes = {"urban"};
  EXPECT_EQ(run_benchmark(options).rows.size(), 2u);
}

TEST(AccuracyBenchmark, TotalsPoolTheMapsOfAGroup) {
  BenchmarkOptions options;
  options.seeds = 1;
  options.scenes = {"urban", "end-of-line", "drift-one-line"};
  options.methods = {"line"};
  int drives = 0;
  const BenchmarkResult result = run_benchmark(
      options,
      [&](const AccuracyScene&, std::uint64_t, const AccuracyMethod&, const std::vector<MeasuredMap>& maps) {
        ++drives;
        EXPECT_FALSE(maps.empty());
      });
  EXPECT_EQ(drives, 3);
  ASSERT_EQ(result.rows.size(), 3u);
  ASSERT_EQ(result.totals.size(), 2u);
  const ErrorStatistics &a = result.rows[0].center[2], &b = result.rows[1].center[2],
                        &both = result.totals[0].center[2];
  ASSERT_EQ(both.count(), a.count() + b.count());
  const auto square = [](const ErrorStatistics& e) {
    return e.rms() * e.rms() * static_cast<double>(e.count());
  };
  EXPECT_NEAR(square(both), square(a) + square(b), 1e-9);
  EXPECT_GT(result.totals[1].center[2].rms(), 3.0 * both.rms());  // it has drifted away
  EXPECT_LT(result.totals[1].usable, result.totals[1].usable_of);
}

TEST(AccuracyBenchmark, UnknownNamesAreRefused) {
  EXPECT_THROW(make_accuracy_scene("moon", 1), std::invalid_argument);
  BenchmarkOptions options;
  options.methods = {"magic"};
  EXPECT_THROW(run_benchmark(options), std::invalid_argument);
}

TEST(ErrorStatistics, RmsAnd95thPercentile) {
  ErrorStatistics statistics;
  EXPECT_TRUE(std::isnan(statistics.rms()));
  EXPECT_TRUE(std::isnan(statistics.percentile_95()));
  for (int i = 0; i <= 100; ++i) statistics.add(i % 2 == 0 ? 0.01 * i : -0.01 * i);
  EXPECT_NEAR(statistics.percentile_95(), 0.95, 1e-9);
  EXPECT_NEAR(statistics.median(), 0.5, 1e-9);
  EXPECT_NEAR(statistics.rms(), std::sqrt(201.0 / 6.0) / 10.0, 1e-2);
}

}  // namespace
}  // namespace relative_map::core
