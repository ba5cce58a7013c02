#include "relative_map/ros/map/relative_map_node.hpp"

#include <XmlRpcValue.h>

#include <sstream>

#include "relative_map/ros/setup/line_loader.hpp"

namespace relative_map {

namespace {

constexpr std::size_t kMaxLogged = 10;  // lines, and faults, of one message

NodeConfig load_config(const ros::NodeHandle& private_nh) {
  XmlRpc::XmlRpcValue tree;
  private_nh.getParam(private_nh.getNamespace(), tree);
  // Like other users of it: in the node's namespace, or else in one around it.
  // From the private one, since a nodelet's public handle can't search from the root.
  std::string key, urdf;
  if (private_nh.searchParam("robot_description", key)) private_nh.getParam(key, urdf);
  return make_node_config(flatten(tree), urdf);
}

/// The parameters that may change while driving, out of and into the pipeline's configuration.
template <class Copy>
void exchange(Copy copy, RelativeMapConfig& request, core::PipelineConfig& config) {
  copy(request.default_left_width, config.map_param.default_left_width);
  copy(request.default_right_width, config.map_param.default_right_width);
  copy(request.default_speed_limit, config.map_param.default_speed_limit);
  copy(request.min_lane_half_width, config.navigation_lane.min_lane_half_width);
  copy(request.max_lane_half_width, config.navigation_lane.max_lane_half_width);
  copy(request.lane_marker_weight, config.navigation_lane.lane_marker_weight);
  copy(request.min_lane_marker_quality, config.navigation_lane.min_lane_marker_quality);
  copy(request.max_len_from_navigation_line, config.navigation_lane.max_len_from_navigation_line);
  copy(request.max_distance_to_navigation_line, config.navigation_lane.max_distance_to_navigation_line);
}

RelativeMapConfig reconfigure_view(core::PipelineConfig config) {
  RelativeMapConfig view = RelativeMapConfig::__getDefault__();
  exchange([](double& to, double& from) { to = from; }, view, config);
  return view;
}

core::PipelineConfig with_request(core::PipelineConfig config, RelativeMapConfig request) {
  exchange([](double& from, double& to) { to = from; }, request, config);
  return config;
}

std::string description(const core::NavigationLine& line) {
  std::ostringstream text;
  text << "line '" << line.id << "', priority " << line.priority << ", " << line.points.size() << " points, "
       << line.length << " m" << (line.closed() ? ", closed" : "");
  return text.str();
}

/// Each message is told of once, however often it is sent.
void log_intake(const core::NavigationLines& lines, ThrottledLog& log) {
  std::vector<std::string> good;
  for (std::size_t i = 0; i < std::min(lines.lines.size(), kMaxLogged); ++i) {
    good.push_back(description(lines.lines[i]));
  }
  const auto end_of_faults =
      lines.faults.begin() + static_cast<std::ptrdiff_t>(std::min(lines.faults.size(), kMaxLogged));
  const std::vector<std::string> faults(lines.faults.begin(), end_of_faults);
  std::string all;
  for (const std::string& sentence : faults) all += sentence + "\n";
  for (const std::string& sentence : good) all += sentence + "\n";
  if (!log.due(all, ros::WallTime::now())) return;
  for (const std::string& fault : faults) ROS_WARN_STREAM("navigation: " << fault);
  for (const std::string& line : good) ROS_INFO_STREAM("navigation: " << line);
  ROS_INFO_STREAM("navigation: " << lines.lines.size() << " lines, " << lines.faults.size() << " faults");
}

}  // namespace

RelativeMapNode::RelativeMapNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : nh_(nh),
      private_nh_(private_nh),
      config_(load_config(private_nh)),
      transform_listener_(transforms_),
      engine_(config_, link_transforms(transforms_)),
      raw_line_(config_.orientation_convention, link_transforms(transforms_)),
      intake_config_(config_.pipeline),
      diagnostics_(nh, private_nh, private_nh.getNamespace()),
      intake_spinner_(1, &intake_queue_) {
  load_lines_of_parameter();
  map_publisher_ = nh_.advertise<MapMsg>("relative_map", 1);
  markers_publisher_ = private_nh_.advertise<visualization_msgs::MarkerArray>("markers", 1);
  centerline_publisher_ = private_nh_.advertise<nav_msgs::Path>("centerline", 1);

  subscribe<LocalizationEstimate>("localization", 100, localization_subscriber_, &MapEngine::on_localization);
  subscribe<Chassis>("chassis", 10, chassis_subscriber_, &MapEngine::on_chassis);
  subscribe<LaneMarkers>("perception/lane_markers", 10, lane_markers_subscriber_,
                         &MapEngine::on_lane_markers);
  reset_service_ = private_nh_.advertiseService("reset", &RelativeMapNode::on_reset, this);

  ros::SubscribeOptions intake = ros::SubscribeOptions::create<NavigationInfo>(
      "navigation", 1, [this](const NavigationInfoConstPtr& message) { on_navigation(message); },
      ros::VoidConstPtr(), &intake_queue_);
  navigation_subscriber_ = nh_.subscribe(intake);
  // Files are read where lines are prepared: a tick does not wait for them.
  const auto on_load_request = [this](LoadNavigationLines::Request& request,
                                      LoadNavigationLines::Response& response) {
    return on_load(request, response);
  };
  ros::AdvertiseServiceOptions load = ros::AdvertiseServiceOptions::create<LoadNavigationLines>(
      "load_navigation_lines", on_load_request, ros::VoidConstPtr(), &intake_queue_);
  load_service_ = private_nh_.advertiseService(load);

  reconfigure_ = std::make_unique<dynamic_reconfigure::Server<RelativeMapConfig>>(
      reconfigure_mutex_, ros::NodeHandle(private_nh_, kReconfigureNamespace));
  reconfigure_->updateConfig(reconfigure_view(config_.pipeline));
  reconfigure_->setCallback(
      [this](RelativeMapConfig& request, uint32_t level) { on_reconfigure(request, level); });

  diagnostics_.setHardwareID("none");
  diagnostics_.add("relative map", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    const ros::Time now = ros::Time::now();
    const ros::WallTime wall_now = ros::WallTime::now();
    observer_.note_clock(now, wall_now);
    summarize(observer_.statistics(now, wall_now), status);
  });
  diagnostics_timer_ = nh_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  timer_ = nh_.createTimer(ros::Duration(1.0 / config_.rate), &RelativeMapNode::on_timer, this);
  intake_spinner_.start();
}

