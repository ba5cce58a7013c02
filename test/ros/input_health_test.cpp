// Whether /diagnostics tells an input that is well from one that starves, is stale, or has never come.
#include "relative_map/ros/health/input_health.hpp"

#include <gmock/gmock.h>

#include "relative_map/ros/health/map_observer.hpp"

namespace relative_map {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using testing::HasSubstr;

InputExpectation localization() {
  return {"/localization", "relative_map/LocalizationEstimate", 10.0, 0.5, true};
}
InputExpectation chassis() {
  return {"/chassis", "relative_map/Chassis", 10.0, 1.0, false};
}

class InputHealthTest : public testing::Test {
 protected:
  InputHealthTest() {
    ros::Time::init();
    ros::Time::setNow(ros::Time(1000.0));
  }
  ~InputHealthTest() override { ros::Time::useSystemTime(); }

  /// Messages at a rate [Hz], so old [s], for so long [s], with a look each second; what the last look says.
  static diagnostic_updater::DiagnosticStatusWrapper after(InputHealth& input, double rate, double seconds,
                                                           double age = 0.02) {
    diagnostic_updater::DiagnosticStatusWrapper status;
    const ros::Time start = ros::Time::now();
    double sent = 0.0;
    for (double t = 0.01; t <= seconds; t += 0.01) {
      ros::Time::setNow(start + ros::Duration(t));
      if (rate > 0.0 && t >= sent / rate) {
        input.note(ros::Time::now() - ros::Duration(age));
        ++sent;
      }
      if (std::fmod(t + 1e-6, 1.0) < 0.01) {
        status = diagnostic_updater::DiagnosticStatusWrapper();
        input.run(status);
      }
    }
    return status;
  }
};

std::string value_of(const DiagnosticStatus& status, const std::string& key) {
  for (const auto& entry : status.values) {
    if (entry.key == key) return entry.value;
  }
  return "(no " + key + ")";
}

TEST_F(InputHealthTest, IsOkAtTheRateThatIsExpectedAndAbove) {
  for (const double rate : {10.0, 20.0, 100.0}) {
    InputHealth input(localization());
    const auto status = after(input, rate, 10.0);
    EXPECT_EQ(status.level, DiagnosticStatus::OK) << rate << ": " << status.message;
    EXPECT_NE(value_of(status, "Actual frequency (Hz)"), "(no Actual frequency (Hz))");
  }
}

TEST_F(InputHealthTest, WarnsOfAnInputThatStarves) {
  for (const double rate : {0.3, 1.0, 5.0, 8.0}) {
    InputHealth input(localization());
    const auto status = after(input, rate, 20.0);
    EXPECT_NE(status.level, DiagnosticStatus::OK) << rate;
    EXPECT_THAT(status.message, HasSubstr("Frequency too low")) << rate;
  }
}

TEST_F(InputHealthTest, IsInErrorWhereANeededInputStopsAndWarnsOfAnother) {
  InputHealth needed(localization()), other(chassis());
  after(needed, 20.0, 5.0);
  EXPECT_EQ(after(needed, 0.0, 10.0).level, DiagnosticStatus::ERROR);
  after(other, 20.0, 5.0);
  EXPECT_EQ(after(other, 0.0, 10.0).level, DiagnosticStatus::WARN);
  EXPECT_EQ(after(needed, 20.0, 10.0).level, DiagnosticStatus::OK) << "it is back";
}

TEST_F(InputHealthTest, TellsStampsThatAreOldOrAhead) {
  for (const double age : {0.8, -0.8}) {
    InputHealth input(localization());
    EXPECT_NE(after(input, 20.0, 5.0, age).level, DiagnosticStatus::OK) << age;
  }
}

TEST_F(InputHealthTest, HasAWordForAnInputThatHasNeverCome) {
  diagnostic_updater::DiagnosticStatusWrapper needed, other;
  InputHealth(localization()).run(needed);
  InputHealth(chassis()).run(other);
  EXPECT_EQ(needed.level, DiagnosticStatus::WARN);
  EXPECT_THAT(needed.message, HasSubstr("no message has come"));
  EXPECT_EQ(value_of(needed, "Events since startup"), "0");
  EXPECT_EQ(other.level, DiagnosticStatus::OK) << "a vehicle may be without it";
}

TEST_F(InputHealthTest, TellsThatItsTopicIsOfAnotherType) {
  InputHealth input(localization());
  EXPECT_FALSE(input.note_published_type(""));
  EXPECT_FALSE(input.note_published_type("relative_map/LocalizationEstimate"));
  EXPECT_TRUE(input.note_published_type("nav_msgs/Odometry"));
  EXPECT_FALSE(input.note_published_type("nav_msgs/Odometry")) << "is told once";
  diagnostic_updater::DiagnosticStatusWrapper status;
  input.run(status);
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_THAT(status.message,
              HasSubstr("/localization is published as nav_msgs/Odometry, not as relative_map/"));
  EXPECT_FALSE(input.note_published_type("relative_map/LocalizationEstimate"));
  EXPECT_EQ(input.fault(), "");
}

TEST_F(InputHealthTest, BeginsAnewWhereTheClockGoesBack) {
  InputHealth input(localization());
  after(input, 20.0, 5.0);
  ros::Time::setNow(ros::Time(100.0));
  input.forget();
  EXPECT_EQ(after(input, 20.0, 5.0).level, DiagnosticStatus::OK);
}

TEST(MapObserverInputs, ThatHaveNotComeHaveAKey) {
  MapObserver observer;
  observer.expect_input("localization");
  observer.expect_input("chassis");
  observer.note_input("chassis", ros::Time(49.9), ros::WallTime(1000.0));
  diagnostic_updater::DiagnosticStatusWrapper status;
  summarize(observer.statistics(ros::Time(50.0), ros::WallTime(1001.0)), status);
  EXPECT_EQ(value_of(status, "localization rate [Hz]"), "0");
  EXPECT_EQ(value_of(status, "localization age [s]"), "none has come");
  EXPECT_EQ(value_of(status, "chassis rate [Hz]"), "1");
}

}  // namespace
}  // namespace relative_map
