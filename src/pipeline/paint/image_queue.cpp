#include "relative_map/pipeline/paint/image_queue.hpp"

#include <cmath>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr std::size_t kMostWaiting = 50;  // images: a tick takes all of them
constexpr double kMirrored = 1.0;         // [m] right of left: not one of them is wrong, but both
constexpr double kFrozenReach = 15.0;     // [m] ahead, where odometry still knows where paint must be
constexpr double kFrozenError = 0.3;      // [m] that paint seems to have moved by

bool same_numbers(const Cubic& a, const Cubic& b) {
  return a.c0 == b.c0 && a.c1 == b.c1 && a.c2 == b.c2 && a.c3 == b.c3;
}

/// Whether paint that was where the cubic is, seen from `then`, is not where it is seen from now.
bool has_moved(const Cubic& cubic, const Pose2& now_from_then) {
  for (double x = 0.0; x <= kFrozenReach; x += 5.0) {
    const Point2 point = now_from_then.to_parent(Point2(x, cubic.value(x)));
    if (std::abs(point.y() - cubic.value(point.x())) > kFrozenError) return true;
  }
  return false;
}

}  // namespace

void ImageQueue::move(const VehicleState& localized) {
  VehicleState next = localized;
  next.map_from_base = last_ ? carried_on(*last_, to_seconds(localized.stamp - last_->stamp)) : Pose2();
  odometry_.add(next);
  last_ = next;
}

void ImageQueue::add(const LaneMarkers& markers) {
  if (waiting_.size() == kMostWaiting) waiting_.erase(waiting_.begin());
  waiting_.push_back(markers);
}

std::vector<ImageQueue::Image> ImageQueue::take(Time now, Time pose_stamp, const PipelineConfig& config,
                                                std::vector<std::string>& remarks) {
  std::vector<Image> images;
  for (const LaneMarkers& markers : waiting_) {
    if (to_seconds(now - markers.stamp) > config.max_age.lane_markers) continue;
    if (auto image = look_at(markers, pose_stamp, config, remarks)) images.push_back(std::move(*image));
  }
  waiting_.clear();
  return images;
}

bool ImageQueue::is_unchanged(const LaneMarkers& markers) {
  const auto unchanged = [](const LaneMarker& marker, Cubic& last) {
    if (!(marker.quality > 0.0)) return true;
    const bool same = same_numbers(marker.cubic, last);
    last = marker.cubic;
    return same;
  };
  const bool left = unchanged(markers.left, last_left_), right = unchanged(markers.right, last_right_);
  return left && right;
}

/// Paint does not move with the vehicle.
bool ImageQueue::is_frozen(const LaneMarkers& markers, bool unchanged) {
  if (!unchanged || !same_since_) {
    same_since_ = markers;
    frozen_ = false;
    return false;
  }
  const std::optional<Pose2> then = odometry_.at(same_since_->stamp), now = odometry_.at(markers.stamp);
  if (!then || !now) return frozen_;
  const Pose2 now_from_then = now->to_local(*then);
  for (const LaneMarker* marker : {&markers.left, &markers.right}) {
    if (marker->quality > 0.0 && has_moved(marker->cubic, now_from_then)) frozen_ = true;
  }
  // Odometry is good for a short while: look again from here.
  if (now_from_then.position().norm() > kFrozenReach) same_since_ = markers;
  return frozen_;
}

std::optional<ImageQueue::Image> ImageQueue::look_at(const LaneMarkers& markers, Time pose_stamp,
                                                     const PipelineConfig& config,
                                                     std::vector<std::string>& remarks) {
  const std::optional<Pose2> then = odometry_.at(markers.stamp), now = odometry_.at(pose_stamp);
  if (!then || !now) {
    remarks.push_back("lane markers: no pose is known for their stamp");
    return std::nullopt;
  }
  const bool unchanged = is_unchanged(markers);
  if (is_frozen(markers, unchanged)) {
    remarks.push_back("lane markers: they are frozen: the numbers stay the same while the vehicle moves");
    return std::nullopt;
  }
  const std::optional<std::string> left_fault = fault_of(markers.left, config.navigation_lane),
                                   right_fault = fault_of(markers.right, config.navigation_lane);
  if (left_fault && right_fault) {
    remarks.push_back("lane markers: left: " + *left_fault + "; right: " + *right_fault);
    return std::nullopt;
  }
  if (!left_fault && !right_fault && markers.left.cubic.c0 < markers.right.cubic.c0 - kMirrored) {
    std::ostringstream reason;
    reason << "lane markers: they are " << markers.left.cubic.c0 - markers.right.cubic.c0
           << " m apart, left of right positive: no lane";
    remarks.push_back(reason.str());
    return std::nullopt;
  }
  const Pose2 base_from_sensor = now->to_local(*then).to_parent(markers.base_from_sensor);
  Image image{markers.stamp, {}};
  image.sides.unchanged = unchanged;
  if (!left_fault)
    image.sides.left = sample_paint(markers.left, base_from_sensor, config.lane_fusion.noise.camera);
  if (!right_fault)
    image.sides.right = sample_paint(markers.right, base_from_sensor, config.lane_fusion.noise.camera);
  const auto nearest = [&](const std::vector<LaneMarker>& beyond) -> std::optional<PaintSamples> {
    if (beyond.empty() || fault_of(beyond.front(), config.navigation_lane)) return std::nullopt;
    return sample_paint(beyond.front(), base_from_sensor, config.lane_fusion.noise.camera);
  };
  image.sides.next_left = nearest(markers.next_left);
  image.sides.next_right = nearest(markers.next_right);
  return image;
}

}  // namespace relative_map::core
