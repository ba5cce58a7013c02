#include <map>

#include "doctor_rules.hpp"
#include "relative_map/ros/health/diagnostics.hpp"

// What the map node makes of it all.
namespace relative_map::doctor {

namespace {

std::string mend_for(core::StatusCode code) {
  using core::StatusCode;
  switch (code) {
    case StatusCode::kNoLocalization:
      return "see what is said of localization; just after the start of the map node this passes by itself";
    case StatusCode::kStaleLocalization:
      return "see what is said of localization's rate and stamps";
    case StatusCode::kInvalidLocalization:
      return "publish finite numbers and a unit quaternion, or nothing while there is no solution";
    case StatusCode::kNoNavigationLine:
      return "publish lines on navigation, latched; see what is said of them";
    case StatusCode::kOffRoute:
      return "see what is said of the nearest line and of headings";
    case StatusCode::kLineEnd:
      return "send a line that goes on from here, or a closed one";
    case StatusCode::kMarkersUnusable:
      return "see what is said of lane markers, or set navigation_lane/lane_source to OFFLINE_GENERATED";
    case StatusCode::kFrameMismatch:
      return "name one map frame in navigation and localization";
    case StatusCode::kNoTransform:
      return "publish the missing transform on /tf_static";
    case StatusCode::kContractViolation:
      return "record the inputs (rosbag record) and report it: this is a fault of the map node";
    default:
      return "see the log of the map node";
  }
}

}  // namespace

Findings configuration_is_accepted(const Evidence& evidence) {
  const Observations& seen = evidence.seen;
  if (!seen.config_fault.empty()) {
    return {
        wrong("the map node can not run with the parameters in " + seen.node + ": " + seen.config_fault,
              "correct them in the file that is passed to the launch file as config; the doctor goes on with "
              "the defaults")};
  }
  if (seen.map_topic.publishers.empty() || seen.node_has_parameters) return {};
  return {note("there are no parameters in " + seen.node + ", so the doctor takes the defaults",
               "if the map node has another name, tell the doctor: _node:=NAME")};
}

Findings maps_have_lanes(const Evidence& evidence) {
  const Observations& seen = evidence.seen;
  if (seen.maps.empty()) return {};
  std::map<core::StatusCode, std::pair<std::size_t, std::string>> empty;
  for (const SeenMap& map : seen.maps) {
    if (map.status.code == core::StatusCode::kOk) continue;
    auto& [count, sentence] = empty[map.status.code];
    ++count;
    sentence = map.status.message;
  }
  Findings findings;
  for (const auto& [code, reason] : empty) {
    findings.push_back(wrong(text(seen.map_topic.name, ": ", reason.first, " of ", seen.maps.size(),
                                  " maps are empty with ", status_name(code), ": ", reason.second),
                             mend_for(code)));
  }
  if (findings.empty()) {
    findings.push_back(ok(text(seen.map_topic.name, ": all of ", seen.maps.size(), " maps have lanes")));
  }
  const core::Status& last = seen.maps.back().status;
  if (last.code == core::StatusCode::kOk && !last.message.empty()) {
    findings.push_back(note(seen.map_topic.name + ": " + last.message, "see what is said of that input"));
  }
  return findings;
}

Findings maps_keep_the_contract(const Evidence& evidence) {
  const Observations& seen = evidence.seen;
  std::size_t broken = 0;
  const core::Violation* example = nullptr;
  for (const SeenMap& map : seen.maps) {
    if (map.violations.empty()) continue;
    ++broken;
    example = &map.violations.front();
  }
  if (seen.maps.empty()) return {};
  if (broken == 0) return {ok(seen.map_topic.name + ": all maps keep the output contract")};
  return {wrong(text(seen.map_topic.name, ": ", broken, " of ", seen.maps.size(),
                     " maps break the output contract, for instance ", example->row, ": ", example->what),
                "do not drive by it; record the inputs (rosbag record) and report it")};
}

}  // namespace relative_map::doctor
