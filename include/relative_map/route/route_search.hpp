#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "relative_map/model/route.hpp"
#include "relative_map/model/route_segments.hpp"
#include "relative_map/route/lane_network.hpp"

namespace relative_map::core {

/// What ways cost. A lane costs its length [m], less where it may be driven on faster than base_speed.
struct SearchParam {
  double base_speed = 4.167;  ///< [m/s] a lane of a higher limit costs sqrt(base_speed / limit) of its length
  double left_turn = 50.0;    ///< [m] more for a lane that turns left,
  double right_turn = 20.0;   ///< [m] right,
  double u_turn = 100.0;      ///< [m] or back
  double lane_change = 500.0;        ///< [m] for a change with at least lane_change_length to do it in,
  double lane_change_length = 50.0;  ///< [m] and (length / this)^-1.5 times that with less
  double least_change_length = 1.0;  ///< [m] with less there is no lane change
  double min_turn_radius = 0.0;      ///< [m] a U-turn that is narrower is not driven; 0: any is

  /// Every fault as one sentence that names the parameter and its value; empty: fit to search with.
  std::vector<std::string> validate() const;
};

/// Where to: from the first of the places over the others to the last.
struct SearchRequest {
  std::vector<LanePosition> places;
  std::set<std::string> closed_lanes;  ///< not to be driven on
};

struct SearchResult {
  std::optional<Route> route;
  std::string why_not;  ///< one sentence, if there is none
};

/// Finds the ways of least cost over a lane network, by Dijkstra's algorithm. Lanes are changed only between
/// city lanes, over boundaries that are dotted all along or of which no paint is known. A destination that
/// lies behind the start on the same lane is reached the long way round.
class RouteSearch {
 public:
  RouteSearch(std::shared_ptr<const LaneNetwork> network, const SearchParam& param);
  ~RouteSearch();
  RouteSearch(RouteSearch&&) noexcept;
  RouteSearch& operator=(RouteSearch&&) noexcept;

  SearchResult find(const SearchRequest& request);

 private:
  class Graph;  ///< hidden: Boost.Graph is slow to compile

  std::string fault_of(const SearchRequest& request) const;

  std::shared_ptr<const LaneNetwork> network_;
  std::unique_ptr<Graph> graph_;
};

}  // namespace relative_map::core
