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
    "  --topic TOPIC   where the maps are (default /relative_map)\n"
    "  --frame FRAME   the body frame they should be in (default base_link)\n";

struct Arguments {
  std::string bag, topic = "/relative_map", frame = "base_link";
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
    for (const core::Violation& violation : check_message(map, context)) {
      Finding& finding = findings_[violation.row];
      if (++finding.count > 1) continue;
      finding.first = map.header.stamp;
      finding.example = violation.what;
    }
    context.previous_sequence_num = map.sequence_num;
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
    std::printf("%zu maps, %zu of them empty, %zu rows broken\n", maps_, empty_, broken_rows());
  }

  std::size_t broken_rows() const {
    std::size_t broken = 0;
    for (const auto& [row, finding] : findings_) broken += finding.count > 0;
    return broken;
  }
  std::size_t maps() const { return maps_; }

 private:
  std::map<std::string, Finding> findings_;
  std::size_t maps_ = 0, empty_ = 0;
};

int run(const std::vector<std::string>& words) {
  const Arguments arguments = parse(words);
  rosbag::Bag bag;
  open_bag(arguments.bag, bag);
  Table table;
  core::MapContext context;
  context.frame_id = arguments.frame;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(arguments.topic))) {
    const MapMsgConstPtr map = instance.instantiate<MapMsg>();
    if (!map) {
      throw std::runtime_error(arguments.topic + " has type " + instance.getDataType() +
                               " of another definition, not " + "this package's MapMsg");
    }
    table.add(*map, context);
  }
  if (table.maps() == 0) throw std::runtime_error(arguments.bag + ": there is no map on " + arguments.topic);
  table.print();
  return table.broken_rows() == 0 ? 0 : 1;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("check_maps", relative_map::kUsage, argc, argv, relative_map::run, 2);
}
