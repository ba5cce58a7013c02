#include "relative_map/ros/map/relative_map_node.hpp"

#include <XmlRpcValue.h>

#include "relative_map/ros/setup/line_loader.hpp"
#include "relative_map/ros/setup/reconfigure.hpp"

namespace relative_map {

namespace {

constexpr uint32_t kMapQueue = 10;  // a planner or recorder that is late for a moment misses none

/// The files that the parameter names; none if it is not set.
std::vector<std::string> configured_files(const ros::NodeHandle& private_nh) {
  XmlRpc::XmlRpcValue value;
  return private_nh.getParam(kLinesParameter, value) ? line_files(value) : std::vector<std::string>();
}

NodeConfig load_config(const ros::NodeHandle& private_nh) {
  // Like other users of it: in the node's namespace, or else in one around it.
  // From the private one, since a nodelet's public handle can't search from the root.
  std::string key, urdf;
  if (private_nh.searchParam("robot_description", key)) private_nh.getParam(key, urdf);
  return make_node_config(parameters_of(private_nh), urdf);
}

const ros::WallDuration kTypesPeriod(2.0);

}  // namespace

RelativeMapNode::RelativeMapNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : nh_(nh),
      private_nh_(private_nh),
      log_(private_nh.getNamespace()),
      config_(load_config(private_nh)),
      engine_(config_, link_transforms(transforms_)),
      raw_line_(config_.orientation_convention, link_transforms(transforms_)),
      diagnostics_(nh, private_nh, private_nh.getNamespace()),
      accepted_config_(config_.pipeline),
      intake_(config_, private_nh.param<std::string>(kLineFolderParameter, ""), log_),
      request_spinner_(1, &request_queue_) {
  intake_.load(configured_files(private_nh_));
  advertise();
  serve_requests();
  listen();
}

void RelativeMapNode::advertise() {
  map_publisher_ = nh_.advertise<MapMsg>("relative_map", kMapQueue);
  markers_publisher_ = private_nh_.advertise<visualization_msgs::MarkerArray>("markers", 1);
  centerline_publisher_ = private_nh_.advertise<nav_msgs::Path>("centerline", 1);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("relative map", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    const ros::Time now = ros::Time::now();
    const ros::WallTime wall_now = ros::WallTime::now();
    observer_.note_clock(now, wall_now);
    summarize(observer_.statistics(now, wall_now), status);
  });
}

void RelativeMapNode::serve_requests() {
  ros::NodeHandle reconfigure_nh(private_nh_, kReconfigureNamespace);
  reconfigure_nh.setCallbackQueue(&request_queue_);
  reconfigure_ =
      std::make_unique<dynamic_reconfigure::Server<RelativeMapConfig>>(reconfigure_mutex_, reconfigure_nh);
  reconfigure_->updateConfig(reconfigure_view(config_.pipeline));
  reconfigure_->setCallback([this](RelativeMapConfig& request, uint32_t) { on_reconfigure(request); });
  intake_.listen(nh_, private_nh_, request_queue_);
}

/// A publisher of another type tells its subscriber nothing: the master knows.
void RelativeMapNode::look_at_types() {
  XmlRpc::XmlRpcValue request, response, topics;
  request[0] = ros::this_node::getName();
  request[1] = "";
  if (!ros::master::execute("getPublishedTopics", request, response, topics, false)) return;
  std::map<std::string, std::string> types;
  for (int i = 0; i < topics.size(); ++i) types[topics[i][0]] = static_cast<std::string>(topics[i][1]);
  for (const auto& input : inputs_) {
    if (input->has_come() || !input->note_published_type(types[input->expectation().topic])) continue;
    log_.error(input->fault() + " (standard messages: see adapters.launch)");
  }
}

void RelativeMapNode::listen() {
  reset_service_ = private_nh_.advertiseService("reset", &RelativeMapNode::on_reset, this);
  subscribe_transforms("/tf_static", true);
  subscribe_transforms("/tf", false);
  const core::MaxAgeParam& max_age = config_.pipeline.max_age;
  const bool by_markers = config_.pipeline.navigation_lane.lane_source == core::LaneSource::kPerception;
  InputHealth& localization =
      expect<LocalizationEstimate>("localization", config_.min_rate.localization, max_age.localization, true);
  InputHealth& chassis = expect<Chassis>("chassis", config_.min_rate.chassis, max_age.chassis, false);
  InputHealth& markers = expect<LaneMarkers>("perception/lane_markers", config_.min_rate.lane_markers,
                                             max_age.lane_markers, by_markers);
  expect_lines();
  subscribe<LocalizationEstimate>("localization", 100, &MapEngine::on_localization, localization);
  subscribe<Chassis>("chassis", 100, &MapEngine::on_chassis, chassis);
  subscribe<LaneMarkers>("perception/lane_markers", 10, &MapEngine::on_lane_markers, markers);
  diagnostics_timer_ = nh_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  ros::NodeHandle request_nh(nh_);
  request_nh.setCallbackQueue(&request_queue_);
  types_timer_ =
      request_nh.createWallTimer(kTypesPeriod, [this](const ros::WallTimerEvent&) { look_at_types(); });
  request_spinner_.start();
  timer_ = nh_.createTimer(ros::Duration(1.0 / config_.rate), [this](const ros::TimerEvent&) { on_timer(); });
}

