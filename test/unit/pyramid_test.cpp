// Intensity and altitude in cells: their merging, and matching in a simulated street.
#include <gmock/gmock.h>

#include <random>

#include "relative_map/localization/clouds/cloud_filters.hpp"
#include "relative_map/localization/pyramid/pyramid_matcher.hpp"
#include "relative_map/simulation/lidar_world.hpp"
#include "support/lidar_rooms.hpp"

namespace relative_map::core {
namespace {

using test::pose;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(PyramidMapTest, LevelsHaveTheMomentsOfAllTheirPoints) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-3.0, 3.0);
  PointCloud cloud;
  for (int i = 0; i < 3000; ++i) {
    cloud.points.emplace_back(2.0 * unit(random), unit(random), 0.1 * unit(random));  // wider than long
    cloud.intensity.push_back(10.0 + unit(random));
  }
  PyramidMap map(0.125, Eigen::Vector2d(0.3, -0.7));
  map.add(cloud);
  map.finish();
  for (int level = 0; level < PyramidMap::kLevels; ++level) {
    const double size = 0.125 * (1 << level);
    EXPECT_EQ(map.level(level).cell_size(), size);
    double count = 0.0;
    for (std::size_t i = 0; i < map.level(level).cells().size(); ++i) {
      const PyramidCell& cell = map.level(level).cells()[i];
      Moments intensity, altitude;
      for (std::size_t k = 0; k < cloud.size(); ++k) {
        const Eigen::Vector2d at = ((cloud.points[k].head<2>() - map.origin()) / size).array().floor();
        if (at.cast<std::int64_t>() != map.level(level).place(i)) continue;
        intensity.add(cloud.intensity[k]);
        altitude.add(cloud.points[k].z());
      }
      ASSERT_EQ(cell.intensity.count, intensity.count);
      ASSERT_NEAR(cell.intensity.mean, intensity.mean, 1e-9);
      ASSERT_NEAR(cell.intensity.variance(), intensity.variance(), 1e-9);
      ASSERT_NEAR(cell.altitude.mean, altitude.mean, 1e-9);
      count += cell.altitude.count;
    }
    EXPECT_EQ(count, 3000.0);
  }
}

TEST(PyramidMapTest, ACellWithoutGroundTakesNoneFromItsMerging) {
  PyramidCell wall, ground;
  wall.altitude.add(3.0);
  ground.altitude.add(0.1);
  ground.ground.add(0.1);
  wall.add(ground);
  EXPECT_EQ(wall.ground.count, 1.0);
  EXPECT_EQ(wall.ground.mean, 0.1);
  PyramidCell nothing;
  nothing.add(PyramidCell());
  EXPECT_EQ(nothing.ground.count, 0.0);
  EXPECT_EQ(nothing.ground.mean, 0.0) << "no 0 / 0";
}

TEST(HistogramFilterTest, BeliefMovesBlursAndKeepsItsSum) {
  ShiftHistogram seen;
  seen.reach = 8;
  seen.cell_size = 0.125;
  seen.centre = Eigen::Vector2d(10.0, 20.0);
  seen.p.assign(17 * 17, 0.0);
  seen.at(0, 0) = 1.0;
  HistogramFilter filter;
  EXPECT_EQ(filter.belief(), nullptr);
  filter.predict(Eigen::Vector2d(1.0, 0.0), 0.1);
  filter.update(seen);
  filter.predict(Eigen::Vector2d(1.0, -0.5), 0.2);
  const ShiftHistogram& belief = *filter.belief();
  EXPECT_EQ(belief.centre, Eigen::Vector2d(11.0, 19.5));
  double sum = 0.0, spread = 0.0;
  for (int y = -8; y <= 8; ++y) {
    for (int x = -8; x <= 8; ++x) {
      sum += belief.at(x, y);
      spread += belief.at(x, y) * x * x * 0.125 * 0.125;
    }
  }
  EXPECT_NEAR(sum, 1.0, 0.01);
  EXPECT_NEAR(std::sqrt(spread), 0.2, 0.03);
  EXPECT_NEAR(belief.at(Eigen::Vector2d(11.0625, 19.5)), 0.5 * (belief.at(0, 0) + belief.at(1, 0)), 1e-12);
}

/// The lidar's pose in the street, `along` it and `across`.
Eigen::Isometry3d on_the_street(double along, double across, double yaw) {
  return pose(along, across, 1.8, 0.0, 0.0, yaw);
}

