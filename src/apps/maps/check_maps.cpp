// Holds the maps in a bag against the output contract.
#include <relative_map/MapMsg.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "bag_input.hpp"
#include "command_line.hpp"
#include "relative_map/ros/health/lost_maps.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/ros/messages/message_check.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    "usage: rosrun relative_map check_maps BAG [--topic TOPIC] [--frame FRAME]\n"
    "\n"
    "Checks every map in BAG against the output contract and prints a table: row, violations, first stamp, "
    "example.\n"
    "Exit code 0: no violation; 1: some; 2: the bag can't be read, or has no maps.\n"
    "\n"
    "  --topic TOPIC   where the maps are; need not be named where one topic of the bag has maps\n"
    "  --frame FRAME   the body frame they should be in (default base_link)\n";

struct Arguments {
  std::string bag, topic, frame = "base_link";
};

Arguments parse(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--topic", "--frame"});
  Arguments arguments;
  arguments.bag = line.files(1, 1, "a bag")[0];
  arguments.topic = line.text("--topic", arguments.topic);
  arguments.frame = line.text("--frame", arguments.frame);
  return arguments;
}

/// What was found for one row.
struct Finding {
  std::size_t count = 0;
  ros::Time first;
  std::string example;
};

class Table {
 public:
  void add(const MapMsg& map, core::MapContext& context) {
    ++maps_;
    if (map.hdmap.lane.empty()) ++empty_;
    lost_ += note_lost(map, context);
    note_clock(map, context);
    for (const core::Violation& violation : check_message(map, context)) {
      Finding& finding = findings_[violation.row];
      if (++finding.count > 1) continue;
      finding.first = map.header.stamp;
      finding.example = violation.what;
    }
    context.previous_sequence_num = map.sequence_num;
    context.previous_stamp = to_core(map.header.stamp);
  }

  void print() {
    std::printf("%-16s %10s  %-20s %s\n", "row", "violations", "first stamp", "first violation");
    std::vector<std::string> rows = core::map_check_rows();
    for (const std::string& row : message_check_rows()) rows.push_back(row);
    for (const std::string& row : rows) {
      const Finding& finding = findings_[row];
      const std::string stamp = finding.count > 0 ? std::to_string(finding.first.toSec()) : "-";
      std::printf("%-16s %10zu  %-20s %s\n", row.c_str(), finding.count, stamp.c_str(),
                  finding.example.c_str());
    }
    std::printf("%zu maps, %zu of them empty, %zu rows broken", maps_, empty_, broken_rows());
    // Of queue, network or recorder: the node numbers those that it published.
    if (lost_ > 0) std::printf("; %zu maps were lost before they were recorded", lost_);
    std::printf("\n");
  }

  std::size_t broken_rows() const {
    std::size_t broken = 0;
    for (const auto& [row, finding] : findings_) broken += finding.count > 0;
    return broken;
  }
  std::size_t maps() const { return maps_; }

 private:
  std::map<std::string, Finding> findings_;
  std::size_t maps_ = 0, empty_ = 0, lost_ = 0;
};

/// As it stands in the bag, with or without a leading slash.
std::string map_topic(const rosbag::Bag& bag, const Arguments& arguments) {
  const std::string wanted = arguments.topic.empty() ? "/relative_map" : arguments.topic;
  bool others = false;
  for (const rosbag::ConnectionInfo* connection : rosbag::View(bag).getConnections()) {
    if (frame_name(connection->topic) == frame_name(wanted)) return connection->topic;
    others |= connection->datatype == "relative_map/MapMsg";
  }
  // Of a vehicle in a namespace, maybe; where there are several, they are listed.
  if (arguments.topic.empty() && others) return find_topic(bag, arguments.bag, "", {"relative_map/MapMsg"});
  return wanted;
}

int run(const std::vector<std::string>& words) {
  const Arguments arguments = parse(words);
  rosbag::Bag bag;
  open_bag(arguments.bag, bag);
  const std::string topic = map_topic(bag, arguments);
  Table table;
  core::MapContext context;
  context.frame_id = arguments.frame;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    const MapMsgConstPtr map = instance.instantiate<MapMsg>();
    if (!map) {
      throw std::runtime_error(topic + " has type " + instance.getDataType() +
                               " of another definition, not " + "this package's MapMsg");
    }
    table.add(*map, context);
  }
  if (table.maps() == 0) throw std::runtime_error(arguments.bag + ": there is no map on " + topic);
  table.print();
  return table.broken_rows() == 0 ? 0 : 1;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("check_maps", relative_map::kUsage, argc, argv, relative_map::run, 2);
}
