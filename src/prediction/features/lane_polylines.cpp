#include "relative_map/prediction/features/lane_polylines.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

constexpr double kReach = 100.0;  // [m]
constexpr double kVector = 5.0;   // [m]

void add_line(const ViewedLane& lane, double offset, int kind, const Pose2& frame, LanePolylines& result) {
  if (result.lines >= kPolylines) return;
  std::vector<Point2> points;
  const auto place = [&](double s) {
    const LaneSample sample = lane.at(s);
    const Point2 left(-sample.direction.y(), sample.direction.x());
    return frame.to_local(sample.position + offset * left);
  };
  bool begun = false;
  std::size_t vector = 0;
  for (double s = 0.0; s < lane.length && vector < kPolylineVectors; s += kVector) {
    const Point2 from = place(s), to = place(std::min(lane.length, s + kVector));
    if (from.norm() > kReach && to.norm() > kReach) {
      if (begun) break;
      continue;
    }
    begun = true;
    const std::size_t index = result.lines * kPolylineVectors + vector++;
    result.mask[index] = 1;
    const float values[kVectorValues] = {static_cast<float>(from.x()),
                                         static_cast<float>(from.y()),
                                         static_cast<float>(to.x()),
                                         static_cast<float>(to.y()),
                                         0.0F,
                                         0.0F,
                                         static_cast<float>(kind),
                                         kind == 1 ? 0.0F : 1.0F,
                                         static_cast<float>(result.lines)};
    std::copy(values, values + kVectorValues,
              result.values.begin() + static_cast<std::ptrdiff_t>(index * kVectorValues));
  }
  if (begun) ++result.lines;
}

}  // namespace

LanePolylines lane_polylines(const LaneView& lanes, const Pose2& frame) {
  LanePolylines result;
  result.values.assign(kPolylines * kPolylineVectors * kVectorValues, 0.0F);
  result.mask.assign(kPolylines * kPolylineVectors, 0);
  for (const ViewedLane& lane : lanes.lanes()) {
    add_line(lane, 0.0, 1, frame, result);
    add_line(lane, lane.left_width, 2, frame, result);
    add_line(lane, -lane.right_width, 3, frame, result);
  }
  return result;
}

}  // namespace relative_map::core
