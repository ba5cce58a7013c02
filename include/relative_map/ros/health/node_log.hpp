#pragma once

#include <ros/console.h>

#include <string>
#include <utility>

namespace relative_map {

/// Log lines that begin with the name of the node: in the log of a manager, those of several vehicles stand
/// side by side.
class NodeLog {
 public:
  explicit NodeLog(std::string name) : name_(std::move(name)) {}

  void info(const std::string& line) const { ROS_INFO_STREAM(name_ << ": " << line); }
  void warn(const std::string& line) const { ROS_WARN_STREAM(name_ << ": " << line); }
  void error(const std::string& line) const { ROS_ERROR_STREAM(name_ << ": " << line); }

 private:
  std::string name_;
};

}  // namespace relative_map
