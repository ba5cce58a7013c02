#include "relative_map/ros/localizer/localizer_node.hpp"

#include <topic_tools/shape_shifter.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <sstream>

#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

constexpr double kWaitForFrames = 3.0;  // [s] for the transforms of sensors
constexpr double kDrawPeriod = 0.2;     // [s] between markers
constexpr std::size_t kPathLength = 1500;
constexpr double kRemarkTime = 5.0;  // [s] that a remark stays in the diagnostics

std_msgs::ColorRGBA colour_of(core::EstimateCode code) {
  std_msgs::ColorRGBA colour;
  colour.a = 1.0F;
  colour.r = code == core::EstimateCode::kOk ? 0.1F : 0.95F;
  colour.g = code == core::EstimateCode::kError ? 0.1F : 0.75F;
  colour.b = 0.1F;
  return colour;
}

}  // namespace

LocalizerNode::LocalizerNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : nh_(nh),
      private_nh_(private_nh),
      config_(make_localizer_config(parameters_of(private_nh))),
      transform_listener_(transforms_),
      engine_(config_, link_transforms(transforms_), kWaitForFrames),
      diagnostics_(nh, private_nh, private_nh.getNamespace()) {
  localization_publisher_ = nh_.advertise<LocalizationEstimate>("localization", 10);
  odometry_publisher_ = nh_.advertise<nav_msgs::Odometry>("odometry", 10);
  markers_publisher_ = private_nh_.advertise<visualization_msgs::MarkerArray>("markers", 1);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("localizer",
                   [this](diagnostic_updater::DiagnosticStatusWrapper& status) { summarize(status); });
  diagnostics_timer_ = nh_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  reset_service_ = private_nh_.advertiseService("reset", &LocalizerNode::on_reset, this);
  align_service_ = private_nh_.advertiseService("align", &LocalizerNode::on_align, this);
  datum_service_ = private_nh_.advertiseService("set_datum", &LocalizerNode::on_set_datum, this);

  using sensor_msgs::Imu;
  subscribers_ = {
      subscribe<Imu>("imu", [this](const Imu& m, const ros::Time& now) { engine_.on_imu(m, now); }),
      subscribe<sensor_msgs::NavSatFix>(
          "fix", [this](const sensor_msgs::NavSatFix& m, const ros::Time& now) { engine_.on_fix(m, now); }),
      subscribe<Imu>("heading", [this](const Imu& m, const ros::Time& now) { engine_.on_heading(m, now); }),
      subscribe<Chassis>("chassis",
                         [this](const Chassis& m, const ros::Time& now) { engine_.on_chassis(m, now); }),
      subscribe<geometry_msgs::PoseWithCovarianceStamped>(
          "map_pose", [this](const geometry_msgs::PoseWithCovarianceStamped& m,
                             const ros::Time& now) { engine_.on_map_pose(m, now); }),
      subscribe<geometry_msgs::PoseWithCovarianceStamped>(
          "initialpose", [this](const geometry_msgs::PoseWithCovarianceStamped& m,
                                const ros::Time& now) { engine_.on_map_pose(m, now); }),
      // Two types each, as drivers differ.
      subscribe<topic_tools::ShapeShifter>("fix_velocity", [this](const topic_tools::ShapeShifter& m,
                                                                  const ros::Time&) { on_fix_velocity(m); }),
      subscribe<topic_tools::ShapeShifter>(
          "wheel_odometry",
          [this](const topic_tools::ShapeShifter& m, const ros::Time&) { on_wheel_odometry(m); }),
  };
}

LocalizerNode::~LocalizerNode() {
  // A nodelet is unloaded while its callbacks run on: each of them must have ended before any member goes.
  for (ros::Subscriber& subscriber : subscribers_) subscriber.shutdown();
  reset_service_.shutdown();
  align_service_.shutdown();
  datum_service_.shutdown();
  diagnostics_timer_.stop();
}

template <class Message, class Handler>
ros::Subscriber LocalizerNode::subscribe(const std::string& topic, Handler handler) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
      [this, handler](const boost::shared_ptr<const Message>& message) {
        handler(*message, ros::Time::now());
        publish();
      };
  return nh_.subscribe<Message>(topic, 200, callback, ros::VoidConstPtr(),
                                ros::TransportHints().tcpNoDelay());
}

