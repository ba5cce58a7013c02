#pragma once

#include <relative_map/Chassis.h>
#include <relative_map/LaneMarkers.h>
#include <relative_map/LocalizationEstimate.h>
#include <relative_map/NavigationInfo.h>
#include <ros/time.h>

#include <boost/shared_ptr.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/contract/map_check.hpp"
#include "relative_map/ros/setup/frames.hpp"
#include "relative_map/ros/setup/parameters.hpp"

/// Tells what is wrong with a system around the map node, from what was seen of it for a few seconds.
namespace relative_map::doctor {

/// A node that publishes on a topic, as the master has it.
struct Publisher {
  std::string node;
  std::string uri;      ///< where the master says that it can be asked
  std::string type;     ///< of its messages, e.g. relative_map/Chassis; empty: not known
  bool answers = true;  ///< false: it is registered, but cannot be reached
  std::string md5sum;   ///< of its messages' definition; empty: not known
};

struct Topic {
  std::string name;    ///< resolved
  std::string type;    ///< as this package reads or writes it
  std::string md5sum;  ///< of that type's definition here
  std::vector<Publisher> publishers;
  std::vector<std::string> subscribers;  ///< names of nodes, without the doctor
  std::vector<std::string> elsewhere;    ///< other topics with publishers of this type
};

/// A message and the ROS time at which it came in.
template <class Message>
struct Received {
  ros::Time at;
  boost::shared_ptr<const Message> message;
};

/// What came in on a topic, in that order.
template <class Message>
struct Input {
  Topic topic;
  std::vector<Received<Message>> messages;
};

/// What counts of a published map; maps themselves are large.
struct SeenMap {
  ros::Time at;
  core::Status status;
  std::vector<core::Violation> violations;
};

/// All that is known of the system.
struct Observations {
  std::string node = "/relative_map";  ///< private namespace of the map node
  bool node_has_parameters = false;
  NodeConfig config;
  std::string config_fault;  ///< why the node's parameters are refused; `config` is then the defaults

  bool simulated_time = false;  ///< /use_sim_time
  double listened = 0.0;        ///< [s] by the wall clock
  ros::Time begin, end;         ///< of listening, by ROS time

  /// How many lines the map node says in /diagnostics that it drives on, wherever they came from; none: it
  /// did not say.
  std::optional<std::size_t> lines_in_use;
  Input<NavigationInfo> navigation;
  Input<LocalizationEstimate> localization;
  Input<Chassis> chassis;
  Input<LaneMarkers> lane_markers;
  Topic map_topic;
  std::vector<SeenMap> maps;
  LinkTransforms transforms;  ///< must be set
};

enum class Severity {
  kOk,
  kNote,  ///< may be meant that way
  kWrong
};

struct Finding {
  Severity severity = Severity::kOk;
  std::string what;  ///< one plain sentence with numbers and names of topics and fields
  std::string mend;  ///< what to do about it; empty where all is well
  std::string rule;  ///< the name of the rule that found it
};

/// The findings of all rules, from causes to consequences. A rule that has nothing to go on says nothing.
std::vector<Finding> diagnose(const Observations& seen);

/// The names of all rules, in the order in which they are looked at.
std::vector<std::string> rule_names();

/// "ok: ...", "note: ... -> ..." or "WRONG: ... -> mend: ...".
std::string to_line(const Finding& finding);

}  // namespace relative_map::doctor
