#include "relative_map/ros/route/route_engine.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/ros/messages/route_conversions.hpp"
#include "relative_map/route/relative_map_route.hpp"
#include "relative_map/route/route_check.hpp"
#include "relative_map/route/route_identity.hpp"

namespace relative_map {

namespace {

constexpr double kNearLane = 10.0;  // [m] that a point may be from the lane that it is meant to be on

core::RouteUpdate refused(const core::RouteStatus& status) {
  core::RouteUpdate update;
  update.status = status;
  return update;
}

std::string age_text(double age) {
  std::ostringstream text;
  text.precision(3);
  text << age << " s";
  return text.str();
}

}  // namespace

RouteEngine::RouteEngine(const RouteNodeConfig& config, LinkTransforms transforms)
    : config_(config), transforms_(std::move(transforms)), map_(config.route), change_(config.lane_change) {}

core::RouteStatus RouteEngine::set_graph(std::shared_ptr<const core::LaneNetwork> network) {
  lines_.emplace(network, config_.reference_line);
  search_.emplace(network, config_.search);
  forget_lane_change("another lane graph has come");
  return map_.set_graph(std::move(network));
}

core::RouteStatus RouteEngine::set_route(const core::Route& route) {
  if (follows(route)) return {};
  const core::RouteStatus status = map_.set_route(route);
  if (status.code == core::RouteCode::kOk) forget_lane_change("another route has come");
  return status;
}

bool RouteEngine::follows(const core::Route& route) const {
  return map_.route() &&
         (core::same_way(*map_.route(), route) || (asked_route_ && core::same_way(*asked_route_, route)));
}

void RouteEngine::forget_lane_change(const std::string& why) {
  change_.abandon(why, last_tick_.toSec());
  asked_route_.reset();
  way_before_.reset();
}

double RouteEngine::speed(const ros::Time& now) const {
  const bool chassis_fresh = std::abs((now - chassis_stamp_).toSec()) <= config_.max_age_chassis;
  return chassis_fresh ? chassis_speed_ : pose_speed_;
}

void RouteEngine::clear_route() {
  forget_lane_change("the route was cleared");
  map_.clear_route();
}

void RouteEngine::on_localization(const LocalizationEstimateConstPtr& message, const ros::Time& received) {
  const core::Localization localization = to_core(*message, config_.orientation_convention, received);
  const ros::Time stamp = to_ros(localization.stamp);
  if (pose_ && stamp < pose_stamp_) return;  // a late one
  pose_stamp_ = stamp;
  pose_frame_ = frame_name(message->header.frame_id);
  pose_fault_.clear();
  pose_.reset();
  const std::string link =
      message->child_frame_id.empty() ? config_.base_frame : frame_name(message->child_frame_id);
  Eigen::Vector3d position = localization.position;
  const Eigen::Vector3d forward = localization.map_from_body * Eigen::Vector3d::UnitX();
  double heading =
      std::isfinite(localization.heading) ? localization.heading : std::atan2(forward.y(), forward.x());
  if (link != config_.base_frame) {
    const auto link_from_base = transforms_(link, config_.base_frame, stamp);
    if (!link_from_base) {
      pose_fault_ =
          "no transform from localization's child_frame_id '" + link + "' to '" + config_.base_frame + "'";
      return;
    }
    const Eigen::Vector3d ahead = link_from_base->rotation() * Eigen::Vector3d::UnitX();
    const core::Pose2 link_pose(position.head<2>(), heading);
    const core::Pose2 base = link_pose.to_parent(
        core::Pose2(link_from_base->translation().head<2>(), std::atan2(ahead.y(), ahead.x())));
    position.head<2>() = base.position();
    heading = base.heading();
  }
  if (!position.head<2>().allFinite() || !std::isfinite(heading)) {
    pose_fault_ = "localization: position or direction is not finite";
    return;
  }
  pose_ = core::Pose2(position.head<2>(), core::normalize_angle(heading));
  pose_speed_ = localization.linear_velocity.head<2>().norm();
}

void RouteEngine::on_chassis(const ChassisConstPtr& message, const ros::Time& received) {
  const core::Chassis chassis = to_core(*message, received);
  chassis_stamp_ = to_ros(chassis.stamp);
  chassis_speed_ = std::abs(chassis.speed);
}

std::optional<core::RouteStatus> RouteEngine::fault(const ros::Time& now) const {
  using core::RouteCode;
  if (map_.network() == nullptr || map_.index() == nullptr) return std::nullopt;  // the map says so itself
  if (pose_stamp_.isZero()) return std::nullopt;
  const double age = (now - pose_stamp_).toSec();
  if (age > config_.max_age_localization) {
    return core::RouteStatus{RouteCode::kStaleLocalization,
                             "the newest localization is " + age_text(age) + " old"};
  }
  if (-age > config_.max_age_localization) {
    return core::RouteStatus{RouteCode::kNoLocalization, "localization: header.stamp is ahead of the clock"};
  }
  if (!pose_fault_.empty()) return core::RouteStatus{RouteCode::kNoLocalization, pose_fault_};
  const std::string& graph_frame = map_.network()->frame_id();
  if (!graph_frame.empty() && !pose_frame_.empty() && graph_frame != pose_frame_) {
    return core::RouteStatus{RouteCode::kFrameMismatch, "the lane graph is in frame '" + graph_frame +
                                                            "', but localization in '" + pose_frame_ + "'"};
  }
  return std::nullopt;
}

void RouteEngine::note_time(const ros::Time& now) {
  // A recording that starts again: what was received belongs to its end.
  if (now < last_tick_) {
    pose_.reset();
    pose_fault_.clear();
    pose_stamp_ = told_stamp_ = chassis_stamp_ = map_stamp_ = ros::Time();
  }
  last_tick_ = now;
}

RouteSegmentsArrayPtr RouteEngine::tick(const ros::Time& now) {
  note_time(now);
  const bool fresh = pose_ && std::abs((now - pose_stamp_).toSec()) <= config_.max_age_localization;
  if (fresh && pose_stamp_ == told_stamp_) return nullptr;
  told_stamp_ = pose_stamp_;
  core::RouteUpdate update;
  if (const auto found = fault(now)) {
    update = refused(*found);
    note_lane_change(update, now);
  } else {
    update = map_.update(pose_, speed(now));
    if (note_lane_change(update, now)) update = map_.update(pose_, speed(now));
    change_.raise_target(update);
    update = core::checked(std::move(update), map_.index());
  }
  std::vector<core::ReferenceLine> lines;
  if (!update.segments.empty()) lines = lines_->make(update.segments, pose_->position());
  const std::string frame = map_.network() != nullptr && !map_.network()->frame_id().empty()
                                ? map_.network()->frame_id()
                                : pose_frame_;
  return message_of(std::move(update), lines, fresh ? pose_stamp_ : now, frame);
}

RouteSegmentsArrayPtr RouteEngine::on_relative_map(const MapMsg& map, const ros::Time& now) {
  map_stamp_ = now;
  last_map_ = to_core(map);
  core::RelativeMap relative_map = last_map_;
  prefer_lane(relative_map, now);
  core::RouteUpdate update = core::route_on_relative_map(relative_map).update;
  if (note_lane_change(update, now)) {
    relative_map = last_map_;
    prefer_lane(relative_map, now);
    update = core::route_on_relative_map(relative_map).update;
  }
  change_.raise_target(update);
  update = core::checked(std::move(update), nullptr);
  // The lanes' own paths are lines already: smoothed, with heading and curvature.
  std::vector<core::ReferenceLine> lines;
  for (const core::RouteSegments& segments : update.segments) {
    core::ReferenceLine line;
    line.id = segments.id;
    line.s = segments.s;
    for (const core::Lane& lane : relative_map.lanes) {
      if (lane.id != segments.id) continue;
      for (const core::PathPoint& point : lane.path) {
        core::ReferencePoint to;
        to.path = point;
        const double bend =
            std::sqrt(config_.reference_line.lateral_acceleration / std::max(1e-9, std::abs(point.kappa)));
        to.speed_limit =
            std::min(lane.speed_limit > 0.0 ? lane.speed_limit : config_.reference_line.speed_limit, bend);
        line.points.push_back(to);
      }
    }
    lines.push_back(std::move(line));
  }
  return message_of(std::move(update), lines, map.header.stamp, frame_name(map.header.frame_id));
}

RouteSegmentsArrayPtr RouteEngine::check_map_age(const ros::Time& now) {
  note_time(now);
  const double age = (now - map_stamp_).toSec();
  if (!map_stamp_.isZero() && age <= config_.max_age_relative_map) return nullptr;
  const core::RouteStatus status =
      map_stamp_.isZero() ? core::RouteStatus{core::RouteCode::kNoMap, "no relative map has come"}
                          : core::RouteStatus{core::RouteCode::kStaleMap,
                                              "the newest relative map came " + age_text(age) + " ago"};
  return message_of(refused(status), {}, now, config_.base_frame);
}

RouteSegmentsArrayPtr RouteEngine::message_of(core::RouteUpdate update,
                                              const std::vector<core::ReferenceLine>& lines,
                                              const ros::Time& stamp, const std::string& frame_id) {
  last_ = std::move(update);
  RouteSegmentsArrayPtr message = to_message(last_, lines);
  message->header.stamp = stamp;
  message->header.frame_id = frame_id;
  message->sequence_num = ++sequence_num_;
  if (map_.route()) message->route_id = core::route_identity(*map_.route());
  return message;
}

std::optional<core::LanePosition> RouteEngine::place_of(const core::Point2& point, double heading) const {
  std::optional<core::LanePosition> best;
  double best_distance = kNearLane;
  for (const std::size_t lane : map_.network()->lanes_near(point, kNearLane)) {
    const core::LaneNetwork::Lane& candidate = map_.network()->lane(lane);
    const core::LaneProjection projection = candidate.line.project(point);
    const bool against =
        std::isfinite(heading) &&
        std::abs(core::angle_difference(projection.heading, heading)) > config_.route.max_heading;
    if (against || projection.distance >= best_distance) continue;
    best_distance = projection.distance;
    best = core::LanePosition{candidate.source.id, std::clamp(projection.s, 0.0, candidate.length())};
  }
  return best;
}

core::SearchResult RouteEngine::find(const FindRoute::Request& request) {
  core::SearchResult result;
  if (!search_) {
    result.why_not = "there is no lane graph";
    return result;
  }
  core::SearchRequest places;
  places.closed_lanes.insert(request.closed_lane.begin(), request.closed_lane.end());
  if (request.from_vehicle) {
    if (!pose_) {
      result.why_not = "there is no localization to start from";
      return result;
    }
    const auto place = place_of(pose_->position(), pose_->heading());
    if (!place) {
      result.why_not = "no lane within 10 m of the vehicle leads its way";
      return result;
    }
    places.places.push_back(*place);
  }
  for (std::size_t i = 0; i < request.waypoint.size(); ++i) {
    const RouteWaypoint& waypoint = request.waypoint[i];
    if (!waypoint.lane_id.empty()) {
      places.places.push_back({waypoint.lane_id, waypoint.s});
      continue;
    }
    const auto place = place_of({waypoint.pose.x, waypoint.pose.y}, waypoint.heading);
    if (!place) {
      result.why_not = "no lane within 10 m of waypoint " + std::to_string(i);
      return result;
    }
    places.places.push_back(*place);
  }
  return search_->find(places);
}

}  // namespace relative_map
