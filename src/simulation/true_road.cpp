#include "relative_map/simulation/true_road.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kStep = 0.5;        // [m] of the walk along a lane
constexpr double kEitherLane = 0.5;  // [m] from the line between two lanes: both may be meant

class Walk {
 public:
  Walk(const DrivePath& path, double l, double s) : path_(path), l_(l) {
    // A guess for evenly spaced vertices.
    const double share = path.hold(s) / path.length();
    vertex_ = static_cast<std::size_t>(share * static_cast<double>(path.points.size() - 1));
  }
  RoadPlace at(double s) {
    const PathPoint point = interpolate(path_.points, path_.hold(s), vertex_);
    return {s, point.position + l_ * left_of(point.direction), point.direction};
  }

 private:
  const DrivePath& path_;
  double l_;
  std::size_t vertex_;
};

}  // namespace

RoadPlace TrueRoad::at(double s, double l) const {
  return Walk(path, l, s).at(s);
}

std::vector<RoadPlace> TrueRoad::ahead(const TrueLane& lane, double s,
                                       const std::vector<double>& distances) const {
  std::vector<RoadPlace> places;
  Walk walk(path, lane.l, s);
  RoadPlace here = walk.at(s);
  double walked = 0.0;
  const double end = path.ends == Ends::kOpen ? std::min(end_s, path.length()) : end_s;
  for (const double distance : distances) {
    for (RoadPlace next = walk.at(here.s + kStep);; next = walk.at(here.s + kStep)) {
      const double length = (next.position - here.position).norm();
      if (next.s > end) return places;
      if (walked + length > distance) {
        places.push_back(walk.at(here.s + kStep * (distance - walked) / length));
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
