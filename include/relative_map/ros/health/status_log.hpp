#pragma once

#include <ros/time.h>

#include <string>
#include <vector>

#include "relative_map/model/map.hpp"
#include "relative_map/ros/health/throttled_log.hpp"

namespace relative_map {

/// What the log says of the maps as they come: why there is none, that it is back, and remarks on the inputs.
/// Each kind is told once in a while, so that a map that comes and goes by turns does not fill the log.
class StatusLog {
 public:
  struct Line {
    bool is_warning;
    std::string text;
  };
  std::vector<Line> lines(const core::RelativeMap& map, const std::vector<std::string>& remarks,
                          const ros::WallTime& now);

 private:
  ThrottledLog kinds_;
  bool told_of_none_ = false;  ///< the newest line of the two is that there is no map
};

}  // namespace relative_map
