// Prints, for each map, where the middle of the vehicle's lane is 20 m ahead: a start for a planner of your
// own.
#include <relative_map/MapMsg.h>
#include <ros/ros.h>

void on_map(const relative_map::MapMsgConstPtr& map) {
  if (map->status.code != relative_map::MapStatus::OK) {  // the map is empty: do not drive on by the last one
    ROS_WARN_STREAM("no map: " << map->status.message);
    return;
  }
  for (const relative_map::LaneNavigationPath& lane : map->navigation_path) {
    if (lane.lane_id != map->current_lane_id) continue;
    for (const relative_map::PathPoint& point : lane.navigation_path.path.path_point) {
      if (point.s < lane.vehicle_s + 20.0) continue;  // along the lane: x rises and falls where it bends
      ROS_INFO("%zu lanes; mine is at y = %+.2f m, curved by %.4f 1/m", map->navigation_path.size(), point.y,
               point.kappa);  // body frame: x forward, y left
      return;
    }
  }
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "lane_ahead");
  ros::NodeHandle nh;
  const ros::Subscriber subscriber = nh.subscribe("relative_map", 1, on_map);
  ros::spin();
}
