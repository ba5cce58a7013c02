// Checks every prediction of a bag against the rows that planners may rely on.
#include <relative_map/PredictionObstacles.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <iostream>
#include <map>

#include "bag_input.hpp"
#include "navigation_line_command.hpp"
#include "relative_map/prediction/prediction_check.hpp"
#include "relative_map/ros/prediction/prediction_messages.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    R"(usage: check_prediction BAG [--topic NAME]

Checks all predictions of a bag. Prints each broken row with its first fault and how often it was broken; the exit code
is 0 if there is none, 1 if there are some, 2 if the bag can't be checked.

  --topic NAME    of the predictions; needed where the bag has several
)";

int run(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--topic"});
  const std::string path = line.files(1, 1, "BAG").front();
  rosbag::Bag bag;
  open_bag(path, bag);
  const std::string topic = find_topic(bag, path, line.text("--topic"), {"relative_map/PredictionObstacles"});
  std::map<std::string, std::pair<std::size_t, std::string>> faults;
  std::size_t count = 0;
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<PredictionObstacles>();
    if (!message) continue;
    ++count;
    for (const core::PredictionFault& fault : core::check_prediction(to_core(*message))) {
      auto& known = faults[fault.row];
      if (known.first++ == 0)
        known.second = std::to_string(message->header.stamp.toSec()) + ": " + fault.what;
    }
  }
  std::cout << count << " predictions checked\n";
  for (const auto& [row, known] : faults) {
    std::cout << "  " << row << ": broken " << known.first << " times, first at " << known.second << "\n";
  }
  return faults.empty() ? 0 : 1;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("check_prediction", relative_map::kUsage, argc, argv, relative_map::run, 2);
}
