// The stand-alone node: a shell around AdaptersNode.
#include <ros/ros.h>

#include "relative_map/ros/adapters/adapters_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "relative_map_adapters");
  // With the last of its handles a node's log ends: these outlive the catch.
  const ros::NodeHandle nh, private_nh("~");
  try {
    const relative_map::AdaptersNode node(nh, private_nh);
    ros::spin();
  } catch (const std::exception& fault) {
    ROS_FATAL_STREAM(private_nh.getNamespace() << ": " << fault.what());
    return 1;
  }
  return 0;
}
