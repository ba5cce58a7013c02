#include "orderly_end.hpp"

#include <ros/init.h>
#include <signal.h>

namespace relative_map {

void end_in_order() {
  struct sigaction action = {};
  // As roscpp's own handler for Ctrl-C: it does nothing but note that the end is wanted.
  action.sa_handler = [](int) { ros::requestShutdown(); };
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

}  // namespace relative_map
