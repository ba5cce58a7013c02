#include "relative_map/prediction/lane_view.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace relative_map::core {

namespace {

constexpr double kStep = 1.0;               // [m] between samples
constexpr double kMinSpacing = 0.05;        // [m] nearer vertices are one
constexpr double kDefaultHalfWidth = 1.75;  // [m] where a map gives none
constexpr double kCurvatureReach = 3.0;     // [m] to both sides, over which a curvature is measured
constexpr double kEndReach = 5.0;           // [m] of a lane's end that say where it goes on

/// Distinct points; fewer than two: no lane.
PathPoints distinct_points(const Polyline& center) {
  PathPoints points;
  for (const Point2& position : center) {
    if (!position.allFinite()) continue;
    if (!points.empty() && (position - points.back().position).norm() < kMinSpacing) continue;
    points.emplace_back();
    points.back().position = position;
  }
  return points;
}

void measure_curvature(ViewedLane& lane) {
  const auto count = static_cast<std::ptrdiff_t>(lane.samples.size());
  const auto reach = std::max<std::ptrdiff_t>(1, std::lround(kCurvatureReach / lane.step));
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const LaneSample& before = lane.samples[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, i - reach))];
    const LaneSample& after = lane.samples[static_cast<std::size_t>(std::min(count - 1, i + reach))];
    const double length = lane.step * static_cast<double>(std::min(count - 1, i + reach) -
                                                          std::max<std::ptrdiff_t>(0, i - reach));
    const double turn =
        std::atan2(cross(before.direction, after.direction), before.direction.dot(after.direction));
    lane.samples[static_cast<std::size_t>(i)].kappa = turn / length;
    lane.sharpest = std::max(lane.sharpest, std::abs(turn / length));
  }
  // Where the centerline just ends, its last vertex may point anywhere: the last metres say where it goes on.
  const std::size_t back = std::min(lane.samples.size() - 1, static_cast<std::size_t>(kEndReach / lane.step));
  const Point2 chord = lane.samples.back().position - lane.samples[lane.samples.size() - 1 - back].position;
  if (lane.successors.empty() && std::abs(lane.samples.back().kappa) < 0.01 && chord.norm() > 1.0) {
    lane.samples.back().direction = chord.normalized();
  }
}

bool sample_lane(const TrafficLane& source, ViewedLane& lane) {
  PathPoints points = distinct_points(source.center);
  if (points.size() < 2) return false;
  compute_arc_length(points);
  compute_geometry(points);
  lane.length = points.back().s;
  const auto steps = static_cast<std::size_t>(std::max(1.0, std::round(lane.length / kStep)));
  lane.step = lane.length / static_cast<double>(steps);
  lane.samples.resize(steps + 1);
  std::size_t hint = 0;
  for (std::size_t i = 0; i <= steps; ++i) {
    const PathPoint point = interpolate_smoothly(points, lane.step * static_cast<double>(i), hint);
    lane.samples[i].position = point.position;
    lane.samples[i].direction = {std::cos(point.theta), std::sin(point.theta)};
  }
  lane.low = lane.high = lane.samples.front().position;
  for (std::size_t i = 0; i < lane.samples.size(); ++i) {
    lane.low = lane.low.cwiseMin(lane.samples[i].position);
    lane.high = lane.high.cwiseMax(lane.samples[i].position);
    if (i > 0) {
      const Point2 &a = lane.samples[i - 1].direction, &b = lane.samples[i].direction;
      lane.turn += std::atan2(cross(a, b), a.dot(b));
    }
  }
  return true;
}

double width_or_default(double width) {
  return width > 0.5 && width < 10.0 ? width : kDefaultHalfWidth;
}

}  // namespace

