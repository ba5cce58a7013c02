#include "relative_map/simulation/random_roads.hpp"

#include <cmath>
#include <random>

#include "relative_map/simulation/random_process.hpp"

namespace relative_map::core {

namespace {

/// A road that is laid piece by piece, and turned back when it has turned far to one side.
class Surveyor {
 public:
  Surveyor(std::uint64_t seed, std::uint32_t stream)
      : engine_(random_engine(seed, stream)), road_(random_start(seed)) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  void straight(double length) { road_.add_straight(length); }
  /// Of `radius` [m], by `turn` [rad] in all, of which each of the clothoids takes its part.
  void curve(double radius, double turn, double clothoid) {
    const double side = turned_ > 0.0 || (turned_ == 0.0 && uniform(-1.0, 1.0) < 0.0) ? -1.0 : 1.0;
    const double arc = std::max(1.0, radius * turn - clothoid);
    road_.add_clothoid(clothoid, side / radius).add_arc(arc).add_clothoid(clothoid, 0.0);
    turned_ += side * (arc + clothoid) / radius;
    if (std::abs(turned_) < 1e-6) turned_ = 0.0;
  }
  const RoadShape& road() const { return road_; }

 private:
  std::mt19937_64 engine_;
  RoadShape road_;
  double turned_ = 0.0;  ///< [rad]
};

}  // namespace

Pose2 random_start(std::uint64_t seed) {
  std::mt19937_64 engine = random_engine(seed, 60);
  std::uniform_real_distribution<double> offset(-1000.0, 1000.0), heading(-kPi, kPi);
  const double x = 691000.0 + offset(engine), y = 3118000.0 + offset(engine);
  return {Point2(x, y), heading(engine)};
}

RoadShape motorway_road(std::uint64_t seed, double length) {
  Surveyor surveyor(seed, 61);
  while (surveyor.road().length() < length) {
    surveyor.straight(surveyor.uniform(50.0, 300.0));
    surveyor.curve(surveyor.uniform(600.0, 1500.0), surveyor.uniform(0.25, 0.5), 100.0);
  }
  return surveyor.road();
}

RoadShape country_road(std::uint64_t seed, double length) {
  Surveyor surveyor(seed, 62);
  while (surveyor.road().length() < length) {
    surveyor.straight(surveyor.uniform(10.0, 120.0));
    const double radius = surveyor.uniform(80.0, 300.0);
    surveyor.curve(radius, surveyor.uniform(0.4, 1.2), 0.2 * radius + 15.0);
  }
  return surveyor.road();
}

RoadShape urban_road(std::uint64_t seed, double length) {
  Surveyor surveyor(seed, 63);
  while (surveyor.road().length() < length) {
    surveyor.straight(surveyor.uniform(40.0, 90.0));
    surveyor.curve(surveyor.uniform(12.0, 20.0), 0.5 * kPi, 6.0);
    if (surveyor.uniform(0.0, 1.0) < 0.5) continue;
    surveyor.straight(surveyor.uniform(20.0, 60.0));
    surveyor.curve(surveyor.uniform(40.0, 80.0), 0.4, 12.0);
  }
  return surveyor.road();
}

RoadShape town_road(std::uint64_t seed, double length) {
  Surveyor surveyor(seed, 65);
  while (surveyor.road().length() < length) {
    surveyor.straight(surveyor.uniform(30.0, 120.0));
    surveyor.curve(surveyor.uniform(4.0, 15.0), surveyor.uniform(0.9, 1.9), 3.0);
    if (surveyor.uniform(0.0, 1.0) < 0.4) continue;
    surveyor.straight(surveyor.uniform(20.0, 80.0));
    surveyor.curve(surveyor.uniform(30.0, 90.0), surveyor.uniform(0.2, 0.6), 10.0);
  }
  return surveyor.road();
}

RoadShape long_straights_road(std::uint64_t seed, double length) {
  Surveyor surveyor(seed, 64);
  while (surveyor.road().length() < length) {
    surveyor.straight(surveyor.uniform(150.0, 350.0));
    surveyor.curve(surveyor.uniform(25.0, 60.0), surveyor.uniform(0.6, 1.4), 15.0);
  }
  return surveyor.road();
}

}  // namespace relative_map::core
