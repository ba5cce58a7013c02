#include "relative_map/ros/route/route_map_node.hpp"

#include <nav_msgs/Path.h>
#include <relative_map/LaneChange.h>
#include <visualization_msgs/MarkerArray.h>

#include "relative_map/io/lane_graph_file.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/ros/messages/route_conversions.hpp"
#include "relative_map/ros/route/route_markers.hpp"

namespace relative_map {

RouteMapNode::RouteMapNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : nh_(nh),
      private_nh_(private_nh),
      config_(make_route_config(parameters_of(private_nh))),
      transform_listener_(transforms_),
      engine_(config_, link_transforms(transforms_)),
      diagnostics_(nh, private_nh, private_nh.getNamespace()) {
  if (!config_.lane_graph.empty()) {
    core::LaneGraph graph = core::read_lane_graph(config_.lane_graph);
    if (graph.frame_id.empty()) graph.frame_id = "map";
    std::vector<std::string> faults;
    const std::string fault = take_graph(graph, faults);
    if (!fault.empty()) throw std::runtime_error("lane_graph: " + config_.lane_graph + ": " + fault);
  }
  segments_publisher_ = nh_.advertise<RouteSegmentsArray>("route_segments", 1);
  line_publisher_ = private_nh_.advertise<nav_msgs::Path>("reference_line", 1);
  markers_publisher_ = private_nh_.advertise<visualization_msgs::MarkerArray>("markers", 1);
  route_publisher_ = private_nh_.advertise<Route>("route", 1, true);
  change_publisher_ = private_nh_.advertise<LaneChange>("lane_change", 1, true);
  change_publisher_.publish(to_message(engine_.lane_change()));
  diagnostics_.setHardwareID("none");
  diagnostics_.add("route map",
                   [this](diagnostic_updater::DiagnosticStatusWrapper& status) { summarize(status); });
  diagnostics_timer_ = nh_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  if (config_.source == RouteSource::kRelativeMap) {
    relative_map_subscriber_ = nh_.subscribe("relative_map", 1, &RouteMapNode::on_relative_map, this,
                                             ros::TransportHints().tcpNoDelay());
  } else {
    graph_subscriber_ = nh_.subscribe("lane_graph", 1, &RouteMapNode::on_graph, this);
    route_subscriber_ = nh_.subscribe("route", 1, &RouteMapNode::on_route, this);
    const boost::function<void(const LocalizationEstimateConstPtr&)> on_localization =
        [this](const LocalizationEstimateConstPtr& message) {
          engine_.on_localization(message, ros::Time::now());
        };
    localization_subscriber_ = nh_.subscribe<LocalizationEstimate>(
        "localization", 10, on_localization, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
    const boost::function<void(const ChassisConstPtr&)> on_chassis = [this](const ChassisConstPtr& message) {
      engine_.on_chassis(message, ros::Time::now());
    };
    chassis_subscriber_ = nh_.subscribe<Chassis>("chassis", 10, on_chassis);
    find_service_ = private_nh_.advertiseService("find_route", &RouteMapNode::on_find, this);
    clear_service_ = private_nh_.advertiseService("clear_route", &RouteMapNode::on_clear, this);
    load_service_ = private_nh_.advertiseService("load_lane_graph", &RouteMapNode::on_load, this);
  }
  change_service_ = private_nh_.advertiseService("change_lane", &RouteMapNode::on_change, this);
  timer_ = nh_.createTimer(ros::Duration(1.0 / config_.rate), &RouteMapNode::on_timer, this);
}

RouteMapNode::~RouteMapNode() {
  // A nodelet is unloaded while its callbacks run on: each of them must have ended before any member goes.
  timer_.stop();
  diagnostics_timer_.stop();
  for (ros::Subscriber* subscriber : {&graph_subscriber_, &route_subscriber_, &localization_subscriber_,
                                      &chassis_subscriber_, &relative_map_subscriber_}) {
    subscriber->shutdown();
  }
  for (ros::ServiceServer* service : {&find_service_, &change_service_, &clear_service_, &load_service_})
    service->shutdown();
}

std::string RouteMapNode::take_graph(const core::LaneGraph& graph, std::vector<std::string>& faults) {
  std::vector<core::GraphFault> found;
  const auto network = core::LaneNetwork::prepare(graph, found);
  std::string fatal;
  for (const core::GraphFault& fault : found) {
    faults.push_back(fault.what);
    if (fault.fatal) fatal += (fatal.empty() ? "" : "; ") + fault.what;
  }
  if (!network) return fatal;
  const core::RouteStatus status = engine_.set_graph(network);
  if (status.code != core::RouteCode::kOk) {
    route_fault_ = "the route does not fit the new lane graph: " + status.message;
    ROS_WARN_STREAM("lane_graph: " << route_fault_);
  }
  for (const std::string& fault : faults) {
    if (log_.due("graph: " + fault, ros::WallTime::now())) ROS_WARN_STREAM("lane_graph: " << fault);
  }
  ROS_INFO_STREAM("lane_graph: " << network->size() << " lanes in frame '" << network->frame_id() << "'");
  return "";
}

std::string RouteMapNode::take_route(const core::Route& route) {
  const bool known = engine_.follows(route);
  const core::RouteStatus status = engine_.set_route(route);
  if (status.code != core::RouteCode::kOk) return status.message;
  route_fault_.clear();
  if (known) return "";
  for (const std::string& repair : engine_.map().repairs()) ROS_WARN_STREAM("route: " << repair);
  ROS_INFO_STREAM("route: " << route.roads.size() << " roads, " << route.waypoints.size() << " waypoints, "
                            << route.distance << " m");
  publish_news();
  return "";
}

void RouteMapNode::publish_news() {
  const std::optional<core::Route>& route = engine_.map().route();
  if (route && !(told_route_ && core::same_way(*told_route_, *route))) {
    Route message = to_message(*route);
    message.header.stamp = ros::Time::now();
    message.header.frame_id = engine_.map().network()->frame_id();
    route_publisher_.publish(message);
  }
  told_route_ = route;
  const core::LaneChangeStatus& change = engine_.lane_change();
  if (change.state == told_change_.state && change.time == told_change_.time) return;
  told_change_ = change;
  change_publisher_.publish(to_message(change));
  ROS_INFO_STREAM("change_lane: " << sentence_of(change));
}

void RouteMapNode::on_graph(const LaneGraphConstPtr& message) {
  std::vector<std::string> faults;
  const std::string fault = take_graph(to_core(*message), faults);
  if (fault.empty()) return;
  route_fault_ = "a lane graph was refused: " + fault;
  if (log_.due(route_fault_, ros::WallTime::now()))
    ROS_ERROR_STREAM("lane_graph: the one before stays: " << fault);
}

void RouteMapNode::on_route(const RouteConstPtr& message) {
  const std::string fault = take_route(to_core(*message));
  if (fault.empty()) return;
  route_fault_ = "a route was refused: " + fault;
  if (log_.due(route_fault_, ros::WallTime::now()))
    ROS_ERROR_STREAM("route: the one before stays: " << fault);
}

void RouteMapNode::on_relative_map(const MapMsgConstPtr& message) {
  publish(engine_.on_relative_map(*message, ros::Time::now()));
}

void RouteMapNode::on_timer(const ros::TimerEvent&) {
  const ros::Time now = ros::Time::now();
  publish(config_.source == RouteSource::kRelativeMap ? engine_.check_map_age(now) : engine_.tick(now));
  publish_news();
}

void RouteMapNode::publish(const RouteSegmentsArrayPtr& told) {
  if (!told) return;
  segments_publisher_.publish(told);
  if (told->status.code != RouteStatus::OK && log_.due(told->status.message, ros::WallTime::now())) {
    ROS_WARN_STREAM("route_segments: " << told->status.message);
  }
  if (!told->segments.empty()) line_publisher_.publish(to_path(told->segments.front(), told->header));
  if (markers_publisher_.getNumSubscribers() > 0) {
    markers_publisher_.publish(draw_route(*told, engine_.map().index()));
  }
}

bool RouteMapNode::on_find(FindRoute::Request& request, FindRoute::Response& response) {
  const core::SearchResult found = engine_.find(request);
  response.message = found.why_not;
  response.success = found.route.has_value();
  if (!found.route) return true;
  response.route = to_message(*found.route);
  response.route.header.stamp = ros::Time::now();
  if (request.follow) {
    const std::string fault = take_route(*found.route);
    response.success = fault.empty();
    response.message = fault;
  }
  return true;
}

bool RouteMapNode::on_change(ChangeLane::Request& request, ChangeLane::Response& response) {
  if (request.to > ChangeLane::Request::BACK) {
    response.message = "to must be LEFT, RIGHT, LANE or BACK";
    return true;
  }
  core::LaneChangeRequest asked;
  asked.to = static_cast<core::LaneChangeGoal>(request.to);
  asked.lane_id = request.lane_id;
  asked.force = request.force;
  const LaneChangeAnswer answer = engine_.change_lane(asked, ros::Time::now());
  response.success = answer.why_not.empty();
  response.message = answer.why_not;
  response.lane_id = answer.lane_id;
  if (!response.success) ROS_WARN_STREAM("change_lane: refused: " << answer.why_not);
  publish_news();
  return true;
}

bool RouteMapNode::on_clear(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = engine_.map().route().has_value();
  response.message = response.success ? "the route is cleared" : "there was no route";
  engine_.clear_route();
  return true;
}

bool RouteMapNode::on_load(LoadLaneGraph::Request& request, LoadLaneGraph::Response& response) {
  try {
    core::LaneGraph graph = core::read_lane_graph(request.file);
    if (graph.frame_id.empty()) graph.frame_id = request.frame_id.empty() ? "map" : request.frame_id;
    response.message = take_graph(graph, response.faults);
    response.success = response.message.empty();
    if (response.success) {
      response.message =
          std::to_string(graph.lanes.size()) + " lanes loaded in frame '" + graph.frame_id + "'";
    } else {
      response.message = "nothing was loaded: " + response.message;
    }
  } catch (const std::exception& fault) {
    response.message = std::string("nothing was loaded: ") + fault.what();
  }
  if (!response.success) ROS_ERROR_STREAM("load_lane_graph: " << response.message);
  return true;
}

void RouteMapNode::summarize(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  const core::RouteUpdate& last = engine_.last();
  if (last.status.code != core::RouteCode::kOk) {
    const bool waits =
        last.status.code == core::RouteCode::kNoRoute || last.status.code == core::RouteCode::kNoGraph;
    status.summary(waits ? DiagnosticStatus::WARN : DiagnosticStatus::ERROR, last.status.message);
  } else if (!route_fault_.empty()) {
    status.summary(DiagnosticStatus::WARN, route_fault_);
  } else if (last.segments.empty()) {
    status.summary(DiagnosticStatus::WARN, "nothing was told yet");
  } else {
    status.summary(DiagnosticStatus::OK, "on the route");
  }
  status.add("status", route_status_name(last.status.code));
  status.add("lanes of the graph", engine_.map().network() != nullptr ? engine_.map().network()->size() : 0);
  if (engine_.lane_change().state != core::LaneChangeState::kNone)
    status.add("lane change", sentence_of(engine_.lane_change()));
  if (!last.place) return;
  status.add("lane", last.place->lane_id);
  status.add("lateral offset [m]", last.place->l);
  status.add("distance to destination [m]", last.place->distance_to_destination);
  status.add("next waypoint", last.place->next_waypoint);
  status.add("passages", last.segments.size());
}

}  // namespace relative_map
