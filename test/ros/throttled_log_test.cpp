#include "relative_map/ros/health/throttled_log.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "relative_map/ros/health/status_log.hpp"

namespace relative_map {
namespace {

const ros::WallTime kStart(1000.0);

TEST(ThrottledLog, LetsAComplaintThroughOnceInTenSeconds) {
  ThrottledLog log;
  EXPECT_TRUE(log.due("chassis: speed_mps is 1000: ignored", kStart));
  EXPECT_FALSE(log.due("chassis: speed_mps is 1000: ignored", kStart + ros::WallDuration(9.9)));
  EXPECT_TRUE(log.due("chassis: speed_mps is 1000: ignored", kStart + ros::WallDuration(10.1)));
}

TEST(ThrottledLog, TakesWhatDiffersInItsNumbersForOne) {
  for (const char* number : {"5", "-5", "0.25", "-12.5", "1e+30", "-1e-09", "nan", "-nan", "inf", "-inf"}) {
    ThrottledLog log;
    EXPECT_TRUE(log.due("y is 1000 m: ignored", kStart));
    EXPECT_FALSE(log.due("y is " + std::string(number) + " m: ignored", kStart)) << number;
  }
}

TEST(ThrottledLog, KeepsWordsApart) {
  ThrottledLog log;
  for (const char* complaint :
       {"left is 5", "right is 5", "line 'info'", "line 'o'", "nanny", "ny", "", "minus -", "e+5"}) {
    EXPECT_TRUE(log.due(complaint, kStart)) << complaint;
  }
}

TEST(ThrottledLog, IsNotFloodedByComplaintsThatAlwaysDiffer) {
  ThrottledLog log;
  std::size_t told = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::string scrap(1, static_cast<char>('a' + i % 26));
    const std::string other(1, static_cast<char>('a' + i / 26 % 26));
    told += log.due("frame '" + scrap + other + "' is not known", kStart + ros::WallDuration(0.01 * i));
  }
  EXPECT_GE(told, 10u);
  EXPECT_LE(told, 60u);
}

core::RelativeMap map_with(core::StatusCode code, const std::string& message = "") {
  core::RelativeMap map;
  map.status = {code, message};
  if (code == core::StatusCode::kOk) map.lanes.resize(3);
  return map;
}

/// By turns at 10 Hz, for so long [s]: how many lines the log gets.
std::size_t lines_of_flapping(double seconds) {
  StatusLog log;
  std::size_t lines = 0;
  for (int i = 0; i < std::lround(10.0 * seconds); ++i) {
    const bool there = i % 2 == 0;
    const auto map =
        there ? map_with(core::StatusCode::kOk)
              : map_with(core::StatusCode::kStaleLocalization,
                         "the newest localization is " + std::to_string(0.5 + 0.01 * i) + " s old");
    lines += log.lines(map, {}, kStart + ros::WallDuration(0.1 * i)).size();
  }
  return lines;
}

TEST(StatusLog, IsNotFilledByAMapThatComesAndGoes) {
  EXPECT_LE(lines_of_flapping(9.0), 2u);
  EXPECT_LE(lines_of_flapping(60.0), 14u);
  EXPECT_GE(lines_of_flapping(60.0), 6u) << "but it is told";
}

TEST(StatusLog, EndsWithWhatIsTheCase) {
  StatusLog log;
  ros::WallTime now = kStart;
  const auto look = [&](core::StatusCode code) {
    std::string text;
    for (const StatusLog::Line& line : log.lines(map_with(code, "why"), {}, now)) text += line.text;
    now += ros::WallDuration(0.1);
    return text;
  };
  EXPECT_EQ(look(core::StatusCode::kOk), "");
  EXPECT_EQ(look(core::StatusCode::kOffRoute), "no map: OFF_ROUTE: why");
  EXPECT_EQ(look(core::StatusCode::kOk), "the map is back: 3 lanes");
  EXPECT_EQ(look(core::StatusCode::kLineEnd), "no map: LINE_END: why") << "another kind is told at once";
  std::string back;
  for (int i = 0; i < 120; ++i) back += look(core::StatusCode::kOk);
  EXPECT_EQ(back, "the map is back: 3 lanes") << "late, and once";
}

TEST(StatusLog, TellsRemarksOnce) {
  StatusLog log;
  std::size_t lines = 0;
  for (int i = 0; i < 50; ++i) {
    lines += log.lines(map_with(core::StatusCode::kOk),
                       {"chassis: speed_mps is " + std::to_string(1000 + i) + ": ignored"},
                       kStart + ros::WallDuration(0.1 * i))
                 .size();
  }
  EXPECT_EQ(lines, 1u);
}

}  // namespace
}  // namespace relative_map
