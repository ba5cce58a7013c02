#pragma once

#include <dynamic_reconfigure/server.h>
#include <relative_map/RelativeMapConfig.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>

#include <boost/thread/recursive_mutex.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/ros/health/input_health.hpp"
#include "relative_map/ros/health/map_observer.hpp"
#include "relative_map/ros/health/node_log.hpp"
#include "relative_map/ros/health/status_log.hpp"
#include "relative_map/ros/map/line_intake.hpp"
#include "relative_map/ros/map/map_engine.hpp"
#include "relative_map/ros/setup/raw_line.hpp"
#include "relative_map/ros/view/map_markers.hpp"

namespace relative_map {

/// Topics, timers and services around the map engine; the nodelet and the stand-alone node are shells of it.
/// Inputs and ticks run on the callback queue of the node handles, one at a time. What people ask for (lines,
/// files, other parameters) is served by a thread of its own, and a tick picks up what came of it.
class RelativeMapNode {
 public:
  /// Throws std::runtime_error that names every bad parameter, before anything is advertised; nothing of a
  /// node whose constructor throws calls back any more.
  RelativeMapNode(ros::NodeHandle nh, ros::NodeHandle private_nh);

 private:
  template <class Message>
  using Handler = void (MapEngine::*)(const boost::shared_ptr<const Message>&, const ros::Time&);

  void advertise();
  void expect_lines();
  template <class Message>
  InputHealth& expect(const std::string& topic, double min_rate, double max_age, bool needed);
  void serve_requests();
  void listen();
  template <class Message>
  void subscribe(const std::string& topic, uint32_t queue_size, Handler<Message> handler,
                 InputHealth& health);
  void subscribe_transforms(const std::string& topic, bool is_static);
  void on_timer();
  void on_reconfigure(RelativeMapConfig& request);
  void look_at_types();
  bool on_reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void pick_up_requests();
  void publish_views(const MapMsg& map);
  void log_status(const ros::WallTime& now);

  // Nothing of what follows calls back.
  ros::NodeHandle nh_, private_nh_;
  NodeLog log_;
  NodeConfig config_;
  tf2::BufferCore transforms_;
  MapEngine engine_;
  MapMarkers markers_;
  RawLine raw_line_;
  ros::Time last_tick_;
  StatusLog status_log_;
  ros::Publisher map_publisher_, markers_publisher_, centerline_publisher_;
  MapObserver observer_;
  std::vector<std::unique_ptr<InputHealth>> inputs_;
  diagnostic_updater::Updater diagnostics_;

  core::PipelineConfig accepted_config_;  ///< of the requests' thread
  std::mutex new_config_mutex_;
  std::optional<core::PipelineConfig> new_config_;

  // What calls back, in the order in which it starts; it goes in the opposite one, before all that it uses.
  ros::CallbackQueue request_queue_;
  LineIntake intake_;
  boost::recursive_mutex reconfigure_mutex_;  ///< the server wants one that outlives it
  std::unique_ptr<dynamic_reconfigure::Server<RelativeMapConfig>> reconfigure_;
  ros::ServiceServer reset_service_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer types_timer_, diagnostics_timer_;
  ros::Timer timer_;
  ros::AsyncSpinner request_spinner_;
};

}  // namespace relative_map
