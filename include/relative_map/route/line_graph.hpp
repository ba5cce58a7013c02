#pragma once

#include <string>
#include <vector>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/model/lane_graph.hpp"

namespace relative_map::core {

struct NamedLine {
  std::string name;
  Polyline points;  ///< [m] in the direction of travel
};

struct LineGraphParam {
  double same = 1.0;          ///< [m] lines that run nearer to each other are one lane there
  double least_beside = 2.2;  ///< [m] lines that run this far,
  double most_beside = 5.0;   ///< [m] to this far from each other lie side by side
  double heading = 0.35;      ///< [rad] between lines that do either; more is a crossing
  double least_run = 10.0;    ///< [m] for which they must do it
  double blend = 15.0;        ///< [m] over which a line is drawn to the one that it leaves or joins
  double width = 3.5;         ///< [m] of lanes with nothing beside them
};

/// Recorded lines as a lane graph: what several lines run along becomes one lane (the first one's), and lanes
/// are cut where another one leaves it (a fork), comes to it (a merge), or begins or ends beside it. A line
/// whose end meets its start becomes a lap. What was left out goes to `notes`, a sentence each. A line that
/// runs along itself more than once is not untangled.
LaneGraph graph_from_lines(const std::vector<NamedLine>& lines, const LineGraphParam& param,
                           std::vector<std::string>& notes);

}  // namespace relative_map::core
