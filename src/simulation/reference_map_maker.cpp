#include <algorithm>
#include <cmath>
#include <limits>

#include "relative_map/simulation/reference_filter.hpp"

namespace relative_map::core {

namespace {

constexpr double kBehind = 10.0, kAhead = 120.0;  // [m] of a line that is looked at
constexpr double kReach = 20.0;                   // [m] to the side, where a line may be
constexpr double kLeave = 0.5;                    // [m] by which another line must be nearer
constexpr double kSampleStep = 5.0;               // [m] between the samples of a marker
constexpr double kSampleReach = 40.0;             // [m] of the farthest
constexpr double kTurn = 0.5;                     // [rad] up to which a curve is sampled
constexpr double kMinQuality = 0.5;
constexpr double kPatience = 2.0;  // [s] that paint is left out before the filter doubts itself
constexpr double kHold = 4.0;      // [s] that markers' own shape is followed without them
constexpr Duration kPoseMemory = std::chrono::seconds(2);

bool usable(const LaneMarker& marker) {
  return marker.quality >= kMinQuality && marker.view_range > marker.longitude_start + 1.0;
}

}  // namespace

ReferenceMapMaker::ReferenceMapMaker(const NavigationInfo& navigation) {
  for (const RecordedLine& recorded : navigation.lines) {
    Line line{recorded, {}, 0.0};
    for (const LinePoint& point : recorded.points) line.points.push_back({point.x, point.y});
    const bool closed = (line.points.front() - line.points.back()).norm() < 2.0;
    line.length = closed ? std::numeric_limits<double>::infinity() : chord_length(line.points);
    if (closed) {
      const Polyline lap = line.points;
      for (int i = 0; i < 2; ++i) line.points.insert(line.points.end(), lap.begin(), lap.end());
    }
    lines_.push_back(std::move(line));
  }
}

void ReferenceMapMaker::deliver(const Delivery& delivery) {
  if (const auto* localization = std::get_if<Localization>(&delivery.message)) {
    if (!poses_.empty() && localization->stamp <= poses_.back().stamp) return;
    poses_.push_back({localization->stamp, Pose2(localization->position.head<2>(), localization->heading)});
    while (poses_.back().stamp - poses_.front().stamp > kPoseMemory) poses_.erase(poses_.begin());
  } else if (const auto* markers = std::get_if<LaneMarkers>(&delivery.message)) {
    if (markers->stamp > last_image_) see(*markers);
  }
}

std::optional<Pose2> ReferenceMapMaker::pose_at(Time stamp) const {
  if (poses_.empty() || stamp < poses_.front().stamp) return std::nullopt;
  const auto after = std::find_if(poses_.begin(), poses_.end(),
                                  [&](const StampedPose& pose) { return pose.stamp >= stamp; });
  if (after == poses_.end()) return poses_.back().pose;
  if (after == poses_.begin()) return after->pose;
  const StampedPose &a = *(after - 1), &b = *after;
  const double weight = to_seconds(stamp - a.stamp) / to_seconds(b.stamp - a.stamp);
  return Pose2(a.pose.position() + weight * (b.pose.position() - a.pose.position()),
               interpolate_angle(a.pose.heading(), b.pose.heading(), weight));
}

std::optional<ReferenceMapMaker::Curve> ReferenceMapMaker::cut(const Line& line, const Pose2& pose) const {
  const Polyline& points = line.points;
  std::size_t nearest = points.size();
  double distance = kReach * kReach;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double here = (points[i] - pose.position()).squaredNorm();
    if (here >= distance || pose.forward().dot(points[i + 1] - points[i]) <= 0.0) continue;
    distance = here;
    nearest = i;
  }
  if (nearest == points.size()) return std::nullopt;
  Curve curve;
  std::size_t first = nearest, last = nearest + 1;
  for (double s = 0.0; first > 0 && s < kBehind; --first) s += (points[first] - points[first - 1]).norm();
  for (double s = 0.0; last + 1 < points.size() && s < kAhead; ++last) {
    s += (points[last + 1] - points[last]).norm();
  }
  for (std::size_t i = first; i <= last; ++i) curve.points.push_back(pose.to_local(points[i]));
  double squared = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
    const Foot foot = project_on_segment(curve.points[i], curve.points[i + 1], Point2::Zero());
    if (foot.squared_distance >= squared) continue;
    squared = foot.squared_distance;
    curve.beside = i;
    curve.lateral = std::copysign(std::sqrt(squared), foot.point.y());
  }
  curve.remaining =
      std::isinf(line.length)
          ? line.length
          : chord_length(Polyline(points.begin() + static_cast<std::ptrdiff_t>(nearest), points.end()));
  return curve;
}

