#pragma once

#include <Eigen/Geometry>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "relative_map/localization/ndt/ndt_start.hpp"
#include "relative_map/localization/ndt/ndt_tiles.hpp"
#include "relative_map/model/point_cloud.hpp"
#include "relative_map/ros/lidar/ndt_parameters.hpp"

namespace relative_map {

/// Loads the part of the map around the vehicle on a thread of its own; what is there is taken without
/// waiting. A newer wish replaces one that has not begun.
class NdtMapLoader {
 public:
  NdtMapLoader(core::NdtTileWindow window, double reload_distance);
  ~NdtMapLoader();
  NdtMapLoader(const NdtMapLoader&) = delete;
  NdtMapLoader& operator=(const NdtMapLoader&) = delete;

  struct Part {
    core::NdtMapPair maps;  ///< null grids: there is no tile here
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    std::vector<std::string> faults;
  };
  /// The newest part, none before the first is loaded; asks for another one if the place is far from its
  /// centre.
  std::optional<Part> part_for(const Eigen::Vector3d& place);
  const core::NdtMapInfo& info() const { return info_; }

 private:
  void run();

  core::NdtMapInfo info_;
  core::NdtTileWindow window_;  ///< the thread's alone
  double reload_distance_;
  std::mutex mutex_;
  std::condition_variable wished_;
  std::optional<Eigen::Vector3d> wish_;
  std::optional<Part> part_;
  bool loading_ = false, ends_ = false;
  std::thread thread_;
};

/// A pose of the vehicle in the map that somebody else says, with its motion.
struct ExpectedPose {
  double stamp = 0.0;  ///< [s]
  Eigen::Isometry3d map_from_base = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< [m/s] in the body frame
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s] in the body frame
  Eigen::Isometry3d at(double time) const;
};

/// What came of one cloud.
struct NdtEngineResult {
  bool matched = false;  ///< else `verdict.reasons` say why not
  Eigen::Isometry3d map_from_base = Eigen::Isometry3d::Identity();
  core::NdtVerdict verdict;
  double correction = 0.0;  ///< [m]
  int iterations = 0;
  int refused_in_a_row = 0;
  std::vector<std::string> map_faults;
};

/// Clouds in the base frame to poses in the map: tracks from cloud to cloud, and searches when asked to.
class NdtEngine {
 public:
  /// Throws std::runtime_error if there is no such map.
  explicit NdtEngine(const NdtNodeConfig& config);

  void on_odometry(const ExpectedPose& odometry);
  /// Begin here, searching within `radius` [m] and `yaw_range` [rad] to either side, with the next cloud.
  void start_at(const Eigen::Isometry3d& map_from_base, double radius, double yaw_range);
  /// Begin anew around where the vehicle was last; a sentence if that is not known.
  std::string start_again();

  /// `stamp` [s] of the cloud; points in the base frame.
  NdtEngineResult on_cloud(core::PointCloud cloud, double stamp);
  const core::NdtMapInfo& info() const { return loader_.info(); }

 private:
  struct Search {
    core::NdtStartRequest request;
  };
  std::optional<ExpectedPose> expected(double stamp) const;
  void search(const core::NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
              NdtEngineResult& result);
  void track(const core::NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
             const Eigen::Isometry3d& guess, NdtEngineResult& result);
  void remember(const NdtEngineResult& result, double stamp);

  NdtNodeConfig config_;
  NdtMapLoader loader_;
  std::optional<ExpectedPose> odometry_, own_;
  std::optional<Search> search_;
  int refused_ = 0;
};

}  // namespace relative_map
