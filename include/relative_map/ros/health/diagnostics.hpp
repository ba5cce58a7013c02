#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <map>
#include <string>
#include <vector>

#include "relative_map/model/map.hpp"

namespace relative_map {

struct InputStatistics {
  double rate = 0.0;  ///< [Hz]
  double age = 0.0;   ///< [s] of the newest message's stamp; NaN: none has come
};

/// What /diagnostics tells of the maps.
struct MapStatistics {
  core::RelativeMap last_map;  ///< without its lanes; the status is one that has lasted
  std::size_t lanes = 0;
  double lateral_offset = 0.0;      ///< [m] of the vehicle from the current lane
  double heading_offset = 0.0;      ///< [rad] of the vehicle from the current lane
  double remaining_distance = 0.0;  ///< [m]
  double tick_time = 0.0;           ///< [s] of the last tick
  std::size_t maps = 0;
  std::map<std::string, std::size_t> empty_maps;  ///< by reason
  std::size_t drop_outs = 0;  ///< of the map, in the last 10 s: a filled one, then an empty one
  double empty_share = 0.0;   ///< [-] of the maps of the last 10 s
  core::Status last_fault;    ///< of the last empty map
  std::string remarks;        ///< on filled maps, the last within 2 s
  std::map<std::string, InputStatistics> inputs;  ///< by topic
  std::size_t lines = 0;                          ///< that can be driven on
  std::vector<std::string> line_faults;           ///< what was refused or repaired of them
  double clock_stands = 0.0;                      ///< [s] of the wall's clock that ROS time has not moved
};

/// Name of a status code as in MapStatus.
std::string status_name(core::StatusCode code);
/// Name of a source as in FusionState.
std::string source_name(core::Source source);

/// OK, WARN or ERROR with one plain sentence, and the numbers behind it. A pure function of the statistics.
void summarize(const MapStatistics& statistics, diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace relative_map
