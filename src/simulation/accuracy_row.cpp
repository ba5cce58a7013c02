#include "relative_map/simulation/accuracy_row.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

namespace relative_map::core {

namespace {

constexpr double kSecond = 0.95;  // [s] ten maps
constexpr std::size_t kAt10 = 2;  // of kErrorDistances

}  // namespace

double ErrorStatistics::rms() const {
  double sum = 0.0;
  for (const double error : errors_) sum += error * error;
  return std::sqrt(sum / static_cast<double>(errors_.size()));  // NaN: 0 / 0
}

double ErrorStatistics::percentile(double share) const {
  if (errors_.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sizes;
  for (const double error : errors_) sizes.push_back(std::abs(error));
  const auto nth = sizes.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), nth, sizes.end());
  return *nth;
}

void AccuracyRow::add(const MeasuredMap& map) {
  const MapErrors& errors = map.errors;
  for (std::size_t i = 0; i < center.size(); ++i) center[i].add(errors.center[i]);
  boundary.add(errors.left_boundary);
  boundary.add(errors.right_boundary);
  half_width.add(errors.left_half_width);
  half_width.add(errors.right_half_width);
  heading.add(errors.heading);
  jitter_10.add(errors.jitter_10);
  jitter_30.add(errors.jitter_30);
  cost.add(map.cost);
  if (errors.usable) {
    ++usable_of;
    if (*errors.usable) ++usable;
  }
  if (errors.consistent) {
    ++consistent_of;
    if (*errors.consistent) ++consistent;
  }
  if (map.painted) ++painted;
  violations += map.violations;
  if (violation.empty()) violation = map.violation;
}

void AccuracyRow::add(const std::vector<MeasuredMap>& drive) {
  std::deque<std::pair<double, double>> second;  // times [s] and squared errors [m^2]
  double sum = 0.0;
  for (const MeasuredMap& map : drive) {
    add(map);
    if (!map.errors.center[kAt10]) continue;
    const double error = *map.errors.center[kAt10];
    second.emplace_back(map.time, error * error);
    sum += error * error;
    for (; map.time - second.front().first >= kSecond; second.pop_front()) sum -= second.front().second;
    worst_second =
        std::fmax(worst_second, std::sqrt(std::max(0.0, sum) / static_cast<double>(second.size())));
  }
}

void AccuracyRow::add(const AccuracyRow& other) {
  for (std::size_t i = 0; i < center.size(); ++i) center[i].add(other.center[i]);
  boundary.add(other.boundary);
  half_width.add(other.half_width);
  heading.add(other.heading);
  jitter_10.add(other.jitter_10);
  jitter_30.add(other.jitter_30);
  cost.add(other.cost);
  usable += other.usable;
  usable_of += other.usable_of;
  consistent += other.consistent;
  consistent_of += other.consistent_of;
  painted += other.painted;
  worst_second = std::fmax(worst_second, other.worst_second);
  violations += other.violations;
  if (violation.empty()) violation = other.violation;
}

}  // namespace relative_map::core
