// Finds a route over a lane graph without ROS.
#include <iostream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "relative_map/io/lane_graph_file.hpp"
#include "relative_map/route/route_search.hpp"
#include "route_command.hpp"

namespace relative_map {
namespace {

constexpr const char* kHelp =
    R"(Usage: rosrun relative_map find_route --graph FILE --from LANE S --to LANE S [--via LANE S ...] [--closed LANE ...]

Finds the way of least cost over a lane graph and prints it as a route (JSON, one line).
  --graph FILE     lane graph (JSON)
  --from LANE S    start: a lane, and m along it
  --via LANE S     a place on the way; may be given again, in the order of the way
  --to LANE S      destination
  --closed LANE    a lane that is not to be driven on; may be given again
Exit codes: 0 found, 1 there is no route (the reason is on standard error), 2 bad arguments.
)";

struct Arguments {
  std::string graph;
  std::vector<core::LanePosition> from, via, to;
  std::set<std::string> closed;
};

/// Each is a lane, and how far along it.
std::vector<core::LanePosition> places(const CommandLine& line, const std::string& option) {
  const std::vector<std::string> words = line.texts(option);
  if (words.size() % 2 != 0) throw UsageError(option + " needs a lane, and how far along it [m]");
  std::vector<core::LanePosition> places;
  for (std::size_t i = 0; i < words.size(); i += 2) {
    places.emplace_back();
    places.back().lane_id = words[i];
    places.back().s = parse_number(option, words[i + 1]);
  }
  return places;
}

Arguments parse(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--graph"}, {}, {"--from", "--via", "--to", "--closed"});
  line.files(0, 0, "");
  const std::vector<std::string> closed = line.texts("--closed");
  Arguments arguments{line.text("--graph"),
                      places(line, "--from"),
                      places(line, "--via"),
                      places(line, "--to"),
                      {closed.begin(), closed.end()}};
  if (arguments.graph.empty()) throw UsageError("--graph is needed");
  if (arguments.from.size() != 1 || arguments.to.size() != 1)
    throw UsageError("one --from and one --to are needed");
  return arguments;
}

int run(const std::vector<std::string>& words) {
  const Arguments arguments = parse(words);
  std::vector<core::GraphFault> faults;
  const auto network = core::LaneNetwork::prepare(core::read_lane_graph(arguments.graph), faults);
  for (const core::GraphFault& fault : faults) std::cerr << "find_route: " << fault.what << '\n';
  if (!network) throw std::runtime_error(arguments.graph + ": the lane graph can't be used");
  core::SearchRequest request;
  request.places = arguments.from;
  request.places.insert(request.places.end(), arguments.via.begin(), arguments.via.end());
  request.places.push_back(arguments.to.front());
  request.closed_lanes = arguments.closed;
  const core::SearchResult found = core::RouteSearch(network, core::SearchParam{}).find(request);
  if (!found.route) throw std::runtime_error(found.why_not);
  std::cout << core::route_text(*found.route) << '\n';
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_command(argc, argv, "find_route", relative_map::kHelp, relative_map::run);
}
