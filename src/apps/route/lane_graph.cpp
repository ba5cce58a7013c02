// Lane graphs: are they fit to be driven on, and from one format to another.
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "navigation_line_command.hpp"
#include "relative_map/io/lane_graph_file.hpp"
#include "relative_map/io/lanelet_file.hpp"
#include "relative_map/io/whole_file.hpp"
#include "relative_map/route/lane_network.hpp"
#include "relative_map/route/line_graph.hpp"
#include "route_command.hpp"

namespace relative_map {
namespace {

constexpr const char* kHelp = R"(Usage: rosrun relative_map lane_graph check FILE
       rosrun relative_map lane_graph convert IN OUT.json [--utm ZONE | --origin LAT,LON[,ALT]] [--frame NAME]
       rosrun relative_map lane_graph from_lines LINE... --out OUT.json [--width W] [--frame NAME]

check     names what is wrong with a lane graph: what it can't be used for, and what is left out
convert   reads a lane graph in any format, and writes it as JSON
from_lines  makes a lane graph of navigation lines, in any format of theirs: lines that run on each other become
          one lane, with forks and merges where they part and meet; lines beside each other become neighbors; laps close
Formats, by extension: .json (this package's, see doc/route.md), .osm (Lanelet2; read only).
  --utm ZONE      of a map in degrees, e.g. 32N; default: the map's
  --origin        of a local frame for a map in degrees
  --frame NAME    frame_id of the graph that is written (default: as it was, else map)
  --width W       m of lanes with nothing beside them (default 3.5)
Exit codes: 0 done and no fault, 1 failed or faults found, 2 bad arguments.
)";

std::optional<core::GeoReference> projection_of(const CommandLine& line) {
  const core::GeoReference reference = reference_of(line);
  if (reference.projection == core::Projection::kNone) return std::nullopt;
  return reference;
}

core::LaneGraph load(const std::string& path, const CommandLine& line) {
  const std::string extension = std::filesystem::path(path).extension();
  if (extension == ".json") return core::read_lane_graph(path);
  if (extension != ".osm")
    throw UsageError(path + ": its format is not known by its extension: .json or .osm");
  core::LaneletMap map = core::read_lanelet_map(path, projection_of(line));
  for (const std::string& remark : map.remarks) std::cerr << path << ": " << remark << '\n';
  return map.graph;
}

int check(const CommandLine& line) {
  const std::string path = line.files(1, 1, "FILE").front();
  std::vector<core::GraphFault> faults;
  const auto network = core::LaneNetwork::prepare(load(path, line), faults);
  for (const core::GraphFault& fault : faults) {
    std::printf("%s: %s\n", fault.fatal ? "ERROR" : "WARN", fault.what.c_str());
  }
  if (!network) {
    std::printf("%s: can't be used\n", path.c_str());
    return 1;
  }
  double length = 0.0;
  for (std::size_t i = 0; i < network->size(); ++i) length += network->lane(i).length();
  std::printf("%s: %zu lanes, %.1f km, %zu faults\n", path.c_str(), network->size(), length / 1000.0,
              faults.size());
  return faults.empty() ? 0 : 1;
}

int convert(const CommandLine& line) {
  const std::vector<std::string>& files = line.files(2, 2, "IN and OUT.json");
  if (std::filesystem::path(files[1]).extension() != ".json") throw UsageError("OUT must be a .json file");
  core::expect_writable(files[1]);
  core::LaneGraph graph = load(files[0], line);
  if (line.has("--frame")) graph.frame_id = line.text("--frame");
  if (graph.frame_id.empty()) graph.frame_id = "map";
  std::vector<core::GraphFault> faults;
  const auto network = core::LaneNetwork::prepare(graph, faults);
  for (const core::GraphFault& fault : faults) std::cerr << files[0] << ": " << fault.what << '\n';
  if (!network) throw std::runtime_error(files[0] + ": the lane graph can't be used; nothing was written");
  core::write_lane_graph(files[1], graph);
  std::printf("%s: %zu lanes in frame '%s'\n", files[1].c_str(), graph.lanes.size(), graph.frame_id.c_str());
  return 0;
}

int from_lines(const CommandLine& line) {
  const std::vector<std::string>& files = line.files(1, 1000, "LINE...");
  const std::string out = line.text("--out");
  if (std::filesystem::path(out).extension() != ".json") throw UsageError("--out must name a .json file");
  core::expect_writable(out);
  core::expect_not_among(out, files);
  core::LineGraphParam param;
  param.width = line.number("--width", param.width, 1.0, 20.0);
  core::LineHeader header;
  std::vector<core::NamedLine> lines;
  for (const std::string& path : files) {
    const core::LineFile file = load_line(path);
    if (const std::string why = core::merge(header, file.header); !why.empty())
      throw std::runtime_error(path + ": does not fit to the files before it: " + why);
    lines.push_back({std::filesystem::path(path).stem(), {}});
    for (const core::LinePoint& point : file.line.points) {
      const core::Point2 position(point.x, point.y);
      if (!position.allFinite()) throw std::runtime_error(path + ": has a point that is not finite");
      lines.back().points.push_back(position);
    }
  }
  std::vector<std::string> notes;
  core::LaneGraph graph = core::graph_from_lines(lines, param, notes);
  for (const std::string& note : notes) std::cerr << "lane_graph: " << note << '\n';
  graph.frame_id = line.text("--frame", header.frame_id.empty() ? "map" : header.frame_id);
  std::vector<core::GraphFault> faults;
  const auto network = core::LaneNetwork::prepare(graph, faults);
  for (const core::GraphFault& fault : faults) std::cerr << "lane_graph: " << fault.what << '\n';
  if (!network) throw std::runtime_error("no lane graph comes of these lines; nothing was written");
  core::write_lane_graph(out, graph);
  std::printf("%s: %zu lanes in frame '%s'\n", out.c_str(), graph.lanes.size(), graph.frame_id.c_str());
  return 0;
}

int run(const std::vector<std::string>& words) {
  if (words.empty()) throw UsageError("check, convert or from_lines is needed");
  const std::vector<std::string> rest(words.begin() + 1, words.end());
  if (words[0] == "check") return check(CommandLine(rest, {"--utm", "--origin"}));
  if (words[0] == "convert") return convert(CommandLine(rest, {"--utm", "--origin", "--frame"}));
  if (words[0] == "from_lines") return from_lines(CommandLine(rest, {"--out", "--width", "--frame"}));
  throw UsageError("there is no subcommand '" + words[0] + "'");
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_command(argc, argv, "lane_graph", relative_map::kHelp, relative_map::run);
}
