#include "relative_map/ros/health/diagnostics.hpp"

#include <gmock/gmock.h>
#include <relative_map/FusionState.h>
#include <relative_map/MapStatus.h>

#include <set>

#include "relative_map/ros/health/map_observer.hpp"

namespace relative_map {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using testing::HasSubstr;

diagnostic_updater::DiagnosticStatusWrapper summary_of(const MapStatistics& statistics) {
  diagnostic_updater::DiagnosticStatusWrapper status;
  summarize(statistics, status);
  return status;
}

MapStatistics statistics_of(core::StatusCode code, const std::string& message = "") {
  MapStatistics statistics;
  statistics.maps = 1;
  statistics.last_map.status = {code, message};
  return statistics;
}

std::string value_of(const DiagnosticStatus& status, const std::string& key) {
  for (const auto& entry : status.values) {
    if (entry.key == key) return entry.value;
  }
  return "(no " + key + ")";
}

TEST(Diagnostics, WarnUntilThereIsAMap) {
  const auto status = summary_of({});
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "no map published yet");
}

TEST(Diagnostics, AreOkWithAMap) {
  MapStatistics statistics = statistics_of(core::StatusCode::kOk);
  statistics.lanes = 3;
  statistics.last_map.fusion.source = core::Source::kFused;
  const auto status = summary_of(statistics);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(status.message, "3 lanes from FUSED");
}

TEST(Diagnostics, WarnOfWhatEveryDrivePassesThrough) {
  for (const auto code :
       {core::StatusCode::kNoLocalization, core::StatusCode::kNoNavigationLine, core::StatusCode::kLineEnd}) {
    EXPECT_EQ(summary_of(statistics_of(code)).level, DiagnosticStatus::WARN) << status_name(code);
  }
}

TEST(Diagnostics, AreInErrorOtherwise) {
  for (const auto code :
       {core::StatusCode::kStaleLocalization, core::StatusCode::kInvalidLocalization,
        core::StatusCode::kOffRoute, core::StatusCode::kMarkersUnusable, core::StatusCode::kFrameMismatch,
        core::StatusCode::kNoTransform, core::StatusCode::kContractViolation}) {
    EXPECT_EQ(summary_of(statistics_of(code)).level, DiagnosticStatus::ERROR) << status_name(code);
  }
}

TEST(Diagnostics, NameTheReason) {
  EXPECT_EQ(summary_of(statistics_of(core::StatusCode::kOffRoute, "far away")).message,
            "OFF_ROUTE: far away");
}

/// Maps of `pattern`, one each tenth of a second: '+' is filled, anything else is empty.
MapStatistics after_maps(const std::string& pattern, double wait = 0.0) {
  MapObserver observer;
  ros::WallTime now(1000.0);
  for (const char map_is : pattern) {
    core::RelativeMap map;
    if (map_is == '+') {
      map.lanes.emplace_back().id = "lane";
    } else {
      map.status = {core::StatusCode::kOffRoute, "far away"};
    }
    now += ros::WallDuration(0.1);
    observer.note_map(map, 0.001, now);
  }
  return observer.statistics(ros::Time(50.0), now + ros::WallDuration(wait));
}

TEST(Diagnostics, WarnOfAMapThatComesAndGoes) {
  for (const char* pattern :
       {"+-+-+-+-", "-+-+-+-+", "+++---+++---+++---+++", "+-++++++++++++++-+++++++++++++-+++++",
        "++++++---+++++++++++++++---++++++++"}) {
    const auto status = summary_of(after_maps(pattern));
    EXPECT_NE(status.level, DiagnosticStatus::OK) << pattern;
    EXPECT_THAT(status.message, HasSubstr("OFF_ROUTE: far away")) << pattern;
  }
  EXPECT_THAT(summary_of(after_maps("+-+-+-+")).message,
              HasSubstr("the map comes and goes: 3 drop-outs in 10 s, the last one for OFF_ROUTE"));
  EXPECT_EQ(value_of(summary_of(after_maps("+-+-+-+--+")), "empty maps in 10 s [%]"), "50");
}

TEST(Diagnostics, AreOkWhereTheMapWasGoneForAFrameOrTwo) {
  for (const char* pattern :
       {"++++-+++++", "----------++++++++", "+++++++++++++-++++++++++++++-+++++++++++++"}) {
    EXPECT_EQ(summary_of(after_maps(pattern)).level, DiagnosticStatus::OK) << pattern;
  }
  EXPECT_EQ(summary_of(after_maps("+-+-+-+", 10.5)).level, DiagnosticStatus::OK) << "long ago";
}

TEST(Diagnostics, TellWhatWasWrongWithTheLines) {
  core::NavigationLines lines;
  lines.lines.resize(2);
  lines.faults = {"line 'a' is left out", "line 'b' turns back", "3", "4", "5", "6"};
  MapObserver observer;
  observer.note_lines(lines);
  const auto status = summary_of(observer.statistics(ros::Time(50.0), ros::WallTime(1000.0)));
  EXPECT_EQ(value_of(status, "navigation lines"), "2");
  EXPECT_EQ(value_of(status, "navigation faults"), "line 'a' is left out; line 'b' turns back; 3; 4; 5");
}

TEST(Diagnostics, ShowRemarksForAWhile) {
  MapObserver observer;
  core::RelativeMap map;
  map.lanes.emplace_back().id = "lane";
  map.status.message = "chassis: speed_mps is 1000: ignored";
  const ros::WallTime start(1000.0);
  observer.note_map(map, 0.001, start);
  map.status.message.clear();
  observer.note_map(map, 0.001, start + ros::WallDuration(0.1));
  const auto remarks = [&](double seconds) {
    return value_of(summary_of(observer.statistics(ros::Time(50.0), start + ros::WallDuration(seconds))),
                    "remarks");
  };
  EXPECT_EQ(remarks(1.0), "chassis: speed_mps is 1000: ignored");
  EXPECT_EQ(remarks(3.0), "");
}

