#pragma once

namespace relative_map {

/// From here on SIGTERM and SIGHUP end ros::ok() as Ctrl-C does, so that a tool can finish what it has begun:
/// a closed terminal, a stopped service or a shutdown must not lose a drive. A signal that was ignored stays
/// so (nohup). To be called after ros::init().
void end_in_order();

}  // namespace relative_map
