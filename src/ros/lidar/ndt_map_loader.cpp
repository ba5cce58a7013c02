#include "relative_map/ros/lidar/ndt_engine.hpp"

namespace relative_map {

NdtMapLoader::NdtMapLoader(core::NdtTileWindow window, double reload_distance)
    : info_(window.info()),
      window_(std::move(window)),
      reload_distance_(reload_distance),
      thread_([this] { run(); }) {}

NdtMapLoader::~NdtMapLoader() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  wished_.notify_all();
  thread_.join();
}

std::optional<NdtMapLoader::Part> NdtMapLoader::part_for(const Eigen::Vector3d& place) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool near = part_ && (part_->centre - place).head<2>().norm() < reload_distance_;
  if (!near && !loading_) {
    wish_ = place;
    wished_.notify_all();
  }
  return part_;
}

void NdtMapLoader::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    wished_.wait(lock, [this] { return ends_ || wish_; });
    if (ends_) return;
    const Eigen::Vector3d place = *wish_;
    wish_.reset();
    loading_ = true;
    lock.unlock();
    Part part;
    part.centre = place;
    part.maps = window_.around(place);
    part.faults = window_.faults();
    lock.lock();
    part_ = std::move(part);
    loading_ = false;
  }
}

}  // namespace relative_map
