#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "relative_map/simulation/road.hpp"
#include "support/scene.hpp"

// Laws that hold for any road, vehicle and markers; RapidCheck looks for the smallest that break them.
namespace relative_map::core {
namespace {

using test::lane_about;
using test::localization_at;

/// The same cases each time; RC_PARAMS in the environment asks for others, and for more.
const int kFixedCases = setenv("RC_PARAMS", "seed=1 max_success=200", 0);

double number(double low, double high) {
  constexpr int kSteps = 1 << 20;
  return low + (high - low) * *rc::gen::inRange(0, kSteps + 1) / kSteps;
}

Pose2 any_pose_on_earth() {
  return {Point2(number(1e5, 9e5), number(0.0, 1e7)), number(-kPi, kPi)};
}

/// What a map depends on.
struct Inputs {
  std::vector<RecordedLine> lines;
  Pose2 vehicle;
  std::optional<LaneMarkers> markers;
  double weight = 0.1;
  std::string method = "estimator";
  double max_half_width = 2.0;
};

RelativeMap map_of(const Inputs& inputs) {
  PipelineConfig config;
  config.navigation_lane.lane_marker_weight = inputs.weight;
  config.lane_fusion.method = inputs.method;
  config.navigation_lane.max_lane_half_width = inputs.max_half_width;
  RelativeMapPipeline pipeline(std::make_shared<PipelineConfig>(config));
  pipeline.set_navigation_lines(prepare_navigation_lines({"map", inputs.lines}, IntakeParam()));
  const Time now = at_seconds(50.0);
  pipeline.set_localization(localization_at(inputs.vehicle, now));
  if (inputs.markers) {
    pipeline.set_lane_markers(*inputs.markers);
  }
  return pipeline.tick(now);
}

Cubic any_center() {
  return {number(-0.8, 0.8), number(-0.05, 0.05), number(-1e-3, 1e-3), number(-5e-6, 5e-6)};
}

Inputs any_inputs() {
  RoadShape road;
  const int pieces = *rc::gen::inRange(1, 4);
  for (int i = 0; i < pieces; ++i) {
    const double kappa = number(-0.02, 0.02);
    road.add_clothoid(number(20.0, 60.0), kappa)
        .add_arc(number(20.0, 80.0))
        .add_clothoid(number(20.0, 60.0), 0.0);
  }
  Inputs inputs;
  const int lanes = *rc::gen::inRange(1, 4);
  const double width = number(2.5, 4.5);
  for (int i = 0; i < lanes; ++i) {  // each with its own spacing: vertices side by side would tie
    inputs.lines.push_back(
        road.lane(width * (0.5 * (lanes - 1) - i), number(0.3, 1.5), "lane_" + std::to_string(i)));
    inputs.lines.back().priority = static_cast<std::uint32_t>(i);
  }
  const PathPoint beside = road.at(number(5.0, 0.8 * road.length()), number(-4.0, 4.0));
  inputs.vehicle = Pose2(beside.position, normalize_angle(beside.theta + number(-0.1, 0.1)));
  if (*rc::gen::arbitrary<bool>()) {
    inputs.markers = lane_about(any_center(), number(1.5, 2.0), number(10.0, 80.0));
    inputs.markers->stamp = at_seconds(50.0);
  }
  inputs.weight = number(0.0, 1.0);
  return inputs;
}

RecordedLine moved(RecordedLine line, const Pose2& move) {
  for (LinePoint& point : line.points) {
    const Point2 position = move.to_parent(Point2(point.x, point.y));
    point.x = position.x();
    point.y = position.y();
    point.theta = normalize_angle(point.theta + move.heading());
  }
  return line;
}

RecordedLine mirrored(RecordedLine line) {
  for (LinePoint& point : line.points) {
    point.y = -point.y;
    point.theta = -point.theta;
    point.kappa = -point.kappa;
    point.dkappa = -point.dkappa;
  }
  return line;
}

void expect_same_widths(const std::vector<WidthSample>& a, const std::vector<WidthSample>& b,
                        double tolerance) {
  RC_ASSERT(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) RC_ASSERT(std::abs(a[i].width - b[i].width) < tolerance);
}

void expect_same_lane(const Lane& a, const Lane& b, double tolerance) {
  RC_ASSERT(a.id == b.id);
  RC_ASSERT(a.priority == b.priority);
  RC_ASSERT(a.path.size() == b.path.size());
  for (std::size_t i = 0; i < a.path.size(); ++i) {
    RC_ASSERT((a.path[i].position - b.path[i].position).norm() < tolerance);
    RC_ASSERT(std::abs(angle_difference(a.path[i].theta, b.path[i].theta)) < 1e-5);
    RC_ASSERT(std::abs(a.path[i].kappa - b.path[i].kappa) < 1e-4);
    RC_ASSERT(std::abs(a.path[i].s - b.path[i].s) < tolerance);
  }
  // Of two segments that are as near the one or the other counts: a border's point may move along it.
  expect_same_widths(a.left_samples, b.left_samples, 1e-3);
  expect_same_widths(a.right_samples, b.right_samples, 1e-3);
}

RC_GTEST_PROP(Invariance, APointComesBackFromTheBodyFrame, ()) {
  const Pose2 pose = any_pose_on_earth();
  const Point2 point = pose.position() + Point2(number(-500.0, 500.0), number(-500.0, 500.0));
  RC_ASSERT((pose.to_parent(pose.to_local(point)) - point).norm() < 4e-9);  // two steps of a double of 1e7
  RC_ASSERT(std::abs(pose.to_local(point).norm() - (point - pose.position()).norm()) < 1e-12 * 1e3);
}

RC_GTEST_PROP(Invariance, TheMapStaysWhereVehicleAndLinesMoveTogether, ()) {
  const Inputs inputs = any_inputs();
  const Pose2 move = any_pose_on_earth();
  Inputs elsewhere = inputs;
  for (RecordedLine& line : elsewhere.lines) line = moved(line, move);
  elsewhere.vehicle = move.to_parent(inputs.vehicle);
  const RelativeMap here = map_of(inputs), there = map_of(elsewhere);
  RC_ASSERT(here.status.code == StatusCode::kOk);
  RC_ASSERT(here.current_lane_id == there.current_lane_id);
  RC_ASSERT(here.lanes.size() == there.lanes.size());
  for (std::size_t i = 0; i < here.lanes.size(); ++i) expect_same_lane(here.lanes[i], there.lanes[i], 1e-6);
  RC_ASSERT(std::abs(here.fusion.lateral_offset.value - there.fusion.lateral_offset.value) < 1e-6);
}

RC_GTEST_PROP(Invariance, MirroredInputsGiveTheMirroredMap, ()) {
  Inputs inputs = any_inputs();
  inputs.max_half_width = 10.0;  // lanes just as far apart as neighbours may be would tie
  Inputs other = inputs;
  for (RecordedLine& line : other.lines) line = mirrored(line);
  other.vehicle =
      Pose2(Point2(inputs.vehicle.position().x(), -inputs.vehicle.position().y()), -inputs.vehicle.heading());
  if (inputs.markers) other.markers = test::mirrored(*inputs.markers);
  const RelativeMap a = map_of(inputs), b = map_of(other);
  RC_ASSERT(a.current_lane_id == b.current_lane_id);
  RC_ASSERT(a.lanes.size() == b.lanes.size());
  RC_ASSERT(std::abs(a.fusion.lateral_offset.value + b.fusion.lateral_offset.value) < 1e-9);
  for (std::size_t i = 0; i < a.lanes.size(); ++i) {
    const Lane &lane = a.lanes[i], &mirror = b.lanes[a.lanes.size() - 1 - i];
    RC_ASSERT(lane.id == mirror.id);
    RC_ASSERT(lane.left_neighbor_id == mirror.right_neighbor_id);
    RC_ASSERT(lane.path.size() == mirror.path.size());
    for (std::size_t k = 0; k < lane.path.size(); ++k) {
      const Point2 position(mirror.path[k].position.x(), -mirror.path[k].position.y());
      RC_ASSERT((lane.path[k].position - position).norm() < 1e-9);
      RC_ASSERT(std::abs(lane.path[k].theta + mirror.path[k].theta) < 1e-9);
      RC_ASSERT(std::abs(lane.path[k].kappa + mirror.path[k].kappa) < 1e-6);
    }
    // Shared borders have their points square to the left lane: that matters where lanes are askew, as a
    // fused one may be, and where one of them ends.
    const double tolerance = inputs.markers ? 0.2 : 0.05;
    expect_same_widths(lane.left_samples, mirror.right_samples, tolerance);
    expect_same_widths(lane.right_samples, mirror.left_samples, tolerance);
  }
}

RC_GTEST_PROP(Invariance, TheOrderOfTheLinesInTheMessageDoesNotMatter, ()) {
  const Inputs inputs = any_inputs();
  Inputs reversed = inputs;
  std::reverse(reversed.lines.begin(), reversed.lines.end());
  const RelativeMap a = map_of(inputs), b = map_of(reversed);
  RC_ASSERT(a.lanes.size() == b.lanes.size());
  for (std::size_t i = 0; i < a.lanes.size(); ++i) expect_same_lane(a.lanes[i], b.lanes[i], 1e-12);
}

RC_GTEST_PROP(Invariance, WeightZeroGivesTheLinesAlone, ()) {
  Inputs inputs = any_inputs();
  inputs.weight = 0.0;
  Inputs without = inputs;
  without.markers.reset();
  const RelativeMap a = map_of(inputs), b = map_of(without);
  RC_ASSERT(a.lanes.size() == b.lanes.size());
  for (std::size_t i = 0; i < a.lanes.size(); ++i) {
    for (std::size_t k = 0; k < a.lanes[i].path.size(); ++k) {
      RC_ASSERT(a.lanes[i].path[k].position == b.lanes[i].path[k].position);
      RC_ASSERT(a.lanes[i].path[k].theta == b.lanes[i].path[k].theta);
    }
  }
}

const Lane& current_lane(const RelativeMap& map) {
  return *std::find_if(map.lanes.begin(), map.lanes.end(),
                       [&](const Lane& lane) { return lane.id == map.current_lane_id; });
}

const PathPoint& beside_vehicle(const Lane& lane) {
  return *std::min_element(lane.path.begin(), lane.path.end(), [](const PathPoint& a, const PathPoint& b) {
    return a.position.squaredNorm() < b.position.squaredNorm();
  });
}

/// A center that runs about along a lane.
Cubic any_center_near(const Lane& lane) {
  const PathPoint& beside = beside_vehicle(lane);
  const Cubic error = any_center();
  return {beside.position.y() + error.c0, std::tan(beside.theta) + error.c1, beside.kappa / 2.0 + error.c2,
          error.c3};
}

RC_GTEST_PROP(Invariance, WeightOneGivesTheMarkersAloneInsideTheirViewRange, ()) {
  Inputs inputs = any_inputs();
  inputs.markers.reset();
  const Cubic center = any_center_near(current_lane(map_of(inputs)));
  inputs.markers = lane_about(center);
  inputs.markers->stamp = at_seconds(50.0);
  inputs.method = "fixed_weight";
  inputs.weight = 1.0;
  const RelativeMap map = map_of(inputs);
  RC_PRE(map.fusion.source == Source::kFused);  // markers of another lane do not count
  const Lane& lane = current_lane(map);
  int compared = 0;
  for (const PathPoint& point : lane.path) {
    const double ahead = point.s - beside_vehicle(lane).s;
    if (point.position.x() < 0.5 || ahead > map.fusion.marker_range - 2.0) continue;
    RC_ASSERT(std::abs(point.position.y() - center.value(point.position.x())) < 1e-4);
    ++compared;
  }
  RC_TAG(compared > 10 ? "compared" : "too short to compare");
}

}  // namespace
}  // namespace relative_map::core