TEST(Diagnostics, WarnOfAClockThatStandsStill) {
  core::RelativeMap map;
  map.lanes.emplace_back().id = "lane";
  MapObserver observer;
  const ros::WallTime start(1000.0);
  observer.note_map(map, 0.001, start);
  const auto after = [&](double seconds, const ros::Time& clock) {
    const ros::WallTime wall_now = start + ros::WallDuration(seconds);
    observer.note_clock(clock, wall_now);
    return summary_of(observer.statistics(clock, wall_now));
  };
  const ros::Time stopped(50.0);
  EXPECT_EQ(after(0.0, stopped).level, DiagnosticStatus::OK);
  EXPECT_EQ(after(1.0, stopped).level, DiagnosticStatus::OK)
      << "one look that sees no other time is no alarm";
  for (const double seconds : {3.0, 4.0}) {
    const auto status = after(seconds, stopped);
    EXPECT_EQ(status.level, DiagnosticStatus::WARN);
    EXPECT_THAT(status.message,
                HasSubstr("the clock stands still, since " + std::to_string(int(seconds)) + " s"));
  }
  EXPECT_EQ(after(5.0, ros::Time(50.1)).level, DiagnosticStatus::OK) << "it runs again";
  EXPECT_EQ(after(6.0, ros::Time(10.0)).level, DiagnosticStatus::OK)
      << "a bag that starts again moves it, too";
}

TEST(Diagnostics, WarnOfAClockThatHasNeverCome) {
  MapObserver observer;
  observer.note_clock(ros::Time(), ros::WallTime(1000.0));
  EXPECT_THAT(summary_of(observer.statistics(ros::Time(), ros::WallTime(1005.0))).message,
              HasSubstr("the clock stands still"));
}

TEST(Diagnostics, TellTheNumbersBehindIt) {
  MapStatistics statistics = statistics_of(core::StatusCode::kOk);
  statistics.maps = 12;
  statistics.lanes = 3;
  statistics.lateral_offset = -0.25;
  statistics.remaining_distance = 410.5;
  statistics.tick_time = 0.0015;
  statistics.last_map.current_lane_id = "middle";
  statistics.last_map.fusion.source = core::Source::kNavigationLine;
  statistics.last_map.fusion.marker_range = 35.5;
  statistics.last_map.fusion.marker_age = 0.125;
  statistics.empty_maps = {{"OFF_ROUTE", 4}, {"STALE_LOCALIZATION", 2}};
  const auto status = summary_of(statistics);
  EXPECT_EQ(value_of(status, "source"), "NAVIGATION_LINE");
  EXPECT_EQ(value_of(status, "current lane"), "middle");
  EXPECT_EQ(value_of(status, "lateral offset [m]"), "-0.25");
  EXPECT_EQ(value_of(status, "remaining distance [m]"), "410.5");
  EXPECT_EQ(value_of(status, "marker range [m]"), "35.5");
  EXPECT_EQ(value_of(status, "marker age [s]"), "0.125");
  EXPECT_EQ(value_of(status, "tick time [ms]"), "1.5");
  EXPECT_EQ(value_of(status, "maps"), "12");
  EXPECT_EQ(value_of(status, "empty maps, OFF_ROUTE"), "4");
  EXPECT_EQ(value_of(status, "empty maps, STALE_LOCALIZATION"), "2");
}

TEST(Diagnostics, NamesAreThoseOfTheMessages) {
  const auto name = [](uint8_t code) { return status_name(static_cast<core::StatusCode>(code)); };
  EXPECT_EQ(name(MapStatus::OK), "OK");
  EXPECT_EQ(name(MapStatus::NO_LOCALIZATION), "NO_LOCALIZATION");
  EXPECT_EQ(name(MapStatus::STALE_LOCALIZATION), "STALE_LOCALIZATION");
  EXPECT_EQ(name(MapStatus::INVALID_LOCALIZATION), "INVALID_LOCALIZATION");
  EXPECT_EQ(name(MapStatus::NO_NAVIGATION_LINE), "NO_NAVIGATION_LINE");
  EXPECT_EQ(name(MapStatus::OFF_ROUTE), "OFF_ROUTE");
  EXPECT_EQ(name(MapStatus::LINE_END), "LINE_END");
  EXPECT_EQ(name(MapStatus::MARKERS_UNUSABLE), "MARKERS_UNUSABLE");
  EXPECT_EQ(name(MapStatus::FRAME_MISMATCH), "FRAME_MISMATCH");
  EXPECT_EQ(name(MapStatus::NO_TRANSFORM), "NO_TRANSFORM");
  EXPECT_EQ(name(MapStatus::CONTRACT_VIOLATION), "CONTRACT_VIOLATION");
  const auto source = [](uint8_t number) { return source_name(static_cast<core::Source>(number)); };
  EXPECT_EQ(source(FusionState::NONE), "NONE");
  EXPECT_EQ(source(FusionState::FUSED), "FUSED");
  EXPECT_EQ(source(FusionState::NAVIGATION_LINE), "NAVIGATION_LINE");
  EXPECT_EQ(source(FusionState::LANE_MARKERS), "LANE_MARKERS");
}

TEST(Diagnostics, NumbersOfNoNameAreUnknown) {
  EXPECT_EQ(status_name(static_cast<core::StatusCode>(200)), "UNKNOWN");
  EXPECT_EQ(source_name(static_cast<core::Source>(200)), "UNKNOWN");
}

}  // namespace
}  // namespace relative_map