/// A street of 60 m, mapped in three passes beside each other.
class StreetTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::mt19937 random(2);
    world_ = new LidarWorld(street(60.0, 1));
    map_ = new PyramidMap(0.125, Eigen::Vector2d(-100.0, -100.0));
    for (const double across : {-1.8, -0.4, 1.5}) {
      for (double x = -5.0 + across; x < 65.0; x += 1.0) {
        const Eigen::Isometry3d at = on_the_street(x, across, 0.0);
        map_->add(transformed(look(*world_, LidarSensor(), at, random), at));
      }
    }
    map_->finish();
  }
  static void TearDownTestSuite() {
    delete world_;
    delete map_;
  }

  struct Errors {
    double lateral = 0.0, along = 0.0, yaw = 0.0;  ///< RMS [m], [m], [rad]
    int believed = 0, scans = 0, beyond = 0;       ///< beyond: more than three standard deviations off
  };
  /// Another drive, along a line that no pass has taken; the guess is off by up to 0.6 m and 1 degree.
  Errors drive(PyramidWeighing weighing) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    PyramidParam param;
    param.weighing = weighing;
    Errors errors;
    for (double x = 2.0; x < 58.0; x += 9.1) {
      const Eigen::Isometry3d truth =
          on_the_street(x, 0.6 + 0.3 * std::sin(0.1 * x), 0.02 * std::cos(0.1 * x));
      const PointCloud scan = look(*world_, LidarSensor(), truth, random);
      Eigen::Isometry3d guess =
          on_the_street(x + 0.6 * unit(random), truth.translation().y() + 0.6 * unit(random),
                        0.02 * std::cos(0.1 * x) + 0.0175 * unit(random));
      guess.translation().z() += 0.2 * unit(random);
      const PyramidMatch match = match_pyramid(*map_, scan, guess, param);
      const Eigen::Vector3d off = match.map_from_body.translation() - truth.translation();
      const double yaw =
          Eigen::AngleAxisd(Eigen::Matrix3d(truth.linear().transpose() * match.map_from_body.linear()))
              .angle();
      ++errors.scans;
      errors.believed += match.believed ? 1 : 0;
      errors.along += off.x() * off.x();
      errors.lateral += off.y() * off.y();
      errors.yaw += yaw * yaw;
      for (int i = 0; i < 3; ++i)
        errors.beyond += std::abs(off[i]) > 3.0 * std::sqrt(match.covariance(i, i)) ? 1 : 0;
      if (!match.believed) ADD_FAILURE() << x << testing::PrintToString(match.reasons);
    }
    errors.along = std::sqrt(errors.along / errors.scans);
    errors.lateral = std::sqrt(errors.lateral / errors.scans);
    errors.yaw = std::sqrt(errors.yaw / errors.scans);
    std::cout << "lateral " << errors.lateral << " m, along " << errors.along << " m, yaw " << errors.yaw
              << " rad RMS of " << errors.scans << "\n";
    return errors;
  }
  void expect_aim(PyramidWeighing weighing) {
    const Errors errors = drive(weighing);
    EXPECT_LT(errors.lateral, 0.05);
    EXPECT_LT(errors.along, 0.10);
    EXPECT_LT(errors.yaw, 0.005);
    EXPECT_EQ(errors.believed, errors.scans);
    EXPECT_LE(errors.beyond, 1);
  }

  static LidarWorld* world_;
  static PyramidMap* map_;
};
LidarWorld* StreetTest::world_ = nullptr;
PyramidMap* StreetTest::map_ = nullptr;

TEST_F(StreetTest, FusionMeetsTheAim) {
  expect_aim(PyramidWeighing::kFusion);
}

TEST_F(StreetTest, IntensityAloneMeetsIt) {
  expect_aim(PyramidWeighing::kIntensity);
}

TEST_F(StreetTest, AnotherPlaceIsNotBelieved) {
  std::mt19937 random(3);
  for (const unsigned seed : {5u, 6u}) {
    const LidarWorld other = street(60.0, seed);
    for (const double x : {20.0, 40.0}) {
      const PointCloud scan = look(other, LidarSensor(), on_the_street(x, 0.5, 0.0), random);
      const PyramidMatch match = match_pyramid(*map_, scan, on_the_street(x, 0.5, 0.0), PyramidParam());
      EXPECT_FALSE(match.believed) << match.score << " " << match.coverage << " " << match.upright_share;
    }
  }
}

TEST_F(StreetTest, NothingIsSaid) {
  PyramidMap empty(0.125, Eigen::Vector2d::Zero());
  empty.finish();
  std::mt19937 random(3);
  const Eigen::Isometry3d at = on_the_street(10.0, 0.0, 0.0);
  const PointCloud scan = look(*world_, LidarSensor(), at, random);
  EXPECT_THAT(match_pyramid(empty, scan, at, PyramidParam()).reasons,
              ElementsAre("the target has no points"));
  EXPECT_THAT(match_pyramid(*map_, PointCloud(), at, PyramidParam()).reasons,
              ElementsAre("the source has no points"));
  const PyramidMatch far = match_pyramid(*map_, scan, on_the_street(1000.0, 0.0, 0.0), PyramidParam());
  EXPECT_FALSE(far.believed);
  EXPECT_THAT(far.reasons, testing::Contains(HasSubstr("knows only 0 %")));
}

}  // namespace
}  // namespace relative_map::core
