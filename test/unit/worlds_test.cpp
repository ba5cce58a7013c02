// Worlds are what their rows say, and no two drives are the same.
#include "relative_map/simulation/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "relative_map/simulation/drive_mapping.hpp"

namespace relative_map::core {
namespace {

template <class Message>
struct Arrived {
  Time time;
  Message message;
};

template <class Message>
std::vector<Arrived<Message>> messages_of(const RecordedDrive& drive) {
  std::vector<Arrived<Message>> found;
  for (const Delivery& delivery : drive.deliveries) {
    if (const auto* message = std::get_if<Message>(&delivery.message)) {
      found.push_back({delivery.time, *message});
    }
  }
  return found;
}

RecordedDrive drive_in(const std::string& world, std::uint64_t seed = 1) {
  return record_drive(make_world_scene(world, seed));
}

/// [m] between a pose as received and the true one.
Point2 error_of(const Localization& pose, const RecordedDrive& drive) {
  const Point2 truth = drive.truth_at(pose.stamp).path_from_base.position() + drive.road.path.origin;
  return pose.position.head<2>() - truth;
}

bool blind(const LaneMarkers& markers) {
  return markers.left.quality == 0.0 && markers.right.quality == 0.0;
}

TEST(Worlds, AreManyOfManyFamilies) {
  std::set<std::string> names, families;
  for (const World& world : worlds()) {
    names.insert(world.name);
    families.insert(world.name.substr(0, world.name.find('.')));
    EXPECT_NE(world.name.find('.'), std::string::npos) << world.name;
    EXPECT_FALSE(world.what.empty()) << world.name;
  }
  EXPECT_EQ(names.size(), worlds().size()) << "names are not unique";
  EXPECT_GE(names.size(), 40u);
  EXPECT_GE(families.size(), 9u);
}

TEST(Worlds, AreFoundByNameAndByFamily) {
  EXPECT_EQ(worlds_named("gnss.urban"), std::vector<std::string>{"gnss.urban"});
  EXPECT_EQ(worlds_named("lines").size(), 4u);
  EXPECT_THROW(worlds_named("line"), std::invalid_argument);
  EXPECT_THROW(worlds_named("moon"), std::invalid_argument);
  EXPECT_THROW(make_world_scene("lines", 1), std::invalid_argument);
}

TEST(Worlds, ASeedIsADriveOfItsOwn) {
  for (const World& world : worlds()) {
    const AccuracyScene one = make_world_scene(world, 1), same = make_world_scene(world, 1),
                        other = make_world_scene(world, 2);
    EXPECT_TRUE(one.vehicle.validate().empty()) << world.name;
    EXPECT_EQ(one.lines.back().points.back().x, same.lines.back().points.back().x) << world.name;
    EXPECT_NE(one.lines.back().points.back().x, other.lines.back().points.back().x) << world.name;
  }
}

TEST(Worlds, EveryMapInEveryWorldKeepsTheContract) {
  for (const World& world : worlds()) {
    for (const bool markers_alone : {false, true}) {
      AccuracyScene scene = make_world_scene(world, 7, markers_alone);
      scene.duration = 15.0;
      const RecordedDrive drive = record_drive(scene);
      for (const AccuracyMethod& method : accuracy_methods()) {
        if (markers_alone && !method.deliver_markers) continue;
        AccuracyRow row;
        row.add(map_drive(drive, method.config(scene.lane_source), method.deliver_markers));
        EXPECT_EQ(row.violations, 0u) << world.name << ", " << method.name << ": " << row.violation;
        EXPECT_EQ(row.center.front().count(), 141u) << world.name;
      }
    }
  }
}

TEST(Worlds, WidthsAreThoseOfTheirRoads) {
  for (const World& world : worlds()) {
    const RecordedDrive drive = drive_in(world.name, 3);
    ASSERT_EQ(drive.road.lanes.size(), world.road.lanes) << world.name;
    std::vector<double> half_widths;
    for (const TrueLane& lane : drive.road.lanes) {
      EXPECT_GE(2.0 * lane.half_width, world.road.min_width) << world.name;
      EXPECT_LE(2.0 * lane.half_width, world.road.max_width) << world.name;
      for (double s = 0.0; s < drive.road.path.length(); s += 5.0) {
        half_widths.push_back(drive.road.half_width_at(lane, s) - lane.half_width);
      }
    }
    const auto [least, most] = std::minmax_element(half_widths.begin(), half_widths.end());
    EXPECT_LE(*most, 0.5 * world.road.width_change + 1e-9) << world.name;
    EXPECT_GE(*most - *least, 0.5 * world.road.width_change) << world.name;
  }
}

TEST(Worlds, WithoutErrorsTheRecordedLineIsTheMiddleOfALaneThatChangesItsWidth) {
  AccuracyScene scene = make_world_scene("width.changes", 1);
  World world = worlds().front();
  for (const World& candidate : worlds()) {
    if (candidate.name == "width.changes") world = candidate;
  }
  world.recording.errors = {};
  scene = make_world_scene(world, 1);
  const RecordedDrive drive = record_drive(scene);
  const TrueLane& lane = drive.road.lanes.front();
  double greatest = 0.0, mean_width = 0.0;
  for (double s = 20.0; s < 900.0; s += 10.0) {
    const RoadPlace middle = drive.road.at(s, drive.road.center_at(lane, s));
    const Point2 here = middle.position + drive.road.path.origin;
    double nearest = 1e9;
    for (const LinePoint& point : scene.lines.front().points) {
      nearest = std::min(nearest, (Point2(point.x, point.y) - here).norm());
    }
    greatest = std::max(greatest, nearest);
    mean_width += drive.road.half_width_at(lane, s) / 88.0;
  }
  EXPECT_LT(greatest, 0.5 * world.recording.spacing + 0.01);
  EXPECT_NEAR(mean_width, lane.half_width, 0.2);
}

TEST(Worlds, PlainGnssLosesRepeatsAndOvertakesAndJumps) {
  const RecordedDrive drive = drive_in("gnss.country");
  std::set<Time> stamps;
  std::size_t repeated = 0, overtaken = 0, jumps = 0;
  Time newest{};
  Point2 last = Point2::Zero();
  const auto poses = messages_of<Localization>(drive);
  for (const auto& [time, pose] : poses) {
    if (!stamps.insert(pose.stamp).second) {
      ++repeated;
      continue;
    }
    if (pose.stamp < newest) {
      ++overtaken;
      continue;
    }
    newest = pose.stamp;
    if (stamps.size() > 1 && (error_of(pose, drive) - last).norm() > 0.5) ++jumps;
    last = error_of(pose, drive);
  }
  EXPECT_GE(stamps.size(), 560u);
  EXPECT_LT(stamps.size(), 600u);  // of 10 Hz in a minute
  EXPECT_GT(repeated, 2u);
  EXPECT_GT(overtaken, 1u);
  EXPECT_GE(jumps, 1u);
  EXPECT_LT(jumps, 20u);
}

TEST(Worlds, SlamAndDeadReckoningDriftAndOthersDoNot) {
  const auto last_error = [](const std::string& world) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const RecordedDrive drive = drive_in(world, seed);
      sum += error_of(messages_of<Localization>(drive).back().message, drive).norm() / 8.0;
    }
    return sum;
  };
  EXPECT_GT(last_error("drift.slam_country"), 2.0);
  EXPECT_LT(last_error("drift.slam_country"), 25.0);
  EXPECT_GT(last_error("drift.dead_reckoning"), 1.0);
  EXPECT_LT(last_error("drift.dead_reckoning"), 25.0);
  EXPECT_LT(last_error("usual.country"), 1.0);
  EXPECT_LT(last_error("rtk.country"), 0.1);
}

