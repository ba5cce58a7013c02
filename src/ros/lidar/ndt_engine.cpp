#include "relative_map/ros/lidar/ndt_engine.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/io/ndt_map_file.hpp"
#include "relative_map/localization/clouds/cloud_filters.hpp"
#include "relative_map/localization/clouds/deskew.hpp"

namespace relative_map {

namespace {

constexpr double kVoxelBytes = 110.0;  // of a voxel in memory, its place in the containers included

core::NdtTileWindow window_of(const NdtNodeConfig& config) {
  const core::NdtMapInfo info = core::read_ndt_map_info(config.map);
  const auto most = static_cast<std::size_t>(1e6 * config.map_memory / kVoxelBytes);
  return core::NdtTileWindow(info, config.map_radius, most,
                             [folder = config.map, info](const core::TileKey& key) {
                               return core::read_ndt_tile(folder, info, key);
                             });
}

NdtEngineResult refused(const std::string& why) {
  NdtEngineResult result;
  result.verdict.reasons.push_back(why);
  return result;
}

/// A sweep as if all of it had been seen at its stamp.
void straighten(core::PointCloud& cloud, const ExpectedPose& motion) {
  if (!cloud.has_time()) return;
  const auto [first, last] = std::minmax_element(cloud.time.begin(), cloud.time.end());
  if (!(*last > *first) || *last - *first > 1.0) return;  // more than a second is no sweep
  ExpectedPose from = motion;
  from.stamp = 0.0;
  from.map_from_base = Eigen::Isometry3d::Identity();
  std::vector<core::TimedPose> poses;
  for (int i = 0; i <= 10; ++i) {
    const double time = *first + 0.1 * i * (*last - *first);
    poses.push_back({time, from.at(time)});
  }
  std::string fault;
  cloud = core::deskewed(cloud, poses, 0.0, 1.0, fault);
}

}  // namespace

Eigen::Isometry3d ExpectedPose::at(double time) const {
  const double dt = time - stamp;
  const Eigen::Vector3d turn = dt * angular_velocity;
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation() = dt * velocity;
  if (turn.norm() > 0.0)
    motion.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  return map_from_base * motion;
}

NdtEngine::NdtEngine(const NdtNodeConfig& config)
    : config_(config), loader_(window_of(config), config.map_reload) {}

void NdtEngine::on_odometry(const ExpectedPose& odometry) {
  odometry_ = odometry;
}

void NdtEngine::start_at(const Eigen::Isometry3d& map_from_base, double radius, double yaw_range) {
  core::NdtStartRequest request;
  request.around = map_from_base;
  request.radius = radius;
  request.yaw_range = yaw_range;
  search_ = Search{request};
}

std::string NdtEngine::start_again() {
  const auto& known = odometry_ ? odometry_ : own_;
  if (!known) return "nothing is known of the place: publish odometry in the map's frame, or initialpose";
  start_at(known->map_from_base, config_.start_radius, core::NdtStartRequest().yaw_range);
  return "";
}

std::optional<ExpectedPose> NdtEngine::expected(double stamp) const {
  if (odometry_ && std::abs(stamp - odometry_->stamp) <= config_.max_age_odometry) return odometry_;
  if (own_ && std::abs(stamp - own_->stamp) <= config_.max_gap) return own_;
  return std::nullopt;
}

NdtEngineResult NdtEngine::on_cloud(core::PointCloud cloud, double stamp) {
  const std::optional<ExpectedPose> known = expected(stamp);
  if (!known && !search_) {
    return refused("nothing is known of the place: publish odometry in the map's frame, or initialpose");
  }
  const Eigen::Isometry3d guess = search_ ? search_->request.around : known->at(stamp);
  const std::optional<NdtMapLoader::Part> part = loader_.part_for(guess.translation());
  if (!part || (part->centre - guess.translation()).head<2>().norm() > config_.map_radius) {
    return refused("the map around the vehicle is still being loaded");
  }
  if (known) straighten(cloud, *known);
  const std::vector<Eigen::Vector3d> points =
      core::voxel_filter(core::crop(cloud, config_.near, config_.far), config_.leaf).points;
  NdtEngineResult result;
  if (part->maps.fine == nullptr) {
    result = refused("the map has nothing here");
  } else if (search_) {
    search(part->maps, points, result);
  } else {
    track(part->maps, points, guess, result);
  }
  result.correction = (result.map_from_base.translation() - guess.translation()).norm();
  result.map_faults = part->faults;
  remember(result, stamp);
  result.refused_in_a_row = refused_;
  return result;
}

void NdtEngine::search(const core::NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
                       NdtEngineResult& result) {
  const core::NdtStart start =
      core::find_start(maps, points, search_->request, config_.match, config_.belief);
  result.matched = true;
  result.map_from_base = start.best.target_from_source;
  result.iterations = start.best.iterations;
  result.verdict = start.verdict;
  if (!start.reliable) {
    result.verdict.believed = false;
    if (result.verdict.reasons.empty()) result.verdict.reasons.push_back(start.why_not);
    return;  // and again with the next cloud
  }
  search_.reset();
  own_.reset();  // the motion since the last match is none
}

void NdtEngine::track(const core::NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
                      const Eigen::Isometry3d& guess, NdtEngineResult& result) {
  const core::NdtAlignment found = core::align(maps, points, guess, config_.match);
  core::NdtExpectation expected;
  expected.guess = guess;
  result.matched = true;
  result.map_from_base = found.target_from_source;
  result.iterations = found.iterations;
  result.verdict = core::judge(maps, points, found, expected, config_.belief);
}

void NdtEngine::remember(const NdtEngineResult& result, double stamp) {
  if (!result.verdict.believed) {
    ++refused_;
    // Lost: what the last matches said of the place is worth nothing any more.
    if (refused_ >= config_.refusals) own_.reset();
    return;
  }
  refused_ = 0;
  ExpectedPose now;
  now.stamp = stamp;
  now.map_from_base = result.map_from_base;
  const double dt = own_ ? stamp - own_->stamp : 0.0;
  if (dt > 1e-3 && dt <= config_.max_gap) {
    const Eigen::Isometry3d motion = own_->map_from_base.inverse() * now.map_from_base;
    const Eigen::AngleAxisd turn(motion.linear());
    now.velocity = motion.translation() / dt;
    now.angular_velocity = turn.angle() * turn.axis() / dt;
  }
  own_ = now;
}

}  // namespace relative_map
