#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// A road's reference curve, made of straights, clothoids and arcs that follow each other with one tangent,
/// and the lanes parallel to it. Known to 1e-9 m on kilometres, so tests can take it for the truth.
/// s [m] is the arc length along the reference curve, l [m] the lateral offset, left positive.
class RoadShape {
 public:
  /// `start` is the pose of s = 0 in the map frame; the curvature there is 0 until a piece says otherwise.
  explicit RoadShape(const Pose2& start = {}) : start_(start) {}

  /// All of them throw std::invalid_argument if `length` [m] is not above 0 or a curvature [1/m] not finite.
  RoadShape& add_straight(double length);
  /// Curvature changes linearly with s, from `kappa_start`, or from where the road's last piece ended.
  RoadShape& add_clothoid(double length, double kappa_end);
  RoadShape& add_clothoid(double length, double kappa_start, double kappa_end);
  /// Of a given curvature, or with the curvature that the last piece ended with.
  RoadShape& add_arc(double length, double kappa);
  RoadShape& add_arc(double length);

  double length() const { return length_; }

  /// The point beside s (held in [0, length()]) at offset l, in the map frame, with the geometry of the
  /// parallel curve at l there; its s is the arc length along that parallel. Throws std::out_of_range on a
  /// road without pieces, and where l lies beyond the centre of the curve.
  PathPoint at(double s, double l = 0.0) const;

  /// The parallel at `offset` [m] as a recording of its whole length: points about `spacing` [m] of s apart,
  /// evenly, beside those of all other lanes of this road; z is not given. Throws like at().
  RecordedLine lane(double offset, double spacing, const std::string& name = "lane") const;

  /// Lanes of one width [m] side by side about the reference curve, named lane_0 (leftmost), lane_1 ... and
  /// with priorities in that order. Throws like at().
  std::vector<RecordedLine> lanes(std::size_t count, double lane_width, double spacing) const;

 private:
  /// Seen from the road's start, so that map-sized coordinates cost no digits.
  struct Piece {
    double s;       ///< [m] where it starts
    double length;  ///< [m]
    Point2 position;
    double turned;  ///< [rad] direction at the start, not wrapped
    double kappa;   ///< [1/m] at the start
    double dkappa;  ///< [1/m^2]

    double turned_after(double distance) const {
      return turned + distance * (kappa + 0.5 * distance * dkappa);
    }
    Point2 position_after(double distance) const;
  };

  const Piece& piece_at(double s) const;

  Pose2 start_;
  std::vector<Piece> pieces_;
  double length_ = 0.0;
  double kappa_end_ = 0.0;
};

/// The demo's open road, 1.08 km: straights, and curves to both sides of 300, 100, 60 and 200 m radius.
RoadShape demo_road(const Pose2& start = {});

/// A stadium of 757 m, driven counter-clockwise: its end is its start.
RoadShape closed_road(const Pose2& start = {});

}  // namespace relative_map::core