TEST(Worlds, AClosedLoopPutsSlamRight) {
  std::size_t closures = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const RecordedDrive drive = drive_in("drift.slam_closing", seed);
    Point2 last = Point2::Zero();
    for (const auto& [time, pose] : messages_of<Localization>(drive)) {
      const Point2 error = error_of(pose, drive);
      if (last.norm() > 1.0 && error.norm() < last.norm() - 0.5) ++closures;
      last = error;
    }
  }
  EXPECT_GE(closures, 3u);
}

TEST(Worlds, CamerasFailAsTheirRowsSay) {
  double longest = 0.0, since = -1.0;
  for (const auto& [time, image] : messages_of<LaneMarkers>(drive_in("camera.blind"))) {
    const double now = seconds_since_epoch(image.stamp);
    if (!blind(image)) since = -1.0;
    if (blind(image) && since < 0.0) since = now;
    if (blind(image)) longest = std::max(longest, now - since);
  }
  EXPECT_GT(longest, 7.0);
  EXPECT_LT(longest, 20.0);

  double least = 1.0, most = 0.0;
  for (const auto& [time, image] : messages_of<LaneMarkers>(drive_in("camera.late"))) {
    least = std::min(least, to_seconds(time - image.stamp));
    most = std::max(most, to_seconds(time - image.stamp));
  }
  EXPECT_GE(least, 0.06 - 1e-9);
  EXPECT_LT(least, 0.1);
  EXPECT_GT(most, 0.22);

  double range = 0.0;
  for (const auto& [time, image] : messages_of<LaneMarkers>(drive_in("camera.near"))) {
    range = std::max({range, image.left.view_range, image.right.view_range});
  }
  EXPECT_LE(range, 22.0);
  for (const auto& [time, image] : messages_of<LaneMarkers>(drive_in("camera.far_start"))) {
    EXPECT_EQ(image.left.longitude_start, image.left.quality > 0.0 ? 6.0 : 0.0);
  }
}

