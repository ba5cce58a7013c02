#pragma once

#include <ros/time.h>

#include <map>
#include <string>

namespace relative_map {

/// Lets each complaint through once in a while. Complaints that differ in their numbers only are one.
class ThrottledLog {
 public:
  bool due(const std::string& complaint, const ros::WallTime& now);

 private:
  ros::WallTime period_start_;
  std::size_t told_in_period_ = 0;
  std::map<std::string, ros::WallTime> last_;
};

}  // namespace relative_map
