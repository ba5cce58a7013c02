#pragma once

#include <dynamic_reconfigure/server.h>
#include <relative_map/LoadNavigationLines.h>
#include <relative_map/RelativeMapConfig.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_listener.h>

#include <array>
#include <boost/thread/recursive_mutex.hpp>
#include <memory>
#include <mutex>
#include <string>

#include "relative_map/ros/health/map_observer.hpp"
#include "relative_map/ros/health/throttled_log.hpp"
#include "relative_map/ros/map/map_engine.hpp"
#include "relative_map/ros/setup/raw_line.hpp"
#include "relative_map/ros/view/map_markers.hpp"

namespace relative_map {

/// Topics, timers and services around the map engine; the nodelet and the stand-alone node are shells of it.
/// Inputs and ticks run on the callback queue of the node handles; new lines are received and prepared on a
/// thread of their own, and a tick only picks up the finished pointer.
class RelativeMapNode {
 public:
  /// Throws std::runtime_error that names every bad parameter, before anything is advertised.
  RelativeMapNode(ros::NodeHandle nh, ros::NodeHandle private_nh);
  ~RelativeMapNode();

 private:
  template <class Message>
  using Handler = void (MapEngine::*)(const boost::shared_ptr<const Message>&, const ros::Time&);

  template <class Message>
  void subscribe(const std::string& topic, uint32_t queue_size, ros::Subscriber& subscriber,
                 Handler<Message> handler);
  void on_navigation(const NavigationInfoConstPtr& message);
  void on_timer(const ros::TimerEvent& event);
  void on_reconfigure(RelativeMapConfig& request, uint32_t level);
  bool on_load(LoadNavigationLines::Request& request, LoadNavigationLines::Response& response);
  void load_lines_of_parameter();
  void note_localization_frame(const std::string& frame_id);
  std::shared_ptr<const core::NavigationLines> prepare(const NavigationInfo& message);
  void take_lines(std::shared_ptr<const core::NavigationLines> lines);
  bool on_reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void pick_up_lines();
  void publish_views(const MapMsg& map);
  void log_status(const ros::WallTime& now);

  ros::NodeHandle nh_, private_nh_;
  NodeConfig config_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;
  MapEngine engine_;
  MapMarkers markers_;
  RawLine raw_line_;

  std::mutex intake_mutex_;  ///< guards the next three
  std::string localization_frame_;
  std::string line_folder_;  ///< that the service may load from; empty: any
  std::shared_ptr<const core::NavigationLines> new_lines_;
  core::PipelineConfig intake_config_;
  std::array<std::shared_ptr<const core::NavigationLines>, 2> kept_lines_;  ///< of the intake's thread
  ThrottledLog intake_log_;                                                 ///< likewise

  ros::Publisher map_publisher_, markers_publisher_, centerline_publisher_;
  ros::Subscriber localization_subscriber_, chassis_subscriber_, lane_markers_subscriber_;
  ros::ServiceServer reset_service_, load_service_;
  ros::Timer timer_;
  uint8_t logged_code_ = MapStatus::OK;
  ThrottledLog complaints_;

  MapObserver observer_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
  boost::recursive_mutex reconfigure_mutex_;  ///< the server wants one that outlives it
  std::unique_ptr<dynamic_reconfigure::Server<RelativeMapConfig>> reconfigure_;

  ros::CallbackQueue intake_queue_;
  ros::Subscriber navigation_subscriber_;
  ros::AsyncSpinner intake_spinner_;
};

}  // namespace relative_map
