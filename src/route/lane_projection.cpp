#include "relative_map/route/lane_projection.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kSamePoint = 1e-7;  // [m]

}  // namespace

LaneLine::LaneLine(const Polyline& centerline) {
  for (const Point2& position : centerline) {
    if (!points_.empty() && (position - points_.back().position).norm() < kSamePoint) continue;
    PathPoint point;
    point.position = position;
    points_.push_back(point);
  }
  compute_arc_length(points_);
  compute_geometry(points_);
  index_ = SegmentIndex(points_, Ends::kOpen);
}

LaneProjection LaneLine::from_foot(const Foot& foot, const Point2& point) const {
  const Point2 chord = points_[foot.segment + 1].position - points_[foot.segment].position;
  const double length = chord.norm();
  const Point2 direction = chord / length;
  const Point2 offset = point - points_[foot.segment].position;
  LaneProjection place;
  place.distance = std::sqrt(foot.squared_distance);
  place.heading = std::atan2(direction.y(), direction.x());
  const double across = cross(direction, offset), along = direction.dot(offset);
  const bool before = foot.segment == 0 && along < 0.0;
  const bool past = foot.segment + 2 == points_.size() && along > length;
  if (before || past) {
    place.s = points_[foot.segment].s + along;
    place.l = across;
  } else {
    place.s = points_[foot.segment].s + foot.fraction * length;
    place.l = std::copysign(place.distance, across);
  }
  return place;
}

LaneProjection LaneLine::project(const Point2& point) const {
  return from_foot(index_.nearest(points_, point), point);
}

std::vector<LaneProjection> LaneLine::passes(const Point2& point, double max_distance) const {
  std::vector<LaneProjection> places;
  for (const Foot& foot : index_.passes(points_, point, max_distance)) {
    places.push_back(from_foot(foot, point));
  }
  return places;
}

std::size_t LaneLine::chord_at(double s) const {
  const auto after = std::upper_bound(points_.begin() + 1, points_.end() - 1, s,
                                      [](double value, const PathPoint& point) { return value < point.s; });
  return static_cast<std::size_t>(after - points_.begin()) - 1;
}

Point2 LaneLine::point_at(double s) const {
  const std::size_t i = chord_at(s);
  const double chord = points_[i + 1].s - points_[i].s;
  const double weight = std::clamp((s - points_[i].s) / chord, 0.0, 1.0);
  return points_[i].position + weight * (points_[i + 1].position - points_[i].position);
}

double LaneLine::heading_at(double s) const {
  const std::size_t i = chord_at(s);
  const Point2 chord = points_[i + 1].position - points_[i].position;
  return std::atan2(chord.y(), chord.x());
}

}  // namespace relative_map::core
