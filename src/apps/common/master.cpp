#include "master.hpp"

#include <ros/master.h>
#include <ros/time.h>

#include <cstdio>

namespace relative_map {

void wait_for_master() {
  for (bool told = false; !ros::master::check(); told = true) {
    if (!told) {
      std::fprintf(stderr, "waiting for a master at %s; Ctrl-C ends it\n", ros::master::getURI().c_str());
    }
    ros::WallDuration(0.2).sleep();
  }
}

}  // namespace relative_map
