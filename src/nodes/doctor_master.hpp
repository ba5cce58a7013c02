#pragma once

#include <map>
#include <string>
#include <vector>

#include "relative_map/ros/doctor.hpp"

namespace relative_map {

/// Asks the master who publishes and who subscribes, and the publishers for their types: a subscriber would
/// not get a message of another type, nor learn that there is one.
class MasterSurvey {
 public:
  /// Throws std::runtime_error if the master does not answer.
  MasterSurvey();
  /// A topic by its resolved name; `type` is the one that this package gives it.
  doctor::Topic topic(const std::string& name, const std::string& type) const;

 private:
  using Nodes = std::vector<std::string>;

  doctor::Publisher publisher(const std::string& node, const std::string& topic) const;

  std::map<std::string, Nodes> publishers_, subscribers_;  ///< by topic
  std::map<std::string, std::string> types_;               ///< by topic, as the master has them
};

}  // namespace relative_map
