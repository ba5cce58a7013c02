#include "relative_map/simulation/speed_profile.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

SpeedProfile::SpeedProfile(const DrivePath& path, const SpeedParam& param, double stop_s) {
  for (const PathPoint& point : path.points) {
    const double by_curve = param.max_lateral_acceleration / std::max(std::abs(point.kappa), 1e-9);
    limits_.push_back({point.s, std::min(param.max_speed * param.max_speed, by_curve)});
  }
  const bool closed = path.ends == Ends::kClosed;
  if (!closed) limits_.back().squared_speed = 0.0;
  for (Limit& limit : limits_) {
    if (!closed && stop_s > 0.0 && limit.s >= stop_s) limit.squared_speed = 0.0;
  }
  for (int lap = 0; lap < (closed ? 2 : 1); ++lap) {  // braking may begin in the lap before
    if (closed) limits_.back().squared_speed = limits_.front().squared_speed;
    for (std::size_t i = limits_.size() - 1; i > 0; --i) {
      const double gain = 2.0 * param.max_deceleration * (limits_[i].s - limits_[i - 1].s);
      limits_[i - 1].squared_speed = std::min(limits_[i - 1].squared_speed, limits_[i].squared_speed + gain);
    }
  }
}

double SpeedProfile::limit(double s, std::size_t vertex) const {
  const Limit& before = limits_[std::min(vertex, limits_.size() - 1)];
  const Limit& after = limits_[std::min(vertex + 1, limits_.size() - 1)];
  const double ds = after.s - before.s;
  const double weight = ds > 0.0 ? std::clamp((s - before.s) / ds, 0.0, 1.0) : 0.0;
  return std::sqrt(before.squared_speed + weight * (after.squared_speed - before.squared_speed));
}

}  // namespace relative_map::core
