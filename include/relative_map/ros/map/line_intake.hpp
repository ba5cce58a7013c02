#pragma once

#include <relative_map/LoadNavigationLines.h>
#include <relative_map/NavigationInfo.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "relative_map/ros/health/node_log.hpp"
#include "relative_map/ros/health/throttled_log.hpp"
#include "relative_map/ros/map/map_engine.hpp"

namespace relative_map {

/// Receives new lines, by message, service or parameter, and prepares them on the thread that serves its
/// queue; a tick only picks up the finished pointer.
class LineIntake {
 public:
  /// `folder`: that the service may load from; empty: any.
  LineIntake(const NodeConfig& config, std::string folder, NodeLog log);

  /// Drives on these files from the start; none: does nothing. Throws std::runtime_error for what can't be
  /// driven on. Before `listen`.
  void load(const std::vector<std::string>& files);
  /// Subscribes to `navigation` and offers ~load_navigation_lines, both on `queue`, which one thread serves.
  void listen(ros::NodeHandle nh, ros::NodeHandle private_nh, ros::CallbackQueueInterface& queue);

  /// Those that came since the last call; null: none did.
  std::shared_ptr<const core::NavigationLines> take();
  void set_config(const core::PipelineConfig& config);
  /// Lines of files must be in the same frame.
  void note_localization_frame(const std::string& frame_id);

 private:
  std::shared_ptr<const core::NavigationLines> prepare(const NavigationInfo& message);
  void hand_over(std::shared_ptr<const core::NavigationLines> lines);
  bool on_load(LoadNavigationLines::Request& request, LoadNavigationLines::Response& response);

  const NodeLog log_;
  const std::string folder_;
  const std::string map_frame_;
  const std::map<std::string, double> speed_limits_;
  std::mutex mutex_;  ///< guards the next three
  std::string localization_frame_;
  std::shared_ptr<const core::NavigationLines> new_lines_;
  core::PipelineConfig config_;
  std::array<std::shared_ptr<const core::NavigationLines>, 2> kept_lines_;  ///< of the thread
  ThrottledLog told_;                                                       ///< likewise

  // What calls back comes last: it goes first.
  ros::Subscriber subscriber_;
  ros::ServiceServer load_service_;
};

}  // namespace relative_map