void LocalizerNode::on_fix_velocity(const topic_tools::ShapeShifter& message) {
  const ros::Time now = ros::Time::now();
  if (message.getDataType() == "geometry_msgs/TwistStamped") {
    engine_.on_fix_velocity(*message.instantiate<geometry_msgs::TwistStamped>(), now);
  } else if (message.getDataType() == "geometry_msgs/TwistWithCovarianceStamped") {
    engine_.on_fix_velocity(*message.instantiate<geometry_msgs::TwistWithCovarianceStamped>(), now);
  } else if (log_.due("fix_velocity's type", ros::WallTime::now())) {
    ROS_WARN_STREAM("fix_velocity: " << message.getDataType() << " is not read from it");
  }
}

void LocalizerNode::on_wheel_odometry(const topic_tools::ShapeShifter& message) {
  const ros::Time now = ros::Time::now();
  if (message.getDataType() == "geometry_msgs/TwistStamped") {
    engine_.on_wheels(*message.instantiate<geometry_msgs::TwistStamped>(), now);
  } else if (message.getDataType() == "nav_msgs/Odometry") {
    engine_.on_wheels(*message.instantiate<nav_msgs::Odometry>(), now);
  } else if (log_.due("wheel_odometry's type", ros::WallTime::now())) {
    ROS_WARN_STREAM("wheel_odometry: " << message.getDataType() << " is not read from it");
  }
}

void LocalizerNode::publish() {
  for (const std::string& remark : engine_.take_remarks()) {
    last_remark_ = remark;
    last_remark_time_ = ros::WallTime::now();
    if (log_.due(remark, ros::WallTime::now())) ROS_WARN_STREAM(remark);
  }
  for (const core::PoseEstimate& estimate : engine_.take_estimates()) {
    last_ = estimate;
    any_ = true;
    localization_publisher_.publish(to_message(estimate, config_));
    const auto odometry = to_odometry(estimate, config_);
    if (!odometry) continue;
    odometry_publisher_.publish(*odometry);
    if (config_.publish_tf) {
      geometry_msgs::TransformStamped transform;
      transform.header = odometry->header;
      transform.child_frame_id = odometry->child_frame_id;
      transform.transform.translation.x = odometry->pose.pose.position.x;
      transform.transform.translation.y = odometry->pose.pose.position.y;
      transform.transform.translation.z = odometry->pose.pose.position.z;
      transform.transform.rotation = odometry->pose.pose.orientation;
      broadcaster_.sendTransform(transform);
    }
    draw(estimate);
  }
}

/// The path by its status, and an ellipse of three standard deviations around the vehicle.
void LocalizerNode::draw(const core::PoseEstimate& estimate) {
  const ros::WallTime now = ros::WallTime::now();
  if ((now - last_drawn_).toSec() < kDrawPeriod) return;
  last_drawn_ = now;
  path_.emplace_back(estimate.position, estimate.code);
  if (path_.size() > kPathLength) path_.pop_front();
  if (markers_publisher_.getNumSubscribers() == 0) return;
  visualization_msgs::Marker path;
  path.header.frame_id = config_.map_frame;
  path.header.stamp = to_ros(estimate.stamp);
  path.ns = "path";
  path.type = visualization_msgs::Marker::LINE_STRIP;
  path.scale.x = 0.3;
  path.pose.orientation.w = 1.0;
  for (const auto& [position, code] : path_) {
    geometry_msgs::Point point;
    point.x = position.x();
    point.y = position.y();
    point.z = position.z();
    path.points.push_back(point);
    path.colors.push_back(colour_of(code));
  }
  visualization_msgs::Marker ellipse;
  ellipse.header = path.header;
  ellipse.ns = "sigma";
  ellipse.type = visualization_msgs::Marker::CYLINDER;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(
      estimate.position_covariance.topLeftCorner<2, 2>());
  const Eigen::Vector2d first = axes.eigenvectors().col(0);
  const double turn = std::atan2(first.y(), first.x());
  ellipse.pose.position.x = estimate.position.x();
  ellipse.pose.position.y = estimate.position.y();
  ellipse.pose.position.z = estimate.position.z();
  ellipse.pose.orientation.z = std::sin(0.5 * turn);
  ellipse.pose.orientation.w = std::cos(0.5 * turn);
  ellipse.scale.x = std::max(0.05, 6.0 * std::sqrt(std::max(0.0, axes.eigenvalues()(0))));
  ellipse.scale.y = std::max(0.05, 6.0 * std::sqrt(std::max(0.0, axes.eigenvalues()(1))));
  ellipse.scale.z = 0.05;
  ellipse.color = colour_of(estimate.code);
  ellipse.color.a = 0.4F;
  visualization_msgs::MarkerArray markers;
  if (path.points.size() > 1) markers.markers.push_back(path);
  markers.markers.push_back(ellipse);
  markers_publisher_.publish(markers);
}