template <class Message>
void RelativeMapNode::subscribe(const std::string& topic, uint32_t queue_size, ros::Subscriber& subscriber,
                                Handler<Message> handler) {
  using Pointer = boost::shared_ptr<const Message>;
  const boost::function<void(const Pointer&)> callback = [this, topic, handler](const Pointer& message) {
    const ros::Time now = ros::Time::now();
    observer_.note_input(topic, message->header.stamp, ros::WallTime::now());
    if constexpr (std::is_same_v<Message, LocalizationEstimate>) {
      note_localization_frame(message->header.frame_id);
    }
    (engine_.*handler)(message, now);
  };
  subscriber = nh_.subscribe<Message>(topic, queue_size, callback, ros::VoidConstPtr(),
                                      ros::TransportHints().tcpNoDelay());
}

RelativeMapNode::~RelativeMapNode() {
  // A nodelet is unloaded while its callbacks run on: each of them must have ended before any member goes.
  timer_.stop();
  diagnostics_timer_.stop();
  for (ros::Subscriber* subscriber : {&localization_subscriber_, &chassis_subscriber_,
                                      &lane_markers_subscriber_, &navigation_subscriber_}) {
    subscriber->shutdown();
  }
  reset_service_.shutdown();
  load_service_.shutdown();
  reconfigure_.reset();
  intake_spinner_.stop();
}

std::shared_ptr<const core::NavigationLines> RelativeMapNode::prepare(const NavigationInfo& message) {
  core::PipelineConfig config;
  {
    const std::lock_guard<std::mutex> lock(intake_mutex_);
    config = intake_config_;
  }
  auto lines = MapEngine::prepare(message, config);
  log_intake(*lines, intake_log_);
  return lines;
}

void RelativeMapNode::take_lines(std::shared_ptr<const core::NavigationLines> lines) {
  // The one before the last is freed here, and not by the tick that lets go of it.
  kept_lines_[0] = std::move(kept_lines_[1]);
  kept_lines_[1] = lines;
  const std::lock_guard<std::mutex> lock(intake_mutex_);
  new_lines_ = std::move(lines);
}

