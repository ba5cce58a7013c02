#include "relative_map/ros/health/diagnostics.hpp"

#include <cmath>
#include <sstream>

namespace relative_map {

namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kMaxClockStands = 2.0;  // [s] a clock that is simulated slowly moves more often

/// One bad frame is no alarm, and two are none yet.
bool comes_and_goes(const MapStatistics& statistics) {
  return statistics.drop_outs >= 3 || (statistics.drop_outs == 2 && statistics.empty_share >= 0.1);
}

unsigned char level_of(core::StatusCode code) {
  // Nothing received yet and the end of a line are states that every drive passes through.
  switch (code) {
    case core::StatusCode::kOk:
      return DiagnosticStatus::OK;
    case core::StatusCode::kNoLocalization:
    case core::StatusCode::kNoNavigationLine:
    case core::StatusCode::kLineEnd:
      return DiagnosticStatus::WARN;
    default:
      return DiagnosticStatus::ERROR;
  }
}

/// With its standard deviation, if it was estimated.
void add(diagnostic_updater::DiagnosticStatusWrapper& status, const std::string& name,
         const core::Estimate& estimate) {
  std::ostringstream text;
  text.precision(3);
  text << estimate.value;
  if (estimate.stddev >= 0.0) text << " +- " << estimate.stddev;
  status.add(name, text.str());
}

}  // namespace

std::string status_name(core::StatusCode code) {
  switch (code) {
    case core::StatusCode::kOk:
      return "OK";
    case core::StatusCode::kNoLocalization:
      return "NO_LOCALIZATION";
    case core::StatusCode::kStaleLocalization:
      return "STALE_LOCALIZATION";
    case core::StatusCode::kInvalidLocalization:
      return "INVALID_LOCALIZATION";
    case core::StatusCode::kNoNavigationLine:
      return "NO_NAVIGATION_LINE";
    case core::StatusCode::kOffRoute:
      return "OFF_ROUTE";
    case core::StatusCode::kLineEnd:
      return "LINE_END";
    case core::StatusCode::kMarkersUnusable:
      return "MARKERS_UNUSABLE";
    case core::StatusCode::kFrameMismatch:
      return "FRAME_MISMATCH";
    case core::StatusCode::kNoTransform:
      return "NO_TRANSFORM";
    case core::StatusCode::kContractViolation:
      return "CONTRACT_VIOLATION";
  }
  return "UNKNOWN";
}

std::string source_name(core::Source source) {
  switch (source) {
    case core::Source::kNone:
      return "NONE";
    case core::Source::kFused:
      return "FUSED";
    case core::Source::kNavigationLine:
      return "NAVIGATION_LINE";
    case core::Source::kLaneMarkers:
      return "LANE_MARKERS";
  }
  return "UNKNOWN";
}

void summarize(const MapStatistics& statistics, diagnostic_updater::DiagnosticStatusWrapper& status) {
  const core::RelativeMap& map = statistics.last_map;
  if (statistics.clock_stands > kMaxClockStands) {
    status.summaryf(DiagnosticStatus::WARN,
                    "the clock stands still, since %.0f s: no maps are made until /clock "
                    "moves on",
                    statistics.clock_stands);
  } else if (statistics.maps == 0) {
    status.summary(DiagnosticStatus::WARN, "no map published yet");
  } else if (map.status.code == core::StatusCode::kOk && comes_and_goes(statistics)) {
    const core::Status& fault = statistics.last_fault;
    status.summary(DiagnosticStatus::WARN, "the map comes and goes: " + std::to_string(statistics.drop_outs) +
                                               " drop-outs in 10 s, the last one for " +
                                               status_name(fault.code) + ": " + fault.message);
  } else if (map.status.code == core::StatusCode::kOk) {
    status.summary(DiagnosticStatus::OK,
                   std::to_string(statistics.lanes) + " lanes from " + source_name(map.fusion.source));
  } else {
    status.summary(level_of(map.status.code), status_name(map.status.code) + ": " + map.status.message);
  }
  status.add("source", source_name(map.fusion.source));
  status.add("current lane", map.current_lane_id);
  status.add("lateral offset [m]", statistics.lateral_offset);
  status.add("heading offset [rad]", statistics.heading_offset);
  status.add("remaining distance [m]", statistics.remaining_distance);
  status.add("fusion method", map.fusion.method);
  add(status, "fused lateral offset [m]", map.fusion.lateral_offset);
  add(status, "fused longitudinal offset [m]", map.fusion.longitudinal_offset);
  add(status, "fused heading offset [rad]", map.fusion.heading_offset);
  add(status, "left half width [m]", map.fusion.left_half_width);
  add(status, "right half width [m]", map.fusion.right_half_width);
  status.add("remarks", statistics.remarks);
  status.add("navigation lines", statistics.lines);
  std::string faults;
  for (const std::string& fault : statistics.line_faults) faults += (faults.empty() ? "" : "; ") + fault;
  status.add("navigation faults", faults);
  status.add("marker range [m]", map.fusion.marker_range);
  status.add("marker age [s]", map.fusion.marker_age);
  for (const auto& [topic, input] : statistics.inputs) {
    status.add(topic + " rate [Hz]", input.rate);
    if (std::isnan(input.age)) {
      status.add(topic + " age [s]", "none has come");
    } else {
      status.add(topic + " age [s]", input.age);
    }
  }
  status.add("tick time [ms]", 1e3 * statistics.tick_time);
  status.add("maps", statistics.maps);
  status.add("drop-outs in 10 s", statistics.drop_outs);
  status.addf("empty maps in 10 s [%]", "%.0f", 100.0 * statistics.empty_share);
  for (const auto& [reason, count] : statistics.empty_maps) status.add("empty maps, " + reason, count);
}

}  // namespace relative_map
