#include "relative_map/prediction/lane_memory.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

constexpr double kSameLine = 1.0;    // [m] an estimate moves a line by less from map to map
constexpr double kMinSpacing = 0.5;  // [m] of what is remembered

/// What of `old` lies before the beginning of `line`, and at most `length` [m] of it.
Polyline passed(const Polyline& old, const Polyline& line, double length) {
  if (old.size() < 2 || line.empty()) return {};
  Foot nearest;
  nearest.squared_distance = kSameLine * kSameLine;
  bool found = false;
  for (std::size_t i = 0; i + 1 < old.size(); ++i) {
    Foot foot = project_on_segment(old[i], old[i + 1], line.front());
    if (foot.squared_distance > nearest.squared_distance) continue;
    foot.segment = i;
    nearest = foot;
    found = true;
  }
  if (!found) return {};
  Polyline past;  // from the new beginning backwards
  Point2 last = line.front();
  double sum = 0.0;
  for (std::size_t i = nearest.segment + 1; i-- > 0 && sum < length;) {
    const double step = (old[i] - last).norm();
    if (step < kMinSpacing) continue;
    sum += step;
    last = old[i];
    past.push_back(last);
  }
  std::reverse(past.begin(), past.end());
  return past;
}

}  // namespace

TrafficLanes LaneMemory::remember(TrafficLanes seen) {
  std::map<std::string, Polyline> lines;
  for (TrafficLane& lane : seen.lanes) {
    const auto known = lines_.find(lane.id);
    if (known != lines_.end()) {
      const Polyline past = passed(known->second, lane.center, length_);
      lane.center.insert(lane.center.begin(), past.begin(), past.end());
    }
    lines[lane.id] = lane.center;
  }
  lines_ = std::move(lines);
  return seen;
}

}  // namespace relative_map::core
