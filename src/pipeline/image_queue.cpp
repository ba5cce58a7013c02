#include "relative_map/pipeline/image_queue.hpp"

#include <sstream>

namespace relative_map::core {

namespace {

constexpr std::size_t kMostWaiting = 50;  // images: a tick takes all of them

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
    const Time age = now - markers.stamp;
    if (to_seconds(age) > config.max_age.lane_markers) {
      remarks.push_back("lane markers: they are " + std::to_string(to_seconds(age)) + " s old");
    } else if (auto image = look_at(markers, pose_stamp, config, remarks)) {
      images.push_back(std::move(*image));
    }
  }
  waiting_.clear();
  return images;
}

std::optional<ImageQueue::Image> ImageQueue::look_at(const LaneMarkers& markers, Time pose_stamp,
                                                     const PipelineConfig& config,
                                                     std::vector<std::string>& remarks) const {
  const std::optional<Pose2> then = odometry_.at(markers.stamp), now = odometry_.at(pose_stamp);
  if (!then || !now) {
    remarks.push_back("lane markers: no pose is known for their stamp");
    return std::nullopt;
  }
  const std::optional<std::string> left_fault = fault_of(markers.left, config.navigation_lane),
                                   right_fault = fault_of(markers.right, config.navigation_lane);
  if (left_fault && right_fault) {
    remarks.push_back("lane markers: left: " + *left_fault + "; right: " + *right_fault);
    return std::nullopt;
  }
  if (!left_fault && !right_fault && markers.left.cubic.c0 <= markers.right.cubic.c0) {
    std::ostringstream reason;
    reason << "lane markers: they are " << markers.left.cubic.c0 - markers.right.cubic.c0
           << " m apart, left of right positive: no lane";
    remarks.push_back(reason.str());
    return std::nullopt;
  }
  const Pose2 base_from_sensor = now->to_local(*then).to_parent(markers.base_from_sensor);
  Image image{markers.stamp, {}};
  if (!left_fault) image.sides.left = sample_paint(markers.left, base_from_sensor);
  if (!right_fault) image.sides.right = sample_paint(markers.right, base_from_sensor);
  return image;
}

}  // namespace relative_map::core
