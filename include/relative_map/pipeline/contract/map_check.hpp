#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/model/map.hpp"

namespace relative_map::core {

/// A broken row of the output contract, with the lane and the numbers.
struct Violation {
  std::string row;
  std::string what;
};

/// What a map is held against besides itself.
struct MapContext {
  std::string frame_id = "base_link";
  std::optional<std::uint32_t> previous_sequence_num = {};  ///< of the map published before
  std::optional<Time> previous_stamp = {};                  ///< likewise
  double max_half_width = 20.0;                             ///< [m] no lane is wider, whatever the parameters
  bool borders_are_checked = false;  ///< find_bad_lane has seen this map: rows "samples" and "sides" hold

  /// As the map is configured.
  static MapContext of(const PipelineConfig& config);
};

/// The names of all rows, in the order in which they are checked.
std::vector<std::string> map_check_rows();

/// Every broken row of the output contract, the first fault of each; empty: the map may be published.
/// Rows that compare geometry are checked only where every number is finite and every path is a path.
std::vector<Violation> check_map(const RelativeMap& map, const MapContext& context);

/// A lane whose borders break the rows "samples" or "sides".
struct BadLane {
  std::size_t lane = 0;  ///< its place in the map; of two that lie in each other, the one that matters less
  double s = 0.0;        ///< [m] along it, where that was seen first
  std::string what;
};

/// The first one, for a map of finite numbers and paths of two or more points; none: both rows hold.
std::optional<BadLane> find_bad_lane(const RelativeMap& map, const MapContext& context);

/// The map, if it keeps the contract; else an empty one in its place, whose status names rows and numbers.
RelativeMap checked(RelativeMap map, const MapContext& context);

}  // namespace relative_map::core
