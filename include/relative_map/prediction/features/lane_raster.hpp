#pragma once

#include <cstdint>
#include <vector>

#include "relative_map/prediction/lane_view.hpp"
#include "relative_map/prediction/situation.hpp"

namespace relative_map::core {

constexpr int kRasterSize = 224;        ///< pixels on each side
constexpr double kRasterLength = 40.0;  ///< [m] on each side
constexpr double kRasterAhead = 30.0;   ///< [m] of them ahead of the road user

/// What lies around a road user, as a picture for networks; it looks up.
struct LaneRaster {
  /// 3 planes of kRasterSize rows, the first row farthest ahead, the first column farthest left: where lanes
  /// are, their centerlines, and all road users' boxes; 0 or 255
  std::vector<std::uint8_t> pixels;

  std::uint8_t at(int plane, int row, int column) const {
    return pixels[static_cast<std::size_t>((plane * kRasterSize + row) * kRasterSize + column)];
  }
};

/// `frame` is the road user's.
LaneRaster lane_raster(const LaneView& lanes, const std::vector<Situation>& situations, const Pose2& frame);

}  // namespace relative_map::core
