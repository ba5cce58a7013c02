// Watches the published maps: a line a second for people, and the output contract for each map.
#include <relative_map/MapMsg.h>
#include <ros/ros.h>

#include <cstdio>
#include <map>
#include <string>

#include "master.hpp"
#include "orderly_end.hpp"
#include "relative_map/pipeline/lanes/lane_path.hpp"
#include "relative_map/ros/health/diagnostics.hpp"
#include "relative_map/ros/health/lost_maps.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/ros/messages/message_check.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    R"(Usage: rosrun relative_map map_monitor [relative_map:=TOPIC] [_base_frame:=FRAME]

Watches the maps on `relative_map`: a line a second with lanes, points, source, lateral offset and remaining distance, or
why there is no map, and each violation of the output contract. Runs until it is interrupted, and then prints the sums.

  relative_map:=TOPIC   where the maps are
  _base_frame:=FRAME    the body frame they should be in (base_link)

Exit codes: 0 no violation, 1 some, 2 no map ever came. A map that got lost on the way is told, and no violation.
)";

}  // namespace

class MapMonitor {
 public:
  MapMonitor(ros::NodeHandle nh, ros::NodeHandle private_nh) {
    private_nh.param<std::string>("base_frame", context_.frame_id, context_.frame_id);
    subscriber_ =
        nh.subscribe<MapMsg>("relative_map", 100, [this](const MapMsgConstPtr& map) { on_map(*map); });
    timer_ = nh.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { print_line(); });
  }

  /// Prints what was seen in all; the process's exit code.
  int summary() const {
    std::printf("%zu maps, %zu of them empty, %zu contract violations, %zu lost on the way\n", maps_, empty_,
                violations_, lost_);
    for (const auto& [row, count] : violations_by_row_) std::printf("  %s: %zu\n", row.c_str(), count);
    if (maps_ == 0) std::printf("no map ever came on %s\n", subscriber_.getTopic().c_str());
    return maps_ == 0 ? 2 : violations_ == 0 ? 0 : 1;
  }

 private:
  void on_map(const MapMsg& message) {
    last_ = to_core(message);
    fresh_ = true;
    ++maps_;
    if (last_.lanes.empty()) ++empty_;
    lost_ += note_lost(message, context_);
    note_clock(message, context_);
    for (const core::Violation& violation : check_message(message, context_)) {
      ++violations_;
      if (++violations_by_row_[violation.row] <= 3) {
        std::printf("CONTRACT VIOLATION, %s: %s\n", violation.row.c_str(), violation.what.c_str());
      }
    }
    context_.previous_sequence_num = last_.sequence_num;
    context_.previous_stamp = last_.stamp;
  }

  void print_line() {
    if (!fresh_) {
      std::printf("no map in the last second\n");
    } else if (last_.lanes.empty()) {
      std::printf("0 lanes | %s: %s\n", status_name(last_.status.code).c_str(), last_.status.message.c_str());
    } else {
      print_lanes();
    }
    std::fflush(stdout);
    fresh_ = false;
  }

  void print_lanes() const {
    std::size_t points = 0;
    core::LanePath current;
    double remaining = 0.0;
    for (const core::Lane& lane : last_.lanes) {
      points += lane.path.size();
      if (lane.id != last_.current_lane_id) continue;
      current.points = lane.path;
      remaining = lane.remaining_distance;
    }
    if (current.points.size() > 1) core::locate_vehicle(current);
    std::printf("%zu lanes | %zu points | %s | lateral offset %+.2f m | remaining %.0f m\n",
                last_.lanes.size(), points, source_name(last_.fusion.source).c_str(), current.l, remaining);
  }

  core::MapContext context_;
  core::RelativeMap last_;
  bool fresh_ = false;
  std::size_t maps_ = 0, empty_ = 0, violations_ = 0, lost_ = 0;
  std::map<std::string, std::size_t> violations_by_row_;
  ros::Subscriber subscriber_;
  ros::WallTimer timer_;
};

}  // namespace relative_map

int main(int argc, char** argv) {
  if (argc == 2 && (std::string(argv[1]) == "--help" || std::string(argv[1]) == "-h")) {
    std::fputs(relative_map::kUsage, stdout);
    return 0;
  }
  ros::init(argc, argv, "map_monitor", ros::init_options::AnonymousName);
  relative_map::wait_for_master();
  relative_map::end_in_order();
  const relative_map::MapMonitor monitor{ros::NodeHandle(), ros::NodeHandle("~")};
  ros::spin();
  return monitor.summary();
}
