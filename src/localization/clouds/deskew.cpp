#include "relative_map/localization/clouds/deskew.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

Eigen::Isometry3d pose_at(const std::vector<TimedPose>& poses, double time) {
  auto after = std::upper_bound(poses.begin(), poses.end(), time,
                                [](double t, const TimedPose& pose) { return t < pose.time; });
  after = std::min(std::max(after, poses.begin() + 1), poses.end() - 1);
  const TimedPose& first = *(after - 1);
  const TimedPose& second = *after;
  const double share = (time - first.time) / (second.time - first.time);
  const Eigen::AngleAxisd turn(
      Eigen::Quaterniond(first.map_from_sensor.linear().transpose() * second.map_from_sensor.linear()));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = first.map_from_sensor.linear() *
                  Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
  pose.translation() =
      (1.0 - share) * first.map_from_sensor.translation() + share * second.map_from_sensor.translation();
  return pose;
}

std::string fault_in(const PointCloud& cloud, const std::vector<TimedPose>& poses, double reference,
                     double reach) {
  if (!cloud.has_time()) return "the points have no times";
  if (poses.size() < 2) return "there are fewer than two poses to carry the points by";
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (!(poses[i].time > poses[i - 1].time)) return "the poses are not in the order of their times";
  }
  const auto [first, last] = std::minmax_element(cloud.time.begin(), cloud.time.end());
  const double from = std::min(*first, reference), to = std::max(*last, reference);
  if (from >= poses.front().time - reach && to <= poses.back().time + reach) return "";
  return "the points' times reach beyond the poses'";
}

}  // namespace

PointCloud deskewed(const PointCloud& cloud, const std::vector<TimedPose>& poses, double reference,
                    double reach, std::string& fault) {
  fault = cloud.empty() ? "" : fault_in(cloud, poses, reference, reach);
  if (!fault.empty() || cloud.empty()) return cloud;
  const Eigen::Isometry3d reference_from_map = pose_at(poses, reference).inverse();
  PointCloud result = cloud;
  // The points of a firing share their time: most need no pose of their own.
  double known_time = cloud.time[0];
  Eigen::Isometry3d motion = reference_from_map * pose_at(poses, known_time);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.time[i] != known_time) {
      known_time = cloud.time[i];
      motion = reference_from_map * pose_at(poses, known_time);
    }
    result.points[i] = motion * cloud.points[i];
    result.time[i] = reference;
  }
  return result;
}

}  // namespace relative_map::core