bool LocalizerNode::on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  engine_.localizer().reset();
  path_.clear();
  response.success = true;
  response.message = "everything but the map frame is forgotten";
  return true;
}

bool LocalizerNode::on_align(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const core::LocalizerReport report = engine_.localizer().report();
  engine_.localizer().reset();
  response.success = report.health[static_cast<std::size_t>(core::Sensor::kFix)].heard();
  response.message = response.success
                         ? "aligning: stand for two seconds, or drive straight on"
                         : "no fix has come: the localizer waits for one, and aligns as soon as it comes";
  return true;
}

bool LocalizerNode::on_set_datum(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  if (!any_ || !engine_.localizer().map()) {
    response.message = "there is no pose to put the datum at";
    return true;
  }
  if (config_.localizer.reference.projection == core::Projection::kUtm) {
    response.message = "projection names a UTM zone, which has no datum to be set";
    return true;
  }
  const core::GeoPoint here = engine_.localizer().map()->to_earth(last_.position);
  engine_.localizer().set_reference(
      {core::Projection::kLocal, 0, true, here.latitude, here.longitude, here.altitude});
  path_.clear();
  std::ostringstream text;
  text.precision(10);
  text << "the map's origin is now at " << here.latitude << ", " << here.longitude << ", " << here.altitude;
  response.success = true;
  response.message = text.str();
  return true;
}

void LocalizerNode::summarize(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const core::LocalizerReport report = engine_.localizer().report();
  const bool stale =
      any_ && (ros::Time::now() - to_ros(last_.stamp)).toSec() > std::max(1.0, config_.max_age_fix);
  if (!any_) {
    status.summary(DiagnosticStatus::WARN,
                   "no pose yet: waiting for fix" +
                       std::string(config_.localizer.method == core::Method::kPlanar ? "" : " and imu"));
  } else if (stale) {
    status.summary(DiagnosticStatus::ERROR, "the newest pose is old: have the sensors stopped?");
  } else {
    status.summary(last_.code == core::EstimateCode::kOk        ? DiagnosticStatus::OK
                   : last_.code == core::EstimateCode::kWarning ? DiagnosticStatus::WARN
                                                                : DiagnosticStatus::ERROR,
                   last_.message);
  }
  if (!last_remark_.empty() && (ros::WallTime::now() - last_remark_time_).toSec() < kRemarkTime) {
    status.mergeSummary(DiagnosticStatus::WARN, last_remark_);
  }
  static const char* const kNames[] = {"imu",     "wheels",       "fix",        "fix_velocity",
                                       "heading", "map position", "map heading"};
  for (int source = 1; source < core::kSources; ++source) {
    const core::SourceHealth& health = report.health[source];
    if (!health.heard()) continue;
    const double all = static_cast<double>(health.accepted + health.refused);
    status.addf(kNames[source], "age %.2f s, %.1f %% refused, innovation %.2f of the expected, noise x%.1f",
                (ros::Time::now() - to_ros(health.last)).toSec(), 100.0 * health.refused / all,
                std::sqrt(health.nis), std::sqrt(health.noise_scale));
  }
  status.addf("horizontal sigma [m]", "%.3f", last_.horizontal_stddev());
  status.addf("yaw sigma [deg]", "%.3f", std::sqrt(last_.attitude_covariance(2, 2)) * 180.0 / M_PI);
  status.addf("since the last fix used", "%.1f s, %.1f m", report.since_fix, report.distance);
  status.addf("wheel scale", "%.4f", report.wheel_scale);
  status.addf("mount yaw, pitch beyond what is given [deg]", "%.2f, %.2f", report.mount_yaw * 180.0 / M_PI,
              report.mount_pitch * 180.0 / M_PI);
  status.addf("imu's stamps after the fixes' [s]", "%.3f +- %.3f", report.stamp_offset,
              report.stamp_offset_stddev);
  status.addf("alignments", "%d, made less certain %d times", report.alignments, report.inflations);
}

}  // namespace relative_map
