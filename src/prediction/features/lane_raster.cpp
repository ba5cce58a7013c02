#include "relative_map/prediction/features/lane_raster.hpp"

#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kPixel = kRasterLength / kRasterSize;  // [m]
constexpr double kLine = 0.2;                           // [m] half the width of a drawn centerline

class Canvas {
 public:
  explicit Canvas(const Pose2& frame) : frame_(frame) {
    raster_.pixels.assign(static_cast<std::size_t>(3 * kRasterSize * kRasterSize), 0);
  }

  /// A rectangle around `center`, `along` and `across` [m] to both sides.
  void fill(int plane, const Point2& center, double heading, double along, double across) {
    const Point2 middle = frame_.to_local(center);
    const double angle = heading - frame_.heading(), c = std::cos(angle), s = std::sin(angle);
    const double reach = std::hypot(along, across) + kPixel;
    const int first_row = row_of(middle.x() + reach), last_row = row_of(middle.x() - reach);
    const int first_column = column_of(middle.y() + reach), last_column = column_of(middle.y() - reach);
    for (int row = std::max(0, first_row); row <= std::min(kRasterSize - 1, last_row); ++row) {
      for (int column = std::max(0, first_column); column <= std::min(kRasterSize - 1, last_column);
           ++column) {
        const double x = kRasterAhead - (row + 0.5) * kPixel - middle.x();
        const double y = 0.5 * kRasterLength - (column + 0.5) * kPixel - middle.y();
        if (std::abs(c * x + s * y) > along || std::abs(c * y - s * x) > across) continue;
        raster_.pixels[static_cast<std::size_t>((plane * kRasterSize + row) * kRasterSize + column)] = 255;
      }
    }
  }
  LaneRaster take() && { return std::move(raster_); }

 private:
  static int row_of(double x) { return static_cast<int>(std::floor((kRasterAhead - x) / kPixel)); }
  static int column_of(double y) { return static_cast<int>(std::floor((0.5 * kRasterLength - y) / kPixel)); }

  const Pose2& frame_;
  LaneRaster raster_;
};

}  // namespace

LaneRaster lane_raster(const LaneView& lanes, const std::vector<Situation>& situations, const Pose2& frame) {
  Canvas canvas(frame);
  for (const ViewedLane& lane : lanes.lanes()) {
    for (std::size_t i = 0; i + 1 < lane.samples.size(); ++i) {
      const Point2 &a = lane.samples[i].position, &b = lane.samples[i + 1].position;
      const double half = 0.5 * (b - a).norm(), heading = std::atan2(b.y() - a.y(), b.x() - a.x());
      if ((0.5 * (a + b) - frame.position()).norm() > kRasterLength + lane.left_width) continue;
      const Point2 left(-std::sin(heading), std::cos(heading));
      const Point2 middle = 0.5 * (a + b) + 0.5 * (lane.left_width - lane.right_width) * left;
      // A little longer than they are, so that no gap opens on the outside of a bend.
      canvas.fill(0, middle, heading, half + kPixel, 0.5 * (lane.left_width + lane.right_width));
      canvas.fill(1, 0.5 * (a + b), heading, half + kPixel, kLine);
    }
  }
  for (const Situation& situation : situations) {
    canvas.fill(2, situation.position(), situation.theta, situation.half_length, situation.half_width);
  }
  return std::move(canvas).take();
}

}  // namespace relative_map::core
