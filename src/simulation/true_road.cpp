#include "relative_map/simulation/true_road.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kStep = 0.5;        // [m] of the walk along a lane
constexpr double kEitherLane = 0.5;  // [m] from the line between two lanes: both may be meant

/// Looks up places that are near each other.
class Walk {
 public:
  Walk(const DrivePath& path, double s) : path_(path) {
    // A guess for evenly spaced vertices.
    const double share = path.hold(s) / path.length();
    vertex_ = static_cast<std::size_t>(share * static_cast<double>(path.points.size() - 1));
  }
  RoadPlace at(double s, double l) {
    const PathPoint point = interpolate(path_.points, path_.hold(s), vertex_);
    return {s, point.position + l * left_of(point.direction), point.direction};
  }

 private:
  const DrivePath& path_;
  std::size_t vertex_;
};

}  // namespace

RoadPlace TrueRoad::at(double s, double l) const {
  return Walk(path, s).at(s, l);
}

double TrueRoad::center_at(const TrueLane& lane, double s) const {
  return lane.l + 0.5 * (wave_at(lane.left_paint, s) + wave_at(lane.right_paint, s));
}

double TrueRoad::half_width_at(const TrueLane& lane, double s) const {
  return lane.half_width + 0.5 * (wave_at(lane.left_paint, s) - wave_at(lane.right_paint, s));
}

std::vector<RoadPlace> TrueRoad::ahead(const TrueLane& lane, double s,
                                       const std::vector<double>& distances) const {
  std::vector<RoadPlace> places;
  Walk walk(path, s);
  const auto center = [&](double at) { return walk.at(at, center_at(lane, at)); };
  RoadPlace here = center(s);
  double walked = 0.0;
  const double end = path.ends == Ends::kOpen ? std::min(end_s, path.length()) : end_s;
  for (const double distance : distances) {
    for (RoadPlace next = center(here.s + kStep);; next = center(here.s + kStep)) {
      const double length = (next.position - here.position).norm();
      if (next.s > end) return places;
      if (walked + length > distance) {
        places.push_back(center(here.s + kStep * (distance - walked) / length));
        break;
      }
      walked += length;
      here = next;
    }
  }
  return places;
}

std::vector<std::size_t> TrueRoad::lanes_at(double l) const {
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    const double left = i == 0 ? 1e9 : 0.5 * (lanes[i - 1].l + lanes[i].l);
    const double right = i + 1 == lanes.size() ? -1e9 : 0.5 * (lanes[i + 1].l + lanes[i].l);
    if (l < left + kEitherLane && l > right - kEitherLane) near.push_back(i);
  }
  return near;
}

}  // namespace relative_map::core