void RelativeMapNode::on_navigation(const NavigationInfoConstPtr& message) {
  take_lines(prepare(*message));
}

void RelativeMapNode::load_lines_of_parameter() {
  private_nh_.getParam(kLineFolderParameter, line_folder_);
  XmlRpc::XmlRpcValue value;
  if (!private_nh_.getParam(kLinesParameter, value)) return;
  const std::vector<std::string> files = line_files(value);
  if (files.empty()) return;
  std::vector<std::string> notes;
  const auto lines = prepare(to_message(load_lines(files, "", notes)));
  for (const std::string& note : notes) ROS_WARN_STREAM(kLinesParameter << ": " << note);
  expect_all_loaded(*lines, files.size());
  take_lines(lines);
}

void RelativeMapNode::note_localization_frame(const std::string& frame_id) {
  const std::lock_guard<std::mutex> lock(intake_mutex_);
  if (localization_frame_ != frame_id) localization_frame_ = frame_id;
}

bool RelativeMapNode::on_load(LoadNavigationLines::Request& request,
                              LoadNavigationLines::Response& response) {
  try {
    std::string localization_frame;
    {
      const std::lock_guard<std::mutex> lock(intake_mutex_);
      localization_frame = frame_name(localization_frame_);
    }
    expect_allowed(request.files, line_folder_);
    std::vector<std::string> notes;
    const core::NavigationInfo info =
        load_lines(request.files, request.frame_id.empty() ? localization_frame : request.frame_id, notes);
    expect_frame(info.frame_id, localization_frame);
    const auto lines = prepare(to_message(info));
    expect_all_loaded(*lines, request.files.size());
    response.lines = described(*lines);
    response.message =
        std::to_string(lines->lines.size()) + " lines loaded in frame '" + lines->frame_id + "'";
    for (const std::string& note : notes) {
      response.message += "; " + note;
      ROS_WARN_STREAM("load_navigation_lines: " << note);
    }
    response.success = true;
    take_lines(lines);
  } catch (const std::exception& fault) {
    response.message = std::string("nothing was loaded: ") + fault.what();
    ROS_ERROR_STREAM("load_navigation_lines: " << response.message);
  }
  return true;
}

void RelativeMapNode::pick_up_lines() {
  std::shared_ptr<const core::NavigationLines> lines;
  {
    const std::lock_guard<std::mutex> lock(intake_mutex_);
    lines.swap(new_lines_);
  }
  if (!lines) return;
  observer_.note_lines(*lines);
  engine_.set_navigation_lines(std::move(lines));
}

void RelativeMapNode::on_timer(const ros::TimerEvent&) {
  const ros::WallTime start = ros::WallTime::now();
  pick_up_lines();
  const MapMsgPtr map = engine_.tick(ros::Time::now());
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
  const core::RelativeMap& map = engine_.last_map();
  const auto code = static_cast<uint8_t>(map.status.code);
  const bool changed = code != logged_code_;
  logged_code_ = code;
  if (code == MapStatus::OK) {
    if (changed) ROS_INFO_STREAM("the map is back: " << map.lanes.size() << " lanes");
    for (const std::string& remark : engine_.remarks()) {
      if (complaints_.due(remark, now)) ROS_WARN_STREAM(remark);
    }
    return;
  }
  const std::string complaint = "no map: " + status_name(map.status.code) + ": " + map.status.message;
  if (complaints_.due(complaint, now) || changed) ROS_WARN_STREAM(complaint);
}

void RelativeMapNode::on_reconfigure(RelativeMapConfig& request, uint32_t) {
  const core::PipelineConfig candidate = with_request(engine_.config(), request);
  const std::vector<std::string> faults = candidate.validate();
  if (!faults.empty()) {
    for (const std::string& fault : faults) ROS_ERROR_STREAM("reconfigure is refused: " << fault);
    request = reconfigure_view(engine_.config());
    return;
  }
  engine_.set_config(candidate);
  const std::lock_guard<std::mutex> lock(intake_mutex_);
  intake_config_ = candidate;
}

bool RelativeMapNode::on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  engine_.reset();
  response.success = true;
  response.message = "inputs are forgotten, lines are kept";
  return true;
}

}  // namespace relative_map
