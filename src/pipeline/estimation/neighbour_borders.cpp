#include "relative_map/pipeline/estimation/neighbour_borders.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kNarrowest = 2.0, kWidest = 6.0;  // [m] of a lane beyond
constexpr double kWalk = 0.06;                     // [m] of its border, by the root of the time [s]
constexpr double kSame = 0.5;                      // [m] by which it may jump
constexpr double kHold = 3.0;                      // [s] that it is believed unseen
constexpr double kNarrowestHalf = 1.0;             // [m] half width of a lane beside

using Scalar = Eigen::Matrix<double, 1, 1>;

}  // namespace

void NeighbourBorders::move(double way, double seconds) {
  for (Border* border : {&left, &right}) {
    border->range = std::max(0.0, border->range - way);
    if (border->seen) border->distance.predict(Scalar::Ones(), Scalar(kWalk * kWalk * seconds));
  }
}

void NeighbourBorders::see(Border& border, Time stamp, double distance, double variance, double own,
                           double range, BoundaryType type) {
  border.type = BoundaryType::kUnknown;
  if (distance < own + kNarrowest || distance > own + kWidest) return;
  if (border.seen && std::abs(distance - border.distance.state()[0]) > kSame) {
    border.seen.reset();  // it goes elsewhere: start anew with the next image
    return;
  }
  if (border.seen) {
    border.distance.correct(Scalar(distance - border.distance.state()[0]),
                            border.distance.expect(Scalar::Ones(), Scalar(variance)));
  } else {
    border.distance = KalmanFilter<1>(Scalar(distance), Scalar(variance));
  }
  border.seen = stamp;
  border.range = range;
  border.type = type;
}

void NeighbourBorders::apply(std::vector<LanePath>& lanes, std::size_t current, Time now) const {
  const auto far_half_width = [&](const Border& border, const LanePath& beside) -> std::optional<double> {
    if (!border.seen || to_seconds(now - *border.seen) > kHold) return std::nullopt;
    const double half_width = border.distance.state()[0] - std::abs(beside.l - lanes[current].l);
    return half_width < kNarrowestHalf ? std::nullopt : std::optional<double>(half_width);
  };
  if (current > 0) {
    LanePath& beside = lanes[current - 1];
    if (const auto width = far_half_width(left, beside)) {
      beside.left_half_width = *width;
      beside.seen = SeenHalfWidths{width, {}, beside.s_at_vehicle + left.range};
    }
  }
  if (current + 1 < lanes.size()) {
    LanePath& beside = lanes[current + 1];
    if (const auto width = far_half_width(right, beside)) {
      beside.right_half_width = *width;
      beside.seen = SeenHalfWidths{{}, width, beside.s_at_vehicle + right.range};
    }
  }
}

}  // namespace relative_map::core
