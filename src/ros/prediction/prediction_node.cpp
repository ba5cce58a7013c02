#include "relative_map/ros/prediction/prediction_node.hpp"

#include <visualization_msgs/MarkerArray.h>

#include "relative_map/ros/prediction/prediction_markers.hpp"

namespace relative_map {

namespace {

constexpr double kSilent = 1.0;  // [s] without a prediction: something stands still

}  // namespace

PredictionNode::PredictionNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : nh_(nh),
      private_nh_(private_nh),
      config_(make_prediction_config(parameters_of(private_nh))),
      transform_listener_(transforms_),
      engine_(config_, link_transforms(transforms_)),
      diagnostics_(nh, private_nh, private_nh.getNamespace()) {
  publisher_ = nh_.advertise<PredictionObstacles>("prediction", 1);
  markers_publisher_ = private_nh_.advertise<visualization_msgs::MarkerArray>("markers", 1);
  subscribe<LocalizationEstimate>("localization", 100, localization_, &PredictionEngine::on_localization);
  subscribe<MapMsg>("relative_map", 2, map_, &PredictionEngine::on_map);
  subscribe<PerceptionObstacles>("perception/obstacles", 10, obstacles_, &PredictionEngine::on_obstacles);
  subscribe<ADCTrajectory>("planning", 2, planning_, &PredictionEngine::on_planning);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("prediction",
                   [this](diagnostic_updater::DiagnosticStatusWrapper& status) { diagnose(status); });
  diagnostics_timer_ = nh_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  timer_ = nh_.createTimer(ros::Duration(1.0 / config_.rate), &PredictionNode::on_timer, this);
}

template <class Message>
void PredictionNode::subscribe(const std::string& topic, uint32_t queue_size, ros::Subscriber& subscriber,
                               void (PredictionEngine::*handler)(const boost::shared_ptr<const Message>&,
                                                                 const ros::Time&)) {
  using Pointer = boost::shared_ptr<const Message>;
  const boost::function<void(const Pointer&)> callback = [this, handler](const Pointer& message) {
    (engine_.*handler)(message, ros::Time::now());
  };
  subscriber = nh_.subscribe<Message>(topic, queue_size, callback, ros::VoidConstPtr(),
                                      ros::TransportHints().tcpNoDelay());
}

PredictionNode::~PredictionNode() {
  // A nodelet is unloaded while its callbacks run on: each of them must have ended before any member goes.
  timer_.stop();
  diagnostics_timer_.stop();
  for (ros::Subscriber* subscriber : {&obstacles_, &map_, &localization_, &planning_}) subscriber->shutdown();
}

void PredictionNode::on_timer(const ros::TimerEvent&) {
  const ros::WallTime start = ros::WallTime::now();
  const PredictionObstaclesPtr message = engine_.tick(ros::Time::now());
  if (!message) return;
  publisher_.publish(message);
  published_ = ros::WallTime::now();
  tick_time_ = (published_ - start).toSec();
  status_ = message->status;
  predicted_ = message->prediction_obstacle.size();
  if (markers_publisher_.getNumSubscribers() > 0) markers_publisher_.publish(draw(*message));
  log(*message);
}

void PredictionNode::log(const PredictionObstacles& message) {
  for (const std::string& remark : engine_.remarks()) {
    if (complaints_.due(remark, published_)) ROS_WARN_STREAM(remark);
  }
  if (message.status.code == PredictionStatus::OK) return;
  if (complaints_.due(message.status.message, published_)) ROS_WARN_STREAM(message.status.message);
}

void PredictionNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  if (published_.isZero() || (ros::WallTime::now() - published_).toSec() > kSilent) {
    status.summary(DiagnosticStatus::ERROR, "no prediction of late: does time stand still?");
  } else if (status_.code == PredictionStatus::OK) {
    status.summary(status_.message.empty() ? DiagnosticStatus::OK : DiagnosticStatus::WARN,
                   status_.message.empty() ? std::to_string(predicted_) + " road users" : status_.message);
  } else {
    const bool warning = status_.code == PredictionStatus::NO_MAP;
    status.summary(warning ? DiagnosticStatus::WARN : DiagnosticStatus::ERROR, status_.message);
  }
  status.add("road users", predicted_);
  status.add("tick time [ms]", 1e3 * tick_time_);
}

}  // namespace relative_map
