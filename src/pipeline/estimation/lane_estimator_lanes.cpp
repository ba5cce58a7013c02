// What LaneEstimator makes of the lanes.

#include <algorithm>
#include <cmath>

#include "relative_map/pipeline/estimation/lane_estimator.hpp"

namespace relative_map::core {

namespace {

constexpr double kNarrowestHalfWidth = 1.0;  // [m] of a lane beside

Point2 normal_of(double heading) {
  return {-std::sin(heading), std::cos(heading)};
}

}  // namespace

VehicleState LaneEstimator::corrected(const VehicleState& localized) const {
  if (!informed()) return localized;
  VehicleState state = localized;
  const Filter::State& x = filter_.state();
  state.map_from_base = Pose2(origin_ + Point2(x[kX], x[kY]), normalize_angle(x[kHeading]));
  return state;
}

bool LaneEstimator::apply(const NavigationLine& line, const LineProjection& projection,
                          double least_half_width, LanePath& lane) const {
  if (!informed() || lane.id != line_id_) return false;
  lane.left_half_width = std::max(least_half_width, filter_.state()[kLeft]);
  lane.right_half_width = std::max(least_half_width, filter_.state()[kRight]);
  lane.seen = {lane.left_half_width, lane.right_half_width, lane.s_at_vehicle + paint_range_};
  const OffsetProfile profile(filter_.state().tail<OffsetProfile::kKnots>());
  const double start =
      (s_along(line, projection.s) - first_knot_s_ - lane.s_at_vehicle) / OffsetProfile::kSpacing;
  for (PathPoint& point : lane.points) {
    point.position += profile.at(start + point.s / OffsetProfile::kSpacing) * left_of(point.direction);
  }
  compute_arc_length(lane.points);
  compute_geometry(lane.points);
  locate_vehicle(lane);
  return true;
}

void LaneEstimator::apply_beside(std::vector<LanePath>& lanes, std::size_t current) const {
  const LanePath& lane = lanes[current];
  if (!informed() || lane.id != line_id_ || !lane.seen) return;
  const auto far_half_width = [&](const NextBorder& border, const LanePath& beside) {
    return border.distance.state()[0] - std::abs(beside.l - lane.l);
  };
  const auto tell = [&](LanePath& beside, double half_width, double& own) {
    if (half_width < kNarrowestHalfWidth) return std::optional<double>();
    own = half_width;
    beside.seen = SeenHalfWidths{{}, {}, beside.s_at_vehicle + paint_range_};
    return std::optional<double>(half_width);
  };
  if (next_left_.known && current > 0) {
    LanePath& left = lanes[current - 1];
    if (const auto width = tell(left, far_half_width(next_left_, left), left.left_half_width)) {
      left.seen->left = width;
    }
  }
  if (next_right_.known && current + 1 < lanes.size()) {
    LanePath& right = lanes[current + 1];
    if (const auto width = tell(right, far_half_width(next_right_, right), right.right_half_width)) {
      right.seen->right = width;
    }
  }
}

FusionState LaneEstimator::state(const LineProjection& projection, double heading) const {
  FusionState state;
  if (!informed()) return state;
  state.method = "estimator";
  const Filter::State& x = filter_.state();
  const Filter::Covariance& p = filter_.covariance();
  const double line_heading = heading - projection.heading_offset;
  const Point2 left = normal_of(line_heading), along(left.y(), -left.x());
  const Eigen::Matrix2d bias = p.block<2, 2>(kBiasX, kBiasX);
  Jacobian<1> lateral = lateral.Zero();
  lateral[kBiasX] = left.x();
  lateral[kBiasY] = left.y();
  lateral.tail<OffsetProfile::kKnots>() =
      OffsetProfile::shares((line_s_ - first_knot_s_) / OffsetProfile::kSpacing);
  state.lateral_offset = {lateral.dot(x), std::sqrt((lateral * p * lateral.transpose())(0, 0))};
  state.longitudinal_offset = {-along.dot(Point2(x[kBiasX], x[kBiasY])), std::sqrt(along.dot(bias * along))};
  state.heading_offset = {x[kBiasHeading], filter_.stddev(kBiasHeading)};
  state.left_half_width = {x[kLeft], filter_.stddev(kLeft)};
  state.right_half_width = {x[kRight], filter_.stddev(kRight)};
  return state;
}

}  // namespace relative_map::core
