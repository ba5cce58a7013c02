#include "relative_map/prediction/features/ego_features.hpp"

#include <cmath>

namespace relative_map::core {

std::optional<Eigen::Matrix<double, kEgoSteps, 6>> ego_features(const EgoVehicle& ego, const Pose2& frame) {
  const auto& plan = ego.trajectory;
  if (plan.size() < 2 || plan.front().time > kPredictionStep + 1e-6 ||
      plan.back().time < kPredictionStep * kEgoSteps - 1e-6) {
    return std::nullopt;
  }
  Eigen::Matrix<double, kEgoSteps, 6> features;
  std::size_t next = 1;
  for (int i = 0; i < kEgoSteps; ++i) {
    const double t = kPredictionStep * (i + 1);
    while (next + 1 < plan.size() && plan[next].time < t) ++next;
    const TrajectoryPoint &a = plan[next - 1], &b = plan[next];
    const double share = b.time > a.time ? (t - a.time) / (b.time - a.time) : 1.0;
    const Point2 position = frame.to_local(a.position + share * (b.position - a.position));
    const double turn = angle_difference(b.theta, a.theta), way = (b.position - a.position).norm();
    features.row(i) << position.x(), position.y(), angle_difference(a.theta + share * turn, frame.heading()),
        a.speed + share * (b.speed - a.speed), a.acceleration + share * (b.acceleration - a.acceleration),
        (way > 1e-3 ? turn / way : 0.0);
  }
  return features;
}

}  // namespace relative_map::core
