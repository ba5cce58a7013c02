#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <relative_map/ChangeLane.h>
#include <relative_map/FindRoute.h>
#include <relative_map/LaneGraph.h>
#include <relative_map/LoadLaneGraph.h>
#include <relative_map/Route.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <string>
#include <vector>

#include "relative_map/ros/health/throttled_log.hpp"
#include "relative_map/ros/route/route_engine.hpp"

namespace relative_map {

/// Topics, timers and services around the route engine; the nodelet and the stand-alone node are shells of
/// it. All callbacks run on the callback queue of the node handles, one after the other.
class RouteMapNode {
 public:
  /// Throws std::runtime_error that names every bad parameter, before anything is advertised.
  RouteMapNode(ros::NodeHandle nh, ros::NodeHandle private_nh);
  ~RouteMapNode();

 private:
  void on_graph(const LaneGraphConstPtr& message);
  void on_route(const RouteConstPtr& message);
  void on_relative_map(const MapMsgConstPtr& message);
  void on_timer(const ros::TimerEvent& event);
  bool on_find(FindRoute::Request& request, FindRoute::Response& response);
  bool on_change(ChangeLane::Request& request, ChangeLane::Response& response);
  bool on_clear(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_load(LoadLaneGraph::Request& request, LoadLaneGraph::Response& response);

  /// Takes a graph, or tells why not; the faults that it has are sentences.
  std::string take_graph(const core::LaneGraph& graph, std::vector<std::string>& faults);
  std::string take_route(const core::Route& route);
  /// What is new of the way that is followed, and of the lane change.
  void publish_news();
  void publish(const RouteSegmentsArrayPtr& told);
  void summarize(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  ros::NodeHandle nh_, private_nh_;
  RouteNodeConfig config_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;
  RouteEngine engine_;
  std::string route_fault_;  ///< why the last route or graph that came was not taken; empty: it was
  std::optional<core::Route> told_route_;
  core::LaneChangeStatus told_change_;
  ThrottledLog log_;

  ros::Publisher segments_publisher_, line_publisher_, markers_publisher_, route_publisher_,
      change_publisher_;
  ros::Subscriber graph_subscriber_, route_subscriber_, localization_subscriber_, chassis_subscriber_,
      relative_map_subscriber_;
  ros::ServiceServer find_service_, change_service_, clear_service_, load_service_;
  ros::Timer timer_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
};

}  // namespace relative_map