LaneView::LaneView(const TrafficLanes& source) : junctions_(source.junctions) {
  std::unordered_map<std::string, std::size_t> index;
  std::vector<const TrafficLane*> sources;
  for (const TrafficLane& lane : source.lanes) {
    ViewedLane viewed;
    if (index.count(lane.id) > 0 || !sample_lane(lane, viewed)) continue;
    viewed.id = lane.id;
    viewed.left_width = width_or_default(lane.left_width);
    viewed.right_width = width_or_default(lane.right_width);
    viewed.speed_limit = lane.speed_limit > 0.0 && lane.speed_limit < 100.0 ? lane.speed_limit : 0.0;
    viewed.use = lane.use;
    viewed.in_junction = lane.in_junction;
    index.emplace(lane.id, lanes_.size());
    lanes_.push_back(std::move(viewed));
    sources.push_back(&lane);
  }
  const auto find_in_index = [&](const std::string& id) {
    const auto found = index.find(id);
    return found == index.end() ? kNoLane : found->second;
  };
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    for (const std::string& id : sources[i]->successors) {
      const std::size_t next = find_in_index(id);
      if (next != kNoLane && next != i) lanes_[i].successors.push_back(next);
    }
    lanes_[i].left_neighbor = find_in_index(sources[i]->left_neighbor);
    lanes_[i].right_neighbor = find_in_index(sources[i]->right_neighbor);
    measure_curvature(lanes_[i]);
  }
  ego_lane_ = find_in_index(source.ego_lane);
  for (const std::string& id : source.ego_targets) {
    if (find_in_index(id) != kNoLane) ego_targets_.push_back(find_in_index(id));
  }
}

std::size_t LaneView::find(const std::string& id) const {
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    if (lanes_[i].id == id) return i;
  }
  return kNoLane;
}

void LaneView::places(const Point2& point, double radius, std::vector<LanePlace>& result,
                      double beyond_end) const {
  result.clear();
  for (std::size_t index = 0; index < lanes_.size(); ++index) {
    const ViewedLane& lane = lanes_[index];
    const double reach = radius + (lane.successors.empty() ? beyond_end : 0.0);
    if ((point.array() < lane.low.array() - reach).any() ||
        (point.array() > lane.high.array() + reach).any()) {
      continue;
    }
    // A sample that is d away leaves nothing nearer than `best` within d - best along the lane: skip ahead.
    double best = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < lane.samples.size();) {
      const double distance = (point - lane.samples[i].position).norm();
      if (distance < best) {
        best = distance;
        nearest = i;
      }
      const double idle = (distance - std::min(best, radius + lane.step)) / lane.step;
      i += idle > 1.0 ? static_cast<std::size_t>(idle) : 1;
    }
    // Beside the straight on from its end no sample may be near.
    const LaneSample& end = lane.samples.back();
    if (lane.successors.empty() && (point - end.position).dot(end.direction) > 0.0 && best > radius) {
      nearest = lane.samples.size() - 1;
    }
    double s = 0.0, l = 0.0;
    const LaneSample& vertex = lane.samples[nearest];
    const double along = (point - vertex.position).dot(vertex.direction);
    LanePlace place;
    place.lane = index;
    const bool past_end = nearest + 1 == lane.samples.size() && along > 0.0;
    const bool before_start = nearest == 0 && along < 0.0;
    if (before_start || (past_end && (!lane.successors.empty() || along > beyond_end))) {
      if (best > 0.5 * lane.step) continue;  // another lane's, unless it is just at the joint
    }
    if (past_end) {
      s = lane.length + along;
      l = cross(vertex.direction, point - vertex.position);
    } else {
      const std::size_t first = nearest == 0 ? 0 : (along < 0.0 ? nearest - 1 : nearest);
      const std::size_t i = std::min(first, lane.samples.size() - 2);
      const Foot foot = project_on_segment(lane.samples[i].position, lane.samples[i + 1].position, point);
      s = lane.step * (static_cast<double>(i) + foot.fraction);
      const Point2 segment = lane.samples[i + 1].position - lane.samples[i].position;
      l = std::copysign(std::sqrt(foot.squared_distance), cross(segment, point - foot.point));
    }
    if (std::abs(l) > radius) continue;
    place.s = s;
    place.l = l;
    const Point2 direction = lane.at(s).direction;
    place.theta = std::atan2(direction.y(), direction.x());
    result.push_back(place);
  }
}

}  // namespace relative_map::core