std::optional<ReferenceMapMaker::Curve> ReferenceMapMaker::nearest_line(const Pose2& pose) {
  std::optional<Curve> best, current;
  std::string name;
  for (const Line& line : lines_) {
    std::optional<Curve> curve = cut(line, pose);
    if (!curve) continue;
    const auto away = [&](const Curve& c) { return std::abs(c.lateral + filter_.offset()); };
    if (line.recorded.name == current_) current = curve;
    if (best && away(*best) <= away(*curve)) continue;
    best = curve;
    name = line.recorded.name;
  }
  if (!best) return best;
  if (current &&
      std::abs(current->lateral + filter_.offset()) < std::abs(best->lateral + filter_.offset()) + kLeave) {
    return current;
  }
  if (!current_.empty() && name != current_) filter_.forget_widths();
  current_ = name;
  return best;
}

bool ReferenceMapMaker::update(const LaneMarker& marker, bool left, const Curve& curve) {
  if (!usable(marker)) return false;
  std::vector<ReferenceFilter::Sample> samples;
  const double end = std::min(marker.view_range, kSampleReach);
  std::size_t segment = curve.beside;
  for (double x = marker.longitude_start; x <= end; x += kSampleStep) {
    while (segment + 2 < curve.points.size() && curve.points[segment + 1].x() < x) ++segment;
    const Point2 &a = curve.points[segment], along = curve.points[segment + 1] - a;
    if (along.x() < std::cos(kTurn) * along.norm() || x > a.x() + along.x() + 1.0) break;
    const double y = a.y() + (x - a.x()) / along.x() * along.y();
    samples.push_back({x, marker.cubic.value(x) - y, along.norm() / along.x()});
  }
  return !samples.empty() && filter_.update(left, samples);
}

/// How the paint of an image is bent: the lane's shape where no line tells it. None: no paint.
std::optional<Cubic> bend_of(const LaneMarkers& markers) {
  Cubic bend;
  double seen = 0.0;
  for (const LaneMarker* marker : {&markers.left, &markers.right}) {
    if (!usable(*marker)) continue;
    seen += 1.0;
    bend.c2 += marker->cubic.c2;
    bend.c3 += marker->cubic.c3;
  }
  if (seen == 0.0) return std::nullopt;
  bend.c2 /= seen;
  bend.c3 /= seen;
  return bend;
}

/// A cubic up to `range` [m], and then on as it is bent there.
Polyline lane_along(const Cubic& cubic, double range) {
  Polyline points;
  for (double x = -kBehind; x <= range; x += 1.0) {
    points.emplace_back(x, x < 0.0 ? cubic.c0 + cubic.c1 * x : cubic.value(x));
  }
  const double start = points.back().x(), heading = std::atan(cubic.slope(start)), kappa = cubic.kappa(start);
  for (double s = 1.0; s < kAhead - range; s += 1.0) {
    points.push_back(points.back() + Point2(std::cos(heading + kappa * s), std::sin(heading + kappa * s)));
  }
  return points;
}

