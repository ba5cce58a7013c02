// Follows a route without ROS: what is told at each pose of a list.
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "navigation_line_command.hpp"
#include "relative_map/io/lane_graph_file.hpp"
#include "relative_map/io/whole_file.hpp"
#include "relative_map/route/reference_line.hpp"
#include "relative_map/route/route_check.hpp"
#include "relative_map/route/route_map.hpp"
#include "route_command.hpp"
#include "route_json.hpp"

namespace relative_map {
namespace {

constexpr const char* kHelp =
    R"(Usage: rosrun relative_map follow_route --graph FILE --route FILE --poses FILE [--speed V] [--line]

Follows a route along a list of poses and prints one JSON object a pose: where on the route it is, and the segments
around it; or {"refused": "why"}.
  --graph FILE   lane graph (JSON)
  --route FILE   route (JSON)
  --poses FILE   JSON list of {"x", "y", "heading"[, "t"][, "speed"]}: m, rad from east, s, m/s
  --speed V      m/s of poses that have none (default 0)
  --line         also "reference_line": [[x, y, theta, kappa, s]...] of the own passage: m, rad, 1/m, m
Exit codes: 0 done, 1 failed, 2 bad arguments.
)";

struct Pose {
  core::Pose2 pose;
  double speed = 0.0;
};

std::vector<Pose> read_poses(const std::string& path, double speed) {
  nlohmann::json list;
  try {
    list = nlohmann::json::parse(core::read_whole_file(path));
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error(path + ": not valid JSON");
  }
  if (!list.is_array()) throw std::runtime_error(path + ": must be a JSON list of poses");
  std::vector<Pose> poses;
  for (const nlohmann::json& element : list) {
    const auto number = [&](const char* key) {
      const auto found = element.is_object() ? element.find(key) : element.end();
      // JSON has no NaN: null is a number that is not there, and the tick says so.
      if (element.is_object() && found != element.end() && found->is_number()) return found->get<double>();
      if (element.is_object() && found != element.end() && found->is_null()) return std::nan("");
      throw std::runtime_error(path + ": pose " + std::to_string(poses.size()) + " lacks the number '" + key +
                               "'");
    };
    const bool own_speed = element.is_object() && element.contains("speed") && element["speed"].is_number();
    poses.push_back({core::Pose2({number("x"), number("y")}, number("heading")),
                     own_speed ? element["speed"].get<double>() : speed});
  }
  return poses;
}

int run(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--graph", "--route", "--poses", "--speed"}, {"--line"});
  line.files(0, 0, "nothing else");
  for (const char* needed : {"--graph", "--route", "--poses"}) {
    if (!line.has(needed)) throw UsageError(std::string(needed) + " is needed");
  }
  std::vector<core::GraphFault> faults;
  const auto network = core::LaneNetwork::prepare(core::read_lane_graph(line.text("--graph")), faults);
  for (const core::GraphFault& fault : faults) std::cerr << "follow_route: " << fault.what << '\n';
  if (!network) throw std::runtime_error(line.text("--graph") + ": the lane graph can't be used");
  const std::vector<Pose> poses = read_poses(line.text("--poses"), line.number("--speed", 0.0, 0.0, 1000.0));

  core::RouteMap map{core::RouteParam{}};
  map.set_graph(network);
  const core::RouteStatus taken = map.set_route(core::read_route(line.text("--route")));
  for (const std::string& repair : map.repairs()) std::cerr << "follow_route: " << repair << '\n';
  core::ReferenceLineMaker maker(network, core::ReferenceLineParam{});
  for (const Pose& pose : poses) {
    core::RouteUpdate update = core::checked(map.update(pose.pose, pose.speed), map.index());
    if (taken.code != core::RouteCode::kOk) update.status = taken;
    nlohmann::json told = json_of(update, map.index());
    if (line.has("--line") && !update.segments.empty()) {
      told["reference_line"] = json_of(maker.make(update.segments, pose.pose.position()).front());
    }
    std::cout << told.dump() << '\n';
  }
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_command(argc, argv, "follow_route", relative_map::kHelp, relative_map::run);
}
