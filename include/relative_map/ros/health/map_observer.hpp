#pragma once

#include <ros/time.h>

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "relative_map/pipeline/lines/navigation_lines.hpp"
#include "relative_map/ros/health/diagnostics.hpp"

namespace relative_map {

/// Watches inputs and maps go by, for /diagnostics. A fault counts only once it has lasted: one bad frame is
/// no alarm.
class MapObserver {
 public:
  /// An input that has a place in the statistics before its first message comes.
  void expect_input(const std::string& topic) { inputs_[topic]; }
  void note_input(const std::string& topic, const ros::Time& stamp, const ros::WallTime& arrival);
  /// `tick_time` [s] is what the map took to make and publish.
  void note_map(const core::RelativeMap& map, double tick_time, const ros::WallTime& now);
  void note_lines(const core::NavigationLines& lines);
  /// ROS time as it goes by, or does not.
  void note_clock(const ros::Time& now, const ros::WallTime& wall_now);
  /// Rates and ages are those at the time of the call.
  MapStatistics statistics(const ros::Time& now, const ros::WallTime& wall_now) const;

 private:
  struct Input {
    ros::Time stamp;  ///< of the newest message
    std::deque<ros::WallTime> arrivals;
  };

  struct Look {
    ros::WallTime at;
    bool filled;
  };

  void settle_status(const core::Status& status, const ros::WallTime& now);
  void count_drop_outs(const ros::WallTime& wall_now, MapStatistics& result) const;

  MapStatistics statistics_;
  std::map<std::string, Input> inputs_;
  std::deque<Look> recent_;                     ///< maps
  ros::WallTime remarked_;                      ///< the last time that there was a remark
  std::optional<ros::WallTime> differs_since_;  ///< the status from the settled one
  ros::Time clock_;
  std::optional<ros::WallTime> clock_since_;  ///< it has been at `clock_`
};

}  // namespace relative_map
