#pragma once

#include <map>
#include <string>
#include <vector>

#include "relative_map/doctor/doctor.hpp"

namespace relative_map {

/// Asks the master who publishes and who subscribes, and the publishers for their types: a subscriber would
/// not get a message of another type, nor learn that there is one.
class MasterSurvey {
 public:
  /// Throws std::runtime_error if the master does not answer.
  MasterSurvey();
  /// A topic by its resolved name; `type` is the one that this package gives it.
  doctor::Topic topic(const std::string& name, const std::string& type);

 private:
  using Nodes = std::vector<std::string>;

  /// A node as it answers for itself.
  struct Node {
    std::string uri;
    bool answers = false;
    std::map<std::string, std::string> types;  ///< by topic that it publishes
  };

  const Node& ask(const std::string& node);
  doctor::Publisher publisher(const std::string& node, const std::string& topic);

  std::map<std::string, Nodes> publishers_, subscribers_;  ///< by topic
  std::map<std::string, std::string> types_;               ///< by topic, as the master has them
  std::map<std::string, Node> nodes_;                      ///< those that were asked
};

}  // namespace relative_map
