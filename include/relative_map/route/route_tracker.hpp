#pragma once

#include <optional>
#include <vector>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/route/route_index.hpp"
#include "relative_map/route/route_param.hpp"

namespace relative_map::core {

/// Where the vehicle is on its route: a place in the route's order, not only on a lane, so that a lane that
/// the route has more than once is the right one of them.
struct TrackedPlace {
  PiecePlace place;  ///< on the piece
  double s = 0.0;    ///< [m] along the lane, past the piece's ends where the vehicle is
  double l = 0.0;    ///< [m] left of the lane
};

/// Follows the vehicle along a route. Of all places within reach it takes the nearest one. Where several are
/// as near, or one that is a little nearer could not have been driven to, the way that the vehicle has come
/// since the last pose decides. It remembers one place and can't get stuck: after a jump the nearest place is
/// taken as if it were the first one.
class RouteTracker {
 public:
  struct Result {
    RouteStatus status;
    std::optional<TrackedPlace> place;
  };

  RouteTracker(std::shared_ptr<const RouteIndex> index, const RouteParam& param);

  /// The place of a pose in the graph's frame. On failure the last place is kept to go on from.
  Result update(const Pose2& pose);

 private:
  struct Candidate {
    std::size_t piece = 0;
    LaneProjection projection;
    double gap = 0.0;              ///< [m] that it lies past the ends of its piece
    std::optional<double> driven;  ///< [m] from the last place along the route; negative: back
  };

  std::vector<Candidate> candidates(const Pose2& pose, bool& wrong_way) const;
  void measure_driven(std::vector<Candidate>& candidates, double reach) const;
  double cost(const Candidate& candidate) const;
  bool beside_next(const Candidate& piece, const Candidate& next) const;
  bool better(const Candidate& a, const Candidate& b, double moved) const;
  Result off_route(const Pose2& pose, bool wrong_way) const;

  std::shared_ptr<const RouteIndex> index_;
  RouteParam param_;
  std::optional<PiecePlace> last_;
  Point2 last_position_ = Point2::Zero();
};

}  // namespace relative_map::core
