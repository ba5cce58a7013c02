// The table of worlds: each row one kind of road, drive and sensors. See world.hpp.
#include <stdexcept>

#include "relative_map/simulation/world.hpp"
#include "relative_map/simulation/world_sensors.hpp"

namespace relative_map::core {

namespace {

// Widths: motorways 3.5 to 3.75 m, country roads 2.75 to 3.5 m, towns from 2.75 m on (European guidelines);
// 2.6 m is the left lane of a road works' site, 4.6 m a lane with room for cycles or parked cars.
const WorldRoad kCountry{RoadKind::kCountry, 1, 0, 3.0, 3.6};
const WorldRoad kMotorway{RoadKind::kMotorway, 3, 1, 3.5, 3.75};
const WorldRoad kUrban{RoadKind::kUrban, 1, 0, 2.9, 3.5, 25.0};
const WorldRoad kTown{RoadKind::kTown, 1, 0, 3.0, 3.6, 20.0};
const WorldRoad kRoadWorks{RoadKind::kMotorway, 3, 0, 2.6, 2.85};
const WorldRoad kWide{RoadKind::kCountry, 1, 0, 4.1, 4.6};
const WorldRoad kTwoLanes{RoadKind::kCountry, 2, 1, 3.0, 3.75};
const WorldRoad kLeftPaint{RoadKind::kCountry, 1, 0, 2.8, 3.6, 0.0, true, false};
const WorldRoad kRightPaint{RoadKind::kUrban, 1, 0, 2.9, 4.0, 25.0, false, true};

// Bays, islands and turning lanes make a lane half a metre wider and narrower again.
const WorldRoad kChanging{RoadKind::kCountry, 1, 0, 3.1, 3.7, 0.0, true, true, 0.5};
const WorldRoad kLaps{RoadKind::kLoop, 1, 0, 3.0, 3.6};

const WorldDrive kCountrySpeed{17.0, 60.0}, kMotorwaySpeed{31.0, 60.0}, kUrbanSpeed{11.0, 70.0},
    kTownSpeed{9.0, 90.0}, kStopAndGo{9.0, 80.0, Manoeuvre::kStopAndGo},
    kLaneChanges{25.0, 70.0, Manoeuvre::kLaneChanges}, kReverse{10.0, 70.0, Manoeuvre::kReverse},
    kLineEnd{13.0, 60.0, Manoeuvre::kLineEnd}, kLapSpeed{15.0, 110.0};

std::vector<World> make_worlds() {
  return {
      {"rtk.country", "RTK and a good camera", kCountry, kCountrySpeed, rtk(), good_odometry(), good_camera(),
       good_recording()},
      {"rtk.town", "RTK, corners from 4 m on without paint", kTown, kTownSpeed, rtk(), good_odometry(),
       usual_camera(), good_recording()},
      {"usual.country", "decimetres of localization, the usual camera", kCountry, kCountrySpeed,
       corrected_gnss(), usual_odometry(), usual_camera(), usual_recording()},
      {"usual.motorway", "likewise, three lanes", kMotorway, kMotorwaySpeed, corrected_gnss(),
       usual_odometry(), usual_camera(), usual_recording()},
      {"usual.lane_changes", "likewise, changing lanes", kMotorway, kLaneChanges, corrected_gnss(),
       usual_odometry(), usual_camera(), usual_recording()},
      {"usual.urban", "corners of 12 to 20 m without paint", kUrban, kUrbanSpeed, corrected_gnss(),
       usual_odometry(), usual_camera(), usual_recording()},
      {"usual.town", "corners from 4 m on without paint", kTown, kTownSpeed, corrected_gnss(),
       usual_odometry(), usual_camera(), usual_recording()},
      {"usual.stop_and_go", "standing, crawling, driving", kTwoLanes, kStopAndGo, corrected_gnss(),
       usual_odometry(), usual_camera(), usual_recording()},
      {"usual.reverse", "stops, reverses, goes on", kTwoLanes, kReverse, corrected_gnss(), usual_odometry(),
       usual_camera(), usual_recording()},
      {"usual.line_end", "stops at the end of the line", kCountry, kLineEnd, corrected_gnss(),
       usual_odometry(), usual_camera(), usual_recording()},
      {"usual.laps", "laps of a closed line", kLaps, kLapSpeed, corrected_gnss(), usual_odometry(),
       usual_camera(), usual_recording()},
      {"gnss.country", "plain GNSS at 10 Hz: a bias of minutes, jumps, lost, repeated and late messages",
       kCountry, kCountrySpeed, plain_gnss(), usual_odometry(), usual_camera(), usual_recording()},
      {"gnss.urban", "likewise, corners without paint", kUrban, kUrbanSpeed, plain_gnss(), usual_odometry(),
       usual_camera(), usual_recording()},
      {"gnss.motorway", "likewise, at 5 Hz and three lanes, without jumps", kMotorway, kMotorwaySpeed,
       slow_gnss(), usual_odometry(), usual_camera(), usual_recording()},
      {"gnss.fast", "likewise, filtered to 100 Hz with an IMU, jumps", kCountry, kCountrySpeed, fast_gnss(),
       usual_odometry(), usual_camera(), usual_recording()},
      {"gnss.datum", "localization of decimetres, metres beside the map", kCountry, kCountrySpeed,
       other_datum(), usual_odometry(), usual_camera(), usual_recording()},
      {"drift.slam_country", "SLAM that drifts", kCountry, kCountrySpeed, slam(), usual_odometry(),
       usual_camera(), usual_recording()},
      {"drift.slam_town", "likewise, corners from 4 m on without paint", kTown, kTownSpeed, slam(),
       usual_odometry(), usual_camera(), usual_recording()},
      {"drift.slam_closing", "likewise, put right by a closed loop now and then", kTown, kTownSpeed,
       closing_slam(), usual_odometry(), usual_camera(), usual_recording()},
      {"drift.dead_reckoning", "wheels and a gyro alone", kTwoLanes, kCountrySpeed, dead_reckoning(),
       good_odometry(), usual_camera(), usual_recording()},
      {"camera.good", "5 cm near, 65 m far", kCountry, kCountrySpeed, corrected_gnss(), usual_odometry(),
       good_camera(), usual_recording()},
      {"camera.poor", "rain: noisy for seconds, short-sighted, often wrong", kCountry, kCountrySpeed,
       corrected_gnss(), usual_odometry(), poor_camera(), usual_recording()},
      {"camera.aside", "0.7 degrees and 6 cm off its mounting", kCountry, kCountrySpeed, corrected_gnss(),
       usual_odometry(), aside_camera(), usual_recording()},
      {"camera.late", "60 to 250 ms late", kCountry, kCountrySpeed, corrected_gnss(), usual_odometry(),
       late_camera(), usual_recording()},
      {"camera.near", "sees 12 to 22 m", kCountry, kCountrySpeed, corrected_gnss(), usual_odometry(),
       near_sighted_camera(), usual_recording()},
      {"camera.blind", "sees no paint for ten seconds again and again", kCountry, kCountrySpeed,
       corrected_gnss(), usual_odometry(), blind_camera(), usual_recording()},
      {"camera.far_start", "sees nothing nearer than 6 m", kCountry, kCountrySpeed, corrected_gnss(),
       usual_odometry(), far_starting_camera(), usual_recording()},
      {"camera.deceived", "follows kerbs and joints for seconds", kCountry, kCountrySpeed, corrected_gnss(),
       usual_odometry(), deceived_camera(), usual_recording()},
      {"odometry.cheap", "a gyro off by up to 0.6 deg/s, a speed by up to 3 %", kCountry, kCountrySpeed,
       corrected_gnss(), cheap_odometry(), usual_camera(), usual_recording()},
      {"odometry.cheap_gnss", "likewise with plain GNSS, corners without paint", kUrban, kUrbanSpeed,
       plain_gnss(), cheap_odometry(), usual_camera(), usual_recording()},
      {"recording.sways", "0.3 m off, swaying by 0.35 m over 40 m", kUrban, kUrbanSpeed, corrected_gnss(),
       usual_odometry(), usual_camera(), swaying_recording()},
      {"width.narrow",
       "lanes of 2.6 to 2.85 m",
       kRoadWorks,
       {22.0, 60.0},
       corrected_gnss(),
       usual_odometry(),
       usual_camera(),
       usual_recording()},
      {"width.wide", "a lane of 4.1 to 4.6 m", kWide, kCountrySpeed, corrected_gnss(), usual_odometry(),
       usual_camera(), usual_recording()},
      {"width.changes", "a lane that changes its width by half a metre", kChanging, kCountrySpeed,
       corrected_gnss(), usual_odometry(), usual_camera(), usual_recording()},
      {"paint.left", "on the left only", kLeftPaint, kCountrySpeed, corrected_gnss(), usual_odometry(),
       usual_camera(), usual_recording()},
      {"paint.right", "on the right only, none in corners", kRightPaint, kUrbanSpeed, corrected_gnss(),
       usual_odometry(), usual_camera(), usual_recording()},
      {"lines.crossings", "better lines cross at 30 to 80 degrees", kUrban, kUrbanSpeed, corrected_gnss(),
       usual_odometry(), usual_camera(), usual_recording(), OtherLines::kCrossings},
      {"lines.ramp", "a better line merges from the right", kCountry, kCountrySpeed, corrected_gnss(),
       usual_odometry(), usual_camera(), usual_recording(), OtherLines::kRamp},
      {"lines.fork", "a worse line leaves to the right", kCountry, kCountrySpeed, corrected_gnss(),
       usual_odometry(), usual_camera(), usual_recording(), OtherLines::kFork},
      {"lines.double", "the lane was recorded twice, badly", kCountry, kCountrySpeed, corrected_gnss(),
       usual_odometry(), usual_camera(), swaying_recording(), OtherLines::kDouble},
  };
}

}  // namespace

const std::vector<World>& worlds() {
  static const std::vector<World> all = make_worlds();
  return all;
}

std::vector<std::string> worlds_named(const std::string& name) {
  std::vector<std::string> names;
  for (const World& world : worlds()) {
    if (world.name == name || world.name.compare(0, name.size() + 1, name + ".") == 0) {
      names.push_back(world.name);
    }
  }
  if (names.empty()) throw std::invalid_argument("there is no world '" + name + "'");
  return names;
}

AccuracyScene make_world_scene(const std::string& name, std::uint64_t seed, bool markers_alone) {
  for (const World& world : worlds()) {
    if (world.name == name) return make_world_scene(world, seed, markers_alone);
  }
  throw std::invalid_argument("there is no world '" + name + "'");
}

}  // namespace relative_map::core
