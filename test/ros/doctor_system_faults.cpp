#include <utility>

#include "doctor_system.hpp"

// What can be wrong with nodes, topics, time and frames.
namespace relative_map::doctor::test {

std::vector<Fault> node_faults() {
  return {
      {"configuration_is_accepted",
       "BadParameter",
       [](Observations& seen) { seen.config_fault = "rate is 0 Hz, but must be above 0"; },
       "/relative_map: rate is 0 Hz",
       "correct them",
       {}},
      {"clock_runs",
       "ClockStands",
       [](Observations& seen) {
         seen.simulated_time = true;
         seen.end = seen.begin;
       },
       "/clock stands still",
       "rosbag play --clock",
       {}},
      {"clock_runs",
       "NoClock",
       [](Observations& seen) {
         seen.simulated_time = true;
         seen.begin = seen.end = ros::Time();
       },
       "/clock has never come",
       "/use_sim_time false",
       {}},
  };
}

std::vector<Fault> topic_faults() {
  return {
      {"topics_have_publishers",
       "NoNavigation",
       [](Observations& seen) {
         seen.navigation.topic.publishers.clear();
         seen.navigation.messages.clear();
       },
       "nobody publishes /navigation",
       "relative_map/NavigationInfo",
       {}},
      {"topics_have_publishers",
       "NoLaneMarkersButTheyAreAllThereIs",
       [](Observations& seen) {
         seen.config.pipeline.navigation_lane.lane_source = core::LaneSource::kPerception;
         seen.lane_markers.topic.publishers.clear();
         seen.lane_markers.messages.clear();
       },
       "nobody publishes /perception/lane_markers",
       "relative_map/LaneMarkers",
       {}},
      {"topics_have_publishers",
       "NoMapNode",
       [](Observations& seen) {
         seen.map_topic.publishers.clear();
         seen.maps.clear();
       },
       "the map node does not run",
       "roslaunch relative_map relative_map.launch",
       {}},
      {"publishers_answer",
       "DeadPublisher",
       [](Observations& seen) {
         seen.localization.topic.publishers[0].answers = false;
         seen.localization.messages.clear();
       },
       "/ins is registered as publisher of /localization, but does not answer",
       "ROS_IP",
       {}},
      {"types_are_right",
       "WrongType",
       [](Observations& seen) {
         seen.chassis.topic.publishers[0].type = "std_msgs/Float64";
         seen.chassis.messages.clear();
       },
       "/can publishes /chassis as std_msgs/Float64, not as relative_map/Chassis",
       "convert it to relative_map/Chassis",
       {}},
      {"definitions_are_the_same",
       "OtherDefinition",
       [](Observations& seen) {
         seen.chassis.topic.md5sum = "0123";
         seen.chassis.topic.publishers[0].md5sum = "4567";
         seen.chassis.messages.clear();
       },
       "/can publishes /chassis with another definition of relative_map/Chassis (md5sum 4567, here 0123)",
       "from the same messages",
       {}},
      {"topics_have_one_publisher",
       "TwoPublishers",
       [](Observations& seen) {
         Publisher second = seen.localization.topic.publishers[0];
         second.node = "/gps";
         seen.localization.topic.publishers.push_back(second);
       },
       "2 nodes publish /localization: /ins and /gps",
       "stop all but one",
       {}},
      {"map_node_listens",
       "MapNodeRemapped",
       [](Observations& seen) { seen.navigation.topic.subscribers = {"/rosbag_record"}; },
       "/relative_map_manager publishes /relative_map, but does not listen to /navigation",
       "the same remapping of navigation",
       {}},
      {"messages_arrive",
       "NavigationNotLatched",
       [](Observations& seen) {
         seen.navigation.messages.clear();
         seen.navigation.topic.md5sum = seen.navigation.topic.publishers[0].md5sum = "0123";
       },
       "/recorder is to publish /navigation, but in 5.0 s no message came",
       "publish it latched",
       {}},
      {"messages_arrive",
       "SilentMapNode",
       [](Observations& seen) { seen.maps.clear(); },
       "/relative_map_manager is to publish /relative_map",
       "log of the map node",
       {}},
  };
}

std::vector<Fault> time_faults() {
  return {
      {"rates_are_high_enough",
       "SlowLocalization",
       [](Observations& seen) { thin_out(seen.localization.messages, 8); },
       "/localization comes 2.5 times a second; it should come 10 times",
       "raise the rate",
       {}},
      {"inputs_do_not_pause",
       "ChassisDropsOut",
       [](Observations& seen) {
         auto& messages = seen.chassis.messages;
         messages.erase(messages.begin() + 30, messages.begin() + 60);
       },
       "/chassis paused for 1.6 s",
       "drop-outs",
       {}},
      {"stamps_are_filled",
       "NoStamp",
       [](Observations& seen) {
         change(seen.lane_markers, [](LaneMarkers& markers) { markers.header.stamp = ros::Time(); });
       },
       "header.stamp is 0 in 50 of 50 messages",
       "time of measurement",
       {}},
      {"stamps_are_fresh",
       "OldStamps",
       [](Observations& seen) { delay(seen.localization, 3.0); },
       "/localization: header.stamp is 3.0 s old",
       "synchronize the clocks",
       {}},
      {"stamps_are_fresh",
       "BagWithoutClock",
       [](Observations& seen) { delay(seen.chassis, 86400.0); },
       "/chassis: header.stamp is 86400.0 s old",
       "rosbag play --clock",
       {}},
      {"stamps_are_not_ahead",
       "StampsFromTheFuture",
       [](Observations& seen) { delay(seen.chassis, -3.0); },
       "/chassis: header.stamp lies 3.0 s in the future",
       "synchronize the clocks",
       {}},
      {"stamps_are_not_ahead",
       "StampsThatAreScrap",  // farther away than ros::Duration reaches
       [](Observations& seen) {
         std::uint32_t seconds = 4200000000;
         change(seen.chassis, [&](Chassis& chassis) { chassis.header.stamp = ros::Time(seconds++, 0); });
       },
       "/chassis: header.stamp lies 2500000",
       "synchronize the clocks",
       {}},
      {"stamps_rise",
       "StampsRepeat",
       [](Observations& seen) {
         auto& messages = seen.lane_markers.messages;
         for (std::size_t i = 1; i < messages.size(); i += 2) messages[i].message = messages[i - 1].message;
       },
       "of 50 messages 25 repeat the stamp before",
       "its own time of measurement",
       {}},
      {"stamps_rise",
       "StampsGoBack",
       [](Observations& seen) {
         std::swap(seen.lane_markers.messages[20].message, seen.lane_markers.messages[21].message);
       },
       "1 go back in time",
       "bag that starts again",
       {}},
  };
}

std::vector<Fault> frame_faults() {
  return {
      {"map_frames_agree",
       "TwoMapFrames",
       [](Observations& seen) {
         change(seen.navigation, [](NavigationInfo& info) { info.header.frame_id = "utm"; });
       },
       "/navigation is in frame 'utm', but /localization in 'map'",
       "header.frame_id of both",
       {}},
      {"localized_link_is_known",
       "NoTransformOfTheLink",
       [](Observations& seen) {
         change(seen.localization, [](LocalizationEstimate& pose) { pose.child_frame_id = "gps_link"; });
       },
       "no transform from 'gps_link', the child_frame_id of /localization",
       "static_transform_publisher X Y Z YAW PITCH ROLL base_link gps_link",
       {}},
      {"marker_frame_is_known",
       "NoTransformOfTheCamera",
       [](Observations& seen) {
         change(seen.lane_markers, [](LaneMarkers& markers) { markers.header.frame_id = "front_camera"; });
       },
       "no transform from 'front_camera', the header.frame_id of /perception/lane_markers",
       "static_transform_publisher X Y Z YAW PITCH ROLL base_link front_camera",
       {}},
      {"marker_frame_is_flu",
       "OpticalFrame",
       [](Observations& seen) {
         Eigen::Matrix3d optical;  // its axes as columns: x right, y down, z forward
         optical << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
         Places places = healthy_places();
         places["camera_link"] = Eigen::Isometry3d(optical);
         seen.transforms = transforms_of(places);
       },
       "/perception/lane_markers is in frame 'camera_link', whose x does not point forward",
       "optical frame",
       {}},
  };
}

}  // namespace relative_map::doctor::test