/// Lines come once, and have no rate: only their type is looked at.
void RelativeMapNode::expect_lines() {
  inputs_.push_back(std::make_unique<InputHealth>(InputExpectation{
      nh_.resolveName("navigation"), ros::message_traits::datatype<NavigationInfo>(), 0.0, 0.0, false}));
}

template <class Message>
InputHealth& RelativeMapNode::expect(const std::string& topic, double min_rate, double max_age, bool needed) {
  observer_.expect_input(topic);
  inputs_.push_back(std::make_unique<InputHealth>(InputExpectation{
      nh_.resolveName(topic), ros::message_traits::datatype<Message>(), min_rate, max_age, needed}));
  diagnostics_.add(*inputs_.back());
  return *inputs_.back();
}

template <class Message>
void RelativeMapNode::subscribe(const std::string& topic, uint32_t queue_size, Handler<Message> handler,
                                InputHealth& health) {
  using Pointer = boost::shared_ptr<const Message>;
  const boost::function<void(const Pointer&)> callback = [this, topic, handler,
                                                          &health](const Pointer& message) {
    const ros::Time now = ros::Time::now();
    health.note(message->header.stamp);
    observer_.note_input(topic, message->header.stamp, ros::WallTime::now());
    if constexpr (std::is_same_v<Message, LocalizationEstimate>) {
      intake_.note_localization_frame(message->header.frame_id);
    }
    (engine_.*handler)(message, now);
  };
  subscribers_.push_back(nh_.subscribe<Message>(topic, queue_size, callback, ros::VoidConstPtr(),
                                                ros::TransportHints().tcpNoDelay()));
}

/// By the node's own handle, whose remappings are those of this nodelet and not of its manager.
void RelativeMapNode::subscribe_transforms(const std::string& topic, bool is_static) {
  subscribers_.push_back(nh_.subscribe<tf2_msgs::TFMessage>(
      topic, 100, [this, is_static](const tf2_msgs::TFMessageConstPtr& message) {
        add_transforms(*message, is_static, transforms_);
      }));
}

void RelativeMapNode::pick_up_requests() {
  std::optional<core::PipelineConfig> config;
  {
    const std::lock_guard<std::mutex> lock(new_config_mutex_);
    config.swap(new_config_);
  }
  if (config) engine_.set_config(*config);
  if (auto lines = intake_.take()) {
    observer_.note_lines(*lines);
    engine_.set_navigation_lines(std::move(lines));
  }
}

void RelativeMapNode::on_timer() {
  const ros::WallTime start = ros::WallTime::now();
  const ros::Time now = ros::Time::now();
  if (now < last_tick_) {
    transforms_.clear();  // all that is static stays
    for (const auto& input : inputs_) input->forget();
  }
  last_tick_ = now;
  pick_up_requests();
  const MapMsgPtr map = engine_.tick(now);
  if (!map) return;
  map_publisher_.publish(map);
  const ros::WallTime end = ros::WallTime::now();
  observer_.note_map(engine_.last_map(), (end - start).toSec(), end);
  log_status(end);
  publish_views(*map);
}

void RelativeMapNode::publish_views(const MapMsg& map) {
  if (markers_publisher_.getNumSubscribers() > 0) {
    const double max_distance = engine_.config().navigation_lane.max_distance_to_navigation_line;
    markers_publisher_.publish(markers_.draw(
        map, config_.pipeline.footprint, raw_line_.beside(map, engine_.navigation_lines(), max_distance)));
  }
  if (centerline_publisher_.getNumSubscribers() > 0) centerline_publisher_.publish(centerline(map));
}

void RelativeMapNode::log_status(const ros::WallTime& now) {
  for (const StatusLog::Line& line : status_log_.lines(engine_.last_map(), engine_.remarks(), now)) {
    line.is_warning ? log_.warn(line.text) : log_.info(line.text);
  }
}

void RelativeMapNode::on_reconfigure(RelativeMapConfig& request) {
  const core::PipelineConfig candidate = with_request(accepted_config_, request);
  const std::vector<std::string> faults = candidate.validate();
  if (!faults.empty()) {
    request = reconfigure_view(accepted_config_);
    for (const std::string& fault : faults) {
      log_.error("reconfigure is refused: " + fault);
      request.refusal += (request.refusal.empty() ? "" : "; ") + fault;
    }
    return;
  }
  request.refusal.clear();
  accepted_config_ = candidate;
  intake_.set_config(candidate);
  const std::lock_guard<std::mutex> lock(new_config_mutex_);
  new_config_ = candidate;
}

bool RelativeMapNode::on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  engine_.reset();
  response.success = true;
  response.message = "inputs are forgotten, lines are kept";
  return true;
}

}  // namespace relative_map
