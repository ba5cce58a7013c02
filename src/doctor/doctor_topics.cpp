#include <algorithm>
#include <map>

#include "doctor_rules.hpp"

// Who publishes what, and who listens.
namespace relative_map::doctor {

namespace {

/// A topic with how much hangs on it.
struct Role {
  const Topic& topic;
  std::size_t received;
  bool needed;
  const char* purpose;
};

/// Lines may come by the parameter or the service too.
bool has_lines_of_files(const Observations& seen) {
  return seen.lines_in_use.value_or(0) > 0 && seen.navigation.messages.empty();
}

std::vector<Role> roles(const Observations& seen) {
  const bool lines = seen.config.pipeline.navigation_lane.lane_source == core::LaneSource::kOfflineGenerated;
  const bool message_needed = lines && !has_lines_of_files(seen);
  return {
      {seen.navigation.topic, seen.navigation.messages.size(), message_needed, "the lines to drive on"},
      {seen.localization.topic, seen.localization.messages.size(), true, "the pose of the vehicle"},
      {seen.chassis.topic, seen.chassis.messages.size(), false, "speed and gear"},
      {seen.lane_markers.topic, seen.lane_markers.messages.size(), !lines, "the paint that a camera sees"}};
}

std::vector<const Topic*> all_topics(const Observations& seen) {
  return {&seen.navigation.topic, &seen.localization.topic, &seen.chassis.topic, &seen.lane_markers.topic,
          &seen.map_topic};
}

/// The topic's name without its namespace, as it stands on the left of a remapping.
std::string relative_name(const Topic& topic) {
  const std::string markers = "perception/lane_markers";
  const bool is_markers = topic.type == "relative_map/LaneMarkers";
  if (is_markers) return markers;
  if (topic.type == "relative_map/NavigationInfo") return "navigation";
  if (topic.type == "relative_map/Chassis") return "chassis";
  return topic.type == "relative_map/MapMsg" ? "relative_map" : "localization";
}

std::string remap_hint(const Topic& topic) {
  if (topic.elsewhere.empty()) return "";
  return "; " + some(topic.elsewhere) + " carries this type: if that is meant, remap " +
         relative_name(topic) + ":=" + topic.elsewhere.front() + " for the map node and for the doctor";
}

std::vector<std::string> nodes_of(const Topic& topic) {
  std::vector<std::string> nodes;
  for (const Publisher& publisher : topic.publishers) nodes.push_back(publisher.node);
  return nodes;
}

bool has_type(const Publisher& publisher, const Topic& topic) {
  return publisher.type.empty() || publisher.type == "*" || publisher.type == topic.type;
}

/// Of the same name, but not of the same fields.
bool has_other_definition(const Publisher& publisher, const Topic& topic) {
  return has_type(publisher, topic) && !publisher.md5sum.empty() && publisher.md5sum != topic.md5sum;
}

Finding map_node_missing(const Topic& topic) {
  return wrong(
      "nobody publishes " + topic.name + ": the map node does not run",
      "roslaunch relative_map relative_map.launch; if it runs no longer, its log says why (it refuses "
      "a bad configuration)" +
          remap_hint(topic));
}

}  // namespace

Findings topics_have_publishers(const Evidence& evidence) {
  Findings findings;
  for (const Role& role : roles(evidence.seen)) {
    if (!role.topic.publishers.empty()) continue;
    if (&role.topic == &evidence.seen.navigation.topic && has_lines_of_files(evidence.seen)) {
      findings.push_back(ok(text("the map node drives on ", *evidence.seen.lines_in_use,
                                 " lines from files (its parameter, or the service)")));
      continue;
    }
    const std::string what = "nobody publishes " + role.topic.name + " (" + role.purpose + ")";
    const std::string mend = "start the node that publishes " + role.topic.type + remap_hint(role.topic);
    findings.push_back(role.needed ? wrong(what, mend)
                                   : note(what, "well if the vehicle has none, else " + mend));
  }
  if (evidence.seen.map_topic.publishers.empty()) {
    findings.push_back(map_node_missing(evidence.seen.map_topic));
  }
  return findings;
}

Findings publishers_answer(const Evidence& evidence) {
  std::map<std::string, std::vector<std::string>> topics;  // by node
  std::map<std::string, std::string> uris;
  for (const Topic* topic : all_topics(evidence.seen)) {
    for (const Publisher& publisher : topic->publishers) {
      if (publisher.answers) continue;
      topics[publisher.node].push_back(topic->name);
      uris[publisher.node] = publisher.uri.empty() ? "any address" : publisher.uri;
    }
  }
  Findings findings;
  for (const auto& [node, names] : topics) {
    findings.push_back(wrong(
        node + " is registered as publisher of " + list(names) + ", but does not answer at " + uris[node],
        "if it was killed or hangs, start it again (rosnode cleanup forgets it); if it runs on another "
        "machine, set ROS_IP there to an address that can be reached from here"));
  }
  return findings;
}

Findings types_are_right(const Evidence& evidence) {
  Findings findings;
  for (const Topic* topic : all_topics(evidence.seen)) {
    for (const Publisher& publisher : topic->publishers) {
      if (has_type(publisher, *topic)) continue;
      findings.push_back(wrong(
          publisher.node + " publishes " + topic->name + " as " + publisher.type + ", not as " + topic->type,
          "convert it to " + topic->type + ", or remap the other topic away" + remap_hint(*topic)));
    }
  }
  return findings;
}

Findings definitions_are_the_same(const Evidence& evidence) {
  Findings findings;
  for (const Topic* topic : all_topics(evidence.seen)) {
    for (const Publisher& publisher : topic->publishers) {
      if (!has_other_definition(publisher, *topic)) continue;
      findings.push_back(wrong(
          publisher.node + " publishes " + topic->name + " with another definition of " + topic->type +
              " (md5sum " + publisher.md5sum + ", here " + topic->md5sum +
              "), so that none of its messages arrives",
          "build " + publisher.node +
              " and this package from the same messages, and start it again (rosmsg md5 " + topic->type +
              " tells what each side has); a bag that was recorded before: rosbag migrate"));
    }
  }
  return findings;
}

Findings topics_have_one_publisher(const Evidence& evidence) {
  Findings findings;
  for (const Topic* topic : all_topics(evidence.seen)) {
    if (topic->publishers.size() < 2) continue;
    findings.push_back(wrong(std::to_string(topic->publishers.size()) + " nodes publish " + topic->name +
                                 ": " + list(nodes_of(*topic)),
                             "stop all but one of them, or give the others a topic of their own: their "
                             "messages are taken for those of one source"));
  }
  return findings;
}

Findings map_node_listens(const Evidence& evidence) {
  const std::vector<std::string> map_nodes = nodes_of(evidence.seen.map_topic);
  if (map_nodes.empty()) return {};
  Findings findings;
  for (const Role& role : roles(evidence.seen)) {
    const std::vector<std::string>& listeners = role.topic.subscribers;
    const bool listens = std::any_of(map_nodes.begin(), map_nodes.end(), [&](const std::string& node) {
      return std::find(listeners.begin(), listeners.end(), node) != listeners.end();
    });
    if (listens) continue;
    findings.push_back(wrong(list(map_nodes) + " publishes " + evidence.seen.map_topic.name +
                                 ", but does not listen to " + role.topic.name,
                             "give the map node and the doctor the same remapping of " +
                                 relative_name(role.topic) + " (rosnode info " + map_nodes.front() +
                                 " shows what it listens to)"));
  }
  return findings;
}

Findings messages_arrive(const Evidence& evidence) {
  Findings findings;
  const auto look = [&](const Topic& topic, std::size_t received, const std::string& mend) {
    const bool could =
        std::any_of(topic.publishers.begin(), topic.publishers.end(), [&](const Publisher& publisher) {
          return publisher.answers && has_type(publisher, topic) && !has_other_definition(publisher, topic);
        });
    if (!could || received > 0) return;
    findings.push_back(wrong(list(nodes_of(topic)) + " is to publish " + topic.name + ", but in " +
                                 fixed(evidence.seen.listened, 1) + " s no message came",
                             mend));
  };
  for (const Role& role : roles(evidence.seen)) {
    if (&role.topic == &evidence.seen.navigation.topic && has_lines_of_files(evidence.seen)) continue;
    look(role.topic, role.received,
         &role.topic == &evidence.seen.navigation.topic
             ? "publish it latched, so that those who come later get it too, and publish it once"
             : "see why that node is silent (does its sensor or bag run?)");
  }
  look(evidence.seen.map_topic, evidence.seen.maps.size(),
       "see the log of the map node, and whether /clock runs");
  return findings;
}

}  // namespace relative_map::doctor
