#pragma once

#include <relative_map/Chassis.h>
#include <relative_map/FindRoute.h>
#include <relative_map/LocalizationEstimate.h>
#include <relative_map/MapMsg.h>
#include <relative_map/RouteSegmentsArray.h>
#include <ros/time.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/ros/route/route_parameters.hpp"
#include "relative_map/ros/setup/frames.hpp"
#include "relative_map/route/lane_change.hpp"
#include "relative_map/route/lane_change_plan.hpp"
#include "relative_map/route/reference_line.hpp"
#include "relative_map/route/route_map.hpp"
#include "relative_map/route/route_search.hpp"

namespace relative_map {

/// What a request for a lane change is answered: the lane to change to, or why not.
struct LaneChangeAnswer {
  std::string why_not, lane_id;
};

/// Messages in, segments out: all of the route node but its topics. `now` is an argument.
class RouteEngine {
 public:
  RouteEngine(const RouteNodeConfig& config, LinkTransforms transforms);

  /// Takes a graph, prepared before. A route that does not fit it is cleared: the status then says why.
  core::RouteStatus set_graph(std::shared_ptr<const core::LaneNetwork> network);
  /// Takes a route; one that is wrong leaves the old one in place.
  core::RouteStatus set_route(const core::Route& route);
  void clear_route();
  /// Whether a route leads the way that is followed, or the one that a lane change has led away from.
  bool follows(const core::Route& route) const;
  void on_localization(const LocalizationEstimateConstPtr& message, const ros::Time& received);
  void on_chassis(const ChassisConstPtr& message, const ros::Time& received);

  /// What there is to follow now. None if the pose is the one of the last call and still fresh.
  RouteSegmentsArrayPtr tick(const ros::Time& now);
  /// The same on a relative map, at its time.
  RouteSegmentsArrayPtr on_relative_map(const MapMsg& map, const ros::Time& now);
  /// Source relative_map: what is told where no map has come for too long; none while maps come.
  RouteSegmentsArrayPtr check_map_age(const ros::Time& now);

  core::SearchResult find(const FindRoute::Request& request);

  /// Asks for a lane change, or takes the last one back.
  LaneChangeAnswer change_lane(const core::LaneChangeRequest& request, const ros::Time& now);
  const core::LaneChangeStatus& lane_change() const { return change_.status(); }

  const core::RouteMap& map() const { return map_; }
  const core::RouteUpdate& last() const { return last_; }

 private:
  LaneChangeAnswer take_back(const ros::Time& now);
  void restore_way();
  /// Whether the lane change has ended, and the way that is followed is another one now.
  bool note_lane_change(const core::RouteUpdate& update, const ros::Time& now);
  void prefer_lane(core::RelativeMap& map, const ros::Time& now);
  void forget_lane_change(const std::string& why);
  double speed(const ros::Time& now) const;
  void note_time(const ros::Time& now);
  std::optional<core::RouteStatus> fault(const ros::Time& now) const;
  RouteSegmentsArrayPtr message_of(core::RouteUpdate update, const std::vector<core::ReferenceLine>& lines,
                                   const ros::Time& stamp, const std::string& frame_id);
  std::optional<core::LanePosition> place_of(const core::Point2& point, double heading) const;

  RouteNodeConfig config_;
  LinkTransforms transforms_;
  core::RouteMap map_;
  std::optional<core::ReferenceLineMaker> lines_;
  std::optional<core::RouteSearch> search_;
  std::optional<core::Pose2> pose_;  ///< of the base frame
  std::string pose_frame_, pose_fault_;
  ros::Time pose_stamp_, told_stamp_, chassis_stamp_, map_stamp_, last_tick_;
  double chassis_speed_ = 0.0, pose_speed_ = 0.0;
  core::RouteUpdate last_;
  core::LaneChange change_;
  std::optional<core::Route> asked_route_;  ///< that lane changes have led away from; none: it is followed
  std::optional<core::Route> way_before_;   ///< to be followed again if the lane change fails
  core::RelativeMap last_map_;
  std::string preferred_lane_, preferred_before_;  ///< of the relative map; empty: its best one
  uint32_t sequence_num_ = 0;
};

}  // namespace relative_map
