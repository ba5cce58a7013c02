#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <tf2_ros/transform_listener.h>

#include <string>

#include "relative_map/ros/health/throttled_log.hpp"
#include "relative_map/ros/prediction/prediction_engine.hpp"

namespace relative_map {

/// Topics and timers around the prediction engine; the nodelet and the stand-alone node are shells of it.
/// In: `perception/obstacles`, `relative_map`, `localization`, `planning`. Out: `prediction`, `~markers`,
/// `/diagnostics`. All on the callback queue of the node handles.
class PredictionNode {
 public:
  /// Throws std::runtime_error that names every bad parameter, before anything is advertised.
  PredictionNode(ros::NodeHandle nh, ros::NodeHandle private_nh);
  ~PredictionNode();

 private:
  template <class Message>
  void subscribe(const std::string& topic, uint32_t queue_size, ros::Subscriber& subscriber,
                 void (PredictionEngine::*handler)(const boost::shared_ptr<const Message>&,
                                                   const ros::Time&));
  void on_timer(const ros::TimerEvent& event);
  void log(const PredictionObstacles& message);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  ros::NodeHandle nh_, private_nh_;
  PredictionNodeConfig config_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;
  PredictionEngine engine_;
  ros::Publisher publisher_, markers_publisher_;
  ros::Subscriber obstacles_, map_, localization_, planning_;
  diagnostic_updater::Updater diagnostics_;
  ros::Timer timer_;
  ros::WallTimer diagnostics_timer_;
  ThrottledLog complaints_;
  PredictionStatus status_;    ///< of the last prediction
  std::size_t predicted_ = 0;  ///< road users in it
  double tick_time_ = 0.0;     ///< [s] that it took
  ros::WallTime published_;
};

}  // namespace relative_map
