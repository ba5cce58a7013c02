#include "relative_map/doctor/doctor.hpp"

#include <algorithm>

#include "doctor_rules.hpp"

namespace relative_map::doctor {

namespace {

constexpr std::size_t kLongestLine = 600;  // characters

struct Rule {
  const char* name;
  Findings (*look)(const Evidence&);
};

/// From causes to consequences.
constexpr Rule kRules[] = {
    {"configuration_is_accepted", configuration_is_accepted},
    {"clock_runs", clock_runs},
    {"topics_have_publishers", topics_have_publishers},
    {"publishers_answer", publishers_answer},
    {"types_are_right", types_are_right},
    {"definitions_are_the_same", definitions_are_the_same},
    {"topics_have_one_publisher", topics_have_one_publisher},
    {"map_node_listens", map_node_listens},
    {"messages_arrive", messages_arrive},
    {"rates_are_high_enough", rates_are_high_enough},
    {"inputs_do_not_pause", inputs_do_not_pause},
    {"stamps_are_filled", stamps_are_filled},
    {"stamps_are_fresh", stamps_are_fresh},
    {"stamps_are_not_ahead", stamps_are_not_ahead},
    {"stamps_rise", stamps_rise},
    {"map_frames_agree", map_frames_agree},
    {"localized_link_is_known", localized_link_is_known},
    {"marker_frame_is_known", marker_frame_is_known},
    {"marker_frame_is_flu", marker_frame_is_flu},
    {"poses_are_usable", poses_are_usable},
    {"heading_is_filled", heading_is_filled},
    {"heading_is_in_radians", heading_is_in_radians},
    {"orientation_fits_heading", orientation_fits_heading},
    {"heading_fits_motion", heading_fits_motion},
    {"velocity_fits_motion", velocity_fits_motion},
    {"yaw_rate_fits_motion", yaw_rate_fits_motion},
    {"speeds_agree", speeds_agree},
    {"lines_are_usable", lines_are_usable},
    {"a_line_is_near", a_line_is_near},
    {"a_line_runs_along", a_line_runs_along},
    {"markers_are_not_mirrored", markers_are_not_mirrored},
    {"markers_make_a_lane", markers_make_a_lane},
    {"marker_quality_is_a_share", marker_quality_is_a_share},
    {"marker_curvature_is_halved", marker_curvature_is_halved},
    {"maps_have_lanes", maps_have_lanes},
    {"maps_keep_the_contract", maps_keep_the_contract},
    {"maps_come_often_enough", maps_come_often_enough},
};

}  // namespace

std::vector<Finding> diagnose(const Observations& seen) {
  const Evidence evidence(seen);
  std::vector<Finding> findings;
  for (const Rule& rule : kRules) {
    for (Finding& finding : rule.look(evidence)) {
      finding.rule = rule.name;
      findings.push_back(std::move(finding));
    }
  }
  return findings;
}

std::vector<std::string> rule_names() {
  std::vector<std::string> names;
  for (const Rule& rule : kRules) names.push_back(rule.name);
  return names;
}

std::string to_line(const Finding& finding) {
  std::string line;
  switch (finding.severity) {
    case Severity::kOk:
      line = "ok: " + finding.what;
      break;
    case Severity::kNote:
      line = "note: " + finding.what + " -> " + finding.mend;
      break;
    case Severity::kWrong:
      line = "WRONG: " + finding.what + " -> mend: " + finding.mend;
  }
  std::replace(line.begin(), line.end(), '\n', ' ');  // what others have to say may have several lines
  if (line.size() > kLongestLine) {
    std::size_t end = kLongestLine - 3;
    while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xC0U) == 0x80U)
      --end;  // within a UTF-8 character
    line = line.substr(0, end) + "...";
  }
  return line;
}

}  // namespace relative_map::doctor
