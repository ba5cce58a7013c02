#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/route.hpp"
#include "relative_map/model/route_segments.hpp"
#include "relative_map/route/route_index.hpp"
#include "relative_map/route/route_param.hpp"
#include "relative_map/route/route_tracker.hpp"

namespace relative_map::core {

/// Which way: a route on a lane graph, and each tick what is to be followed from where the vehicle is.
class RouteMap {
 public:
  explicit RouteMap(const RouteParam& param) : param_(param) {}

  /// Takes a graph. A route that was taken before is checked against it, and forgotten if it does not fit.
  RouteStatus set_graph(std::shared_ptr<const LaneNetwork> network);
  /// Takes a route, if it is right; else the old one stays, and the status names the fault. A route that
  /// leads the same way as the one before is the same one: nothing of what is known is forgotten.
  RouteStatus set_route(const Route& route);
  void clear_route();

  /// The segments around a pose in the graph's frame, at a speed [m/s]; or the status that says why not.
  RouteUpdate update(const std::optional<Pose2>& pose, double speed);

  const std::optional<Route>& route() const { return route_; }
  const RouteIndex* index() const { return index_.get(); }
  const LaneNetwork* network() const { return network_.get(); }
  /// What was put right in the route that is followed: a sentence each.
  const std::vector<std::string>& repairs() const { return repairs_; }

 private:
  RouteStatus take(const Route& route);

  RouteParam param_;
  std::shared_ptr<const LaneNetwork> network_;
  std::shared_ptr<const RouteIndex> index_;
  std::optional<RouteTracker> tracker_;
  std::optional<Route> route_;
  std::vector<std::string> repairs_;
};

}  // namespace relative_map::core