TEST(Worlds, ACameraThatLooksAsideSeesPaintThatMuchToTheOtherSide) {
  World world = worlds().front();
  world.camera.noise = {};
  world.camera.errors = {};
  const auto first_image = [&] {
    return messages_of<LaneMarkers>(record_drive(make_world_scene(world, 1))).at(20).message;
  };
  const LaneMarkers straight = first_image();
  world.camera.errors.yaw = 0.01;
  world.camera.errors.lateral = -0.06;
  const LaneMarkers aside = first_image();
  EXPECT_NEAR(aside.left.cubic.c0, straight.left.cubic.c0 + 0.06, 1e-2);
  EXPECT_NEAR(aside.left.cubic.c1, straight.left.cubic.c1 - 0.01, 1e-3);
}

TEST(Worlds, PaintIsMissingWhereTheRowSays) {
  for (const auto& [time, image] : messages_of<LaneMarkers>(drive_in("paint.left"))) {
    EXPECT_EQ(image.right.quality, 0.0);
  }
  std::size_t corners = 0;
  const RecordedDrive drive = drive_in("usual.town");
  for (const auto& [time, image] : messages_of<LaneMarkers>(drive)) {
    std::size_t vertex = 0;
    const double s = drive.truth_at(image.stamp).s;
    if (std::abs(interpolate(drive.road.path.points, s, vertex).kappa) < 1.0 / 18.0) continue;
    ++corners;
    EXPECT_TRUE(blind(image)) << s;
  }
  EXPECT_GT(corners, 50u);
}

TEST(Worlds, OtherLinesCrossMergeAndLeave) {
  const AccuracyScene crossings = make_world_scene("lines.crossings", 1);
  EXPECT_GE(crossings.lines.size(), 6u);
  EXPECT_EQ(crossings.lines.front().priority, 1u);
  EXPECT_EQ(crossings.lines.back().priority, 0u);
  const auto ends = [](const std::string& world) {
    const AccuracyScene scene = make_world_scene(world, 1);
    const auto &own = scene.lines.front().points, &other = scene.lines.back().points;
    const auto away = [&](const LinePoint& point) {
      double nearest = 1e9;
      for (const LinePoint& p : own) nearest = std::min(nearest, std::hypot(p.x - point.x, p.y - point.y));
      return nearest;
    };
    return std::make_pair(away(other.front()), away(other.back()));
  };
  const auto [ramp_start, ramp_end] = ends("lines.ramp");
  EXPECT_GT(ramp_start, 15.0);
  EXPECT_LT(ramp_end, 1.5);
  const auto [fork_start, fork_end] = ends("lines.fork");
  EXPECT_LT(fork_start, 1.5);
  EXPECT_GT(fork_end, 15.0);
}

TEST(Worlds, ManoeuvresAreDriven) {
  const auto speeds = [](const std::string& world) {
    std::vector<double> all;
    for (const auto& [time, chassis] : messages_of<Chassis>(drive_in(world))) all.push_back(chassis.speed);
    return all;
  };
  const std::vector<double> stop_and_go = speeds("usual.stop_and_go"), reverse = speeds("usual.reverse"),
                            end = speeds("usual.line_end");
  EXPECT_GT(std::count_if(stop_and_go.begin(), stop_and_go.end(), [](double v) { return v < 0.3; }), 500);
  EXPECT_GT(std::count_if(stop_and_go.begin(), stop_and_go.end(), [](double v) { return v > 2.0; }), 500);
  EXPECT_LT(*std::min_element(reverse.begin(), reverse.end()), -1.5);
  EXPECT_LT(end.back(), 0.3);
  const RecordedDrive drive = drive_in("usual.line_end");
  EXPECT_NEAR(drive.truth.back().s, drive.road.end_s - 1.0, 0.3);
  std::set<std::size_t> lanes;
  const RecordedDrive changes = drive_in("usual.lane_changes");
  for (const TruePose& pose : changes.truth) {
    const auto near = changes.road.lanes_at(pose.l);
    if (near.size() == 1) lanes.insert(near.front());
  }
  EXPECT_GE(lanes.size(), 2u);
}

}  // namespace
}  // namespace relative_map::core
