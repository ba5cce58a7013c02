// The stand-alone node: a shell around LocalizerNode.
#include <ros/ros.h>

#include "relative_map/ros/localizer/localizer_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "localizer");
  // With the last of its handles a node's log ends: these outlive the catch.
  const ros::NodeHandle nh, private_nh("~");
  try {
    relative_map::LocalizerNode node(nh, private_nh);
    ros::spin();
  } catch (const std::exception& fault) {
    ROS_FATAL_STREAM(fault.what());
    return 1;
  }
  return 0;
}
