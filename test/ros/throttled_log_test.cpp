#include "relative_map/ros/health/throttled_log.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace relative_map
