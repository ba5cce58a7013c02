#include <algorithm>

#include "doctor_rules.hpp"
#include "relative_map/ros/messages/conversions.hpp"

// What frames messages name, and whether they are known.
namespace relative_map::doctor {

namespace {

std::string how_to_publish(const std::string& parent, const std::string& child) {
  return "have robot_state_publisher publish the vehicle's URDF, or: "
         "rosrun tf2_ros static_transform_publisher "
         "X Y Z YAW PITCH ROLL " +
         parent + " " + child;
}

/// Where the markers' frame is in the body frame; none if that is not known or no markers came.
std::optional<Eigen::Isometry3d> base_from_marker_frame(const Observations& seen) {
  if (seen.lane_markers.messages.empty()) return std::nullopt;
  const std::string& base_frame = seen.config.pipeline.base_frame;
  const LaneMarkers& markers = *seen.lane_markers.messages.back().message;
  return seen.transforms(base_frame, link_of(markers.header.frame_id, base_frame), markers.header.stamp);
}

}  // namespace

Findings map_frames_agree(const Evidence& evidence) {
  const Observations& seen = evidence.seen;
  if (seen.navigation.messages.empty() || seen.localization.messages.empty()) return {};
  const std::string lines = frame_name(seen.navigation.messages.back().message->header.frame_id);
  const std::string pose = frame_name(seen.localization.messages.back().message->header.frame_id);
  const std::string &lines_topic = seen.navigation.topic.name, &pose_topic = seen.localization.topic.name;
  if (lines != pose) {
    return {
        wrong(lines_topic + " is in frame " + quoted(lines) + ", but " + pose_topic + " in " + quoted(pose),
              "put the name of the one map frame in header.frame_id of both (the localized link belongs in "
              "localization's child_frame_id); if they are two frames, bring one into the other")};
  }
  if (!lines.empty()) return {ok(lines_topic + " and " + pose_topic + " are both in frame " + quoted(lines))};
  return {note(lines_topic + " and " + pose_topic + " both name no frame",
               "fill header.frame_id with the name of the map frame, so that a mix-up can be noticed")};
}

Findings localized_link_is_known(const Evidence& evidence) {
  const Observations& seen = evidence.seen;
  if (seen.localization.messages.empty()) return {};
  const std::string& base_frame = seen.config.pipeline.base_frame;
  const std::string link = link_of(seen.localization.messages.back().message->child_frame_id, base_frame);
  if (link == base_frame)
    return {ok(seen.localization.topic.name + " is about " + quoted(link) + ", the body frame")};
  if (seen.transforms(link, base_frame, seen.localization.messages.back().message->header.stamp)) {
    return {ok(seen.localization.topic.name + " is about link " + quoted(link) + ", whose place in " +
               quoted(base_frame) + " is known")};
  }
  return {
      wrong("there is no transform from " + quoted(link) + ", the child_frame_id of " +
                seen.localization.topic.name + ", to the body frame " + quoted(base_frame),
            how_to_publish(base_frame, link) +
                "; if the pose is that of the body frame, leave child_frame_id empty; if the body frame has "
                "another name, set base_frame")};
}

Findings marker_frame_is_known(const Evidence& evidence) {
  const Observations& seen = evidence.seen;
  if (seen.lane_markers.messages.empty() || base_from_marker_frame(seen)) return {};
  const std::string frame = frame_name(seen.lane_markers.messages.back().message->header.frame_id);
  const std::string& base_frame = seen.config.pipeline.base_frame;
  return {wrong("there is no transform from " + quoted(frame) + ", the header.frame_id of " +
                    seen.lane_markers.topic.name + ", to the body frame " + quoted(base_frame),
                how_to_publish(base_frame, frame) +
                    "; if the markers are in the body frame, say so in header.frame_id")};
}

Findings marker_frame_is_flu(const Evidence& evidence) {
  const auto base_from_frame = base_from_marker_frame(evidence.seen);
  if (!base_from_frame) return {};
  constexpr double kAlike = 0.5;  // cosine of 60 degrees: cameras look a little down or aside
  const Eigen::Matrix3d axes = base_from_frame->linear();
  if (axes(0, 0) > kAlike && axes(2, 2) > kAlike) return {};
  const Input<LaneMarkers>& input = evidence.seen.lane_markers;
  return {
      wrong(input.topic.name + " is in frame " +
                quoted(frame_name(input.messages.back().message->header.frame_id)) +
                ", whose x does not point forward or whose z does not point up",
            "name a frame with x forward, y left, z up in header.frame_id: not the camera's optical frame, "
            "whose z points forward")};
}

}  // namespace relative_map::doctor
