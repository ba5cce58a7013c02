#pragma once

#include <vector>

#include "relative_map/prediction/lane_view.hpp"

namespace relative_map::core {

constexpr std::size_t kPolylines = 450, kPolylineVectors = 50, kVectorValues = 9;

/// Lanes around a road user as vectors, for networks. Lines of lanes first seen first; what is too many is
/// left out.
struct LanePolylines {
  /// kPolylines x kPolylineVectors x kVectorValues: x0 y0 x1 y1 [m] in the road user's frame, 0, 0, what it
  /// is (1 a centerline, 2 a left and 3 a right boundary), whether it is a boundary, the line's number
  std::vector<float> values;
  std::vector<unsigned char> mask;  ///< kPolylines x kPolylineVectors: 1 where there is a vector
  std::size_t lines = 0;            ///< that are there
};

/// All lines that come within 100 m of `frame`'s origin, in vectors of 5 m.
LanePolylines lane_polylines(const LaneView& lanes, const Pose2& frame);

}  // namespace relative_map::core
