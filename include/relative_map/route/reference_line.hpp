#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/model/route_segments.hpp"
#include "relative_map/route/lane_network.hpp"

namespace relative_map::core {

/// How the line that a vehicle follows is drawn.
struct ReferenceLineParam {
  double spacing = 1.0;         ///< [m] of its points
  double vehicle_width = 1.9;   ///< [m]
  double half_width = 1.75;     ///< [m] of lanes whose width is not known
  double clearance = 0.2;       ///< [m] that stay free between vehicle and lane on either side
  double curb_clearance = 0.2;  ///< [m] more beside a curb
  double curb_shift = 0.1;      ///< [m] that the line is moved away from a curb
  double least_bound = 0.1;     ///< [m] beside the centerline that the line may lie in any lane,
  double greatest_bound = 0.5;  ///< [m] and in the widest
  double follow = 10.0;         ///< [m] bends longer than about six of these follow the centerline
  double pinned = 30.0;         ///< [m] ahead of the vehicle up to which the line does not move any more
  double speed_limit = 29.06;   ///< [m/s] of lanes that have none
  double lateral_acceleration = 2.0;  ///< [m/s^2] at most in bends: it bounds the speed there

  /// Every fault as one sentence that names the parameter and its value; empty: fit to run with.
  std::vector<std::string> validate() const;
};

/// A point of the line, in the graph's frame.
struct ReferencePoint {
  PathPoint path;                                        ///< s from the line's start
  std::size_t lane = 0;                                  ///< of the network
  double lane_s = 0.0;                                   ///< [m] along that lane
  double l = 0.0;                                        ///< [m] left of the lane's centerline
  double left_half_width = 0.0, right_half_width = 0.0;  ///< [m] of the lane
  double speed_limit = 0.0;                              ///< [m/s] the lane's, or what the bend allows
};

/// The one line to follow on a passage.
struct ReferenceLine {
  std::string id;  ///< of the segments that it was made from
  std::vector<ReferencePoint> points;
  double s = 0.0;  ///< [m] of the vehicle along it
};

/// Makes the line of a passage: the centerlines of its lanes joined, smoothed within the lane, and stitched
/// to what was made before, so that what the vehicle is on does not move.
class ReferenceLineMaker {
 public:
  ReferenceLineMaker(std::shared_ptr<const LaneNetwork> network, const ReferenceLineParam& param)
      : network_(std::move(network)), param_(param) {}

  /// The lines of the segments of one tick, in their order. A passage whose line can't be drawn has one
  /// without points.
  std::vector<ReferenceLine> make(const std::vector<RouteSegments>& segments, const Point2& vehicle);

 private:
  /// A place on the way that the line passes by.
  struct Knot {
    std::size_t lane = 0;
    double lane_s = 0.0;
    double along = 0.0;  ///< [m] from the start of the segments
    Point2 point = Point2::Zero(), left = Point2::UnitY();
    double offset = 0.0;  ///< [m] to the left, of the line
    bool pinned = false;
    bool passing = false;  ///< only there to end the line: not kept for the next tick
  };
  using Knots = std::vector<Knot>;
  class Way;

  Knots knots_on(const Way& way, double vehicle_s) const;
  Knots kept(const Way& way, double vehicle_s) const;
  bool smooth(Knots& knots) const;
  ReferenceLine line_of(const std::string& id, const Knots& knots, const Point2& vehicle) const;

  std::shared_ptr<const LaneNetwork> network_;
  ReferenceLineParam param_;
  std::vector<Knots> last_;
};

}  // namespace relative_map::core
