#pragma once

#include <map>
#include <string>
#include <vector>

#include "relative_map/model/lane_graph.hpp"

// From lanelets, which are two bounds each, to lanes, which are centerlines with widths.
namespace relative_map::core::lanelet {

using Tags = std::map<std::string, std::string>;

/// The tag's value; empty where it is missing.
std::string value(const Tags& tags, const std::string& key);

/// A way as one side of a lanelet, in the lanelet's direction of travel.
struct Bound {
  std::string id;
  Tags tags;
  std::vector<std::string> nodes;
  Polyline points;
  bool turned = false;  ///< the way itself runs against the lanelet
};

struct Lanelet {
  std::string id;
  Bound left, right;
  double speed_limit = 0.0;  ///< [m/s]; 0: not known
  LaneTurn turn = LaneTurn::kNoTurn;
};

/// Turns the bounds so that both run in the lanelet's direction: the left one is on its left.
void align(Lanelet& lanelet);

/// The same strip driven the other way, with "-" before its id.
Lanelet reversed(const Lanelet& lanelet);

/// Lanes with their links.
std::vector<GraphLane> lanes_of(const std::vector<Lanelet>& lanelets);

}  // namespace relative_map::core::lanelet
