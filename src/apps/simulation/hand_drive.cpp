// A bag of the first day: somebody drives along a road by hand, and a satellite receiver is all that is
// recorded.
#include <ros/time.h>
#include <sensor_msgs/NavSatFix.h>

#include <cmath>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "navigation_line_command.hpp"
#include "relative_map/io/geodetic_projection.hpp"
#include "relative_map/io/whole_file.hpp"
#include "relative_map/simulation/vehicle_simulation.hpp"
#include "whole_bag.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    R"(Usage: rosrun relative_map hand_drive LINE OUT.bag (--utm ZONE | --origin LAT,LON[,ALT]) [OPTION]...

Simulates a person who drives along LINE, swaying in the lane, with a satellite receiver, and writes its
sensor_msgs/NavSatFix to OUT.bag, on /fix at 10 Hz: what `navigation_line record` makes a line of. The car stands at
first. On a lap it drives on for a bit past the start; an open line it drives to its end. No master is needed, it takes a
moment only, and the same call writes the same drive.

  --utm ZONE, --origin LAT,LON[,ALT]   where LINE's coordinates lie on the earth
  --start S      [m] along LINE, where the car stands at first (0)
  --beyond D     [m] that a lap is driven on past its start (30)
  --standing T   [s] before it starts (5)
  --speed V      [m/s] on straights (10)
  --sway D       [m] that the driver strays from LINE at most (0.3)
  --noise D      [m] of the fixes, east and north: standard deviation of what is new in each (0.05)
  --bias D       [m] likewise, of what changes slowly, within a minute (0.15)
  --seed N       of the sway and the noise (1)

Example: rosrun relative_map make_road --out road --road closed --origin 691000 5335000 0.4
         rosrun relative_map hand_drive road/lane_1.smoothed lap.bag --utm 32N
Exit codes: 0 written, 1 that failed, 2 bad arguments.
)";

constexpr double kPeriod = 0.1;       // [s]
constexpr double kBiasTime = 60.0;    // [s]
constexpr double kBagStart = 1.7e9;   // [s] fixed: the same call writes the same bag
constexpr double kMaxTime = 36000.0;  // [s] of driving
constexpr double kSeedLimit = 2e9;
const std::set<std::string> kTopics = {"/fix"};

struct HandDrive {
  core::VehicleSimulationConfig config;
  double beyond = 0.0;           ///< [m]
  core::GeoReference reference;  ///< of the line's coordinates
};

HandDrive parse(const CommandLine& line) {
  HandDrive drive;
  drive.reference = reference_of(line);
  if (drive.reference.projection == core::Projection::kNone) {
    throw UsageError("--utm or --origin must say where the line lies on the earth");
  }
  drive.beyond = line.number("--beyond", 30.0, 0.0, 1000.0);
  core::VehicleSimulationConfig& config = drive.config;
  config.seed = static_cast<std::uint64_t>(line.number("--seed", 1.0, 0.0, kSeedLimit));
  config.start_s = line.number("--start", 0.0, 0.0, 1e6);
  config.wander = line.number("--sway", 0.3, 0.0, 2.0);
  config.speed.max_speed = line.number("--speed", 10.0, 1.0, 50.0);
  config.speed_changes = {{0.0, 0.0}, {line.number("--standing", 5.0, 0.0, 600.0), config.speed.max_speed}};
  config.noise.localization_position = line.number("--noise", 0.05, 0.0, 10.0);
  config.errors.localization.bias = line.number("--bias", 0.15, 0.0, 10.0);
  config.errors.localization.bias_time = kBiasTime;
  return drive;
}

/// Where the receiver says that the car is, in the line's coordinates, every kPeriod.
std::vector<core::LinePoint> drive_along(const core::RecordedLine& line, const HandDrive& drive) {
  core::VehicleSimulation vehicle(line, drive.config);
  const double lap = vehicle.path().length();
  const bool closed = vehicle.path().ends != core::Ends::kOpen;
  std::vector<core::LinePoint> places;
  double driven = 0.0;
  while (!vehicle.at_end() && !(closed && driven >= lap + drive.beyond)) {
    if (core::to_seconds(vehicle.time()) > kMaxTime)
      throw std::runtime_error("the drive takes over ten hours");
    const core::Point2 position = vehicle.measure_localization().position.head<2>();
    places.push_back({position.x(), position.y(), drive.reference.altitude, 0.0, 0.0, 0.0, 0.0});
    const double before = vehicle.s();
    vehicle.step(kPeriod);
    driven += vehicle.s() - before + (vehicle.s() < before ? lap : 0.0);
  }
  return places;
}

sensor_msgs::NavSatFix to_fix(const core::GeoPoint& place, const HandDrive& drive) {
  sensor_msgs::NavSatFix fix;
  fix.header.frame_id = "base_link";
  fix.status.status = sensor_msgs::NavSatStatus::STATUS_GBAS_FIX;
  fix.status.service = sensor_msgs::NavSatStatus::SERVICE_GPS;
  fix.latitude = place.latitude;
  fix.longitude = place.longitude;
  fix.altitude = place.altitude;
  const double sigma =
      std::hypot(drive.config.noise.localization_position, drive.config.errors.localization.bias);
  fix.position_covariance[0] = fix.position_covariance[4] = sigma * sigma;
  fix.position_covariance[8] = 4.0 * sigma * sigma;
  fix.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_APPROXIMATED;
  return fix;
}

void write_fixes(const std::string& path, const std::vector<core::GeoPoint>& places, const HandDrive& drive) {
  WholeBag bag(path, kTopics);
  for (std::size_t i = 0; i < places.size(); ++i) {
    sensor_msgs::NavSatFix fix = to_fix(places[i], drive);
    fix.header.stamp = ros::Time(kBagStart) + ros::Duration(kPeriod * static_cast<double>(i));
    bag.write("/fix", fix.header.stamp, fix);
  }
  bag.close();
}

int run(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--utm", "--origin", "--start", "--beyond", "--standing", "--speed",
                                 "--sway", "--noise", "--bias", "--seed"});
  const std::vector<std::string>& files = line.files(2, 2, "LINE and OUT.bag");
  const HandDrive drive = parse(line);
  core::expect_not_among(files[1], {files[0]});
  expect_bag_writable(files[1], kTopics);
  std::vector<core::LinePoint> places;
  std::vector<core::GeoPoint> fixes;
  try {
    places = drive_along(load_line(files[0]).line, drive);
    fixes = core::unproject(places, drive.reference);
  } catch (const std::exception& fault) {
    throw std::runtime_error(files[0] + ": cannot be driven along: " + fault.what());
  }
  write_fixes(files[1], fixes, drive);
  std::printf("%s: %zu fixes in %.1f s, the first at latitude %.7f, longitude %.7f\n", files[1].c_str(),
              fixes.size(), kPeriod * static_cast<double>(fixes.size()), fixes[0].latitude,
              fixes[0].longitude);
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("hand_drive", relative_map::kUsage, argc, argv, relative_map::run);
}