/// Without a recorded line the lane goes on where it was, bent as the new paint is, and lies in the map.
bool ReferenceMapMaker::follow_paint(const LaneMarkers& markers, const Pose2& pose) {
  const std::optional<Cubic> bend = bend_of(markers);
  if (!bend) return true;
  if (const std::optional<Curve> before = shape_ ? cut(*shape_, pose) : std::nullopt) {
    const Point2 along = before->points[before->beside + 1] - before->points[before->beside];
    filter_.shift(before->lateral - filter_.offset(), std::atan2(along.y(), along.x()) - filter_.heading());
  } else {
    filter_.restart();
  }
  const double range = std::max(markers.left.view_range, markers.right.view_range);
  Curve curve;
  curve.points = lane_along(*bend, range);
  const bool left = update(markers.left, true, curve), right = update(markers.right, false, curve);
  shape_.emplace();
  for (const Point2& point : lane_along({filter_.offset(), filter_.heading(), bend->c2, bend->c3}, range)) {
    shape_->points.push_back(pose.to_parent(point));
  }
  shape_->length = kAhead;
  return left || right;
}

/// Whether paint was used, or there was none to be used.
bool ReferenceMapMaker::follow_line(const LaneMarkers& markers, const Pose2& pose) {
  const std::optional<Curve> curve = nearest_line(pose);
  if (!curve) return true;
  const bool left = update(markers.left, true, *curve), right = update(markers.right, false, *curve);
  return left || right || !(usable(markers.left) || usable(markers.right));
}

void ReferenceMapMaker::see(const LaneMarkers& markers) {
  const std::optional<Pose2> pose = pose_at(markers.stamp);
  if (!pose) return;
  if (last_image_ > Time()) filter_.predict(to_seconds(markers.stamp - last_image_));
  last_image_ = markers.stamp;
  const bool used = lines_.empty() ? follow_paint(markers, *pose) : follow_line(markers, *pose);
  if (used) {
    last_used_ = markers.stamp;
  } else if (to_seconds(markers.stamp - last_used_) > kPatience) {
    filter_.doubt();
    shape_.reset();
    last_used_ = markers.stamp;
  }
}

Lane ReferenceMapMaker::make_lane(const Curve& curve) const {
  Lane lane;
  lane.id = lane.name = shape_ ? "markers" : current_;
  PathPoints line;
  for (const Point2& point : curve.points) {
    if (!line.empty() && (point - line.back().position).norm() < 1e-6) continue;
    line.emplace_back();
    line.back().position = point;
  }
  compute_arc_length(line);
  compute_geometry(line);
  const double half_widths[] = {filter_.half_width(true), filter_.half_width(false)};
  for (const PathPoint& point : line) {
    const double ahead = std::clamp(point.position.x(), 0.0, kSampleReach);
    const Point2 left = left_of(point.direction);
    lane.path.push_back(point);
    if (!shape_) lane.path.back().position += (filter_.offset() + filter_.heading() * ahead) * left;
    const Point2& center = lane.path.back().position;
    lane.left_boundary.points.push_back(center + half_widths[0] * left);
    lane.right_boundary.points.push_back(center - half_widths[1] * left);
  }
  compute_arc_length(lane.path);
  lane.length = lane.path.back().s;
  lane.remaining_distance = curve.remaining;
  for (const PathPoint& point : lane.path) {
    lane.left_samples.push_back({point.s, half_widths[0]});
    lane.right_samples.push_back({point.s, half_widths[1]});
  }
  return lane;
}

RelativeMap ReferenceMapMaker::tick(Time now) {
  RelativeMap map;
  map.stamp = poses_.empty() ? now : poses_.back().stamp;
  map.sequence_num = ++sequence_num_;
  if (poses_.empty()) return map;
  if (lines_.empty() && to_seconds(now - last_used_) > kHold) shape_.reset();
  if (lines_.empty() && !shape_) return map;
  const Pose2& pose = poses_.back().pose;
  const std::optional<Curve> curve = shape_ ? cut(*shape_, pose) : nearest_line(pose);
  if (!curve || curve->points.size() < 3) return map;
  map.lanes.push_back(make_lane(*curve));
  map.current_lane_id = map.lanes.back().id;
  map.fusion.source = to_seconds(now - last_used_) < 0.5 ? Source::kFused : Source::kNavigationLine;
  map.fusion.lateral_offset = {filter_.offset(), filter_.offset_stddev()};
  return map;
}

}  // namespace relative_map::core
