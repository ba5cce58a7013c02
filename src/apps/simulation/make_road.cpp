#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "command_line.hpp"
#include "relative_map/io/navigation_line_file.hpp"
#include "relative_map/simulation/road_description.hpp"

namespace relative_map::core {
namespace {

constexpr const char* kHelp = R"(Usage: rosrun relative_map make_road --out DIR [OPTION]...

Makes a road of straights, clothoids and arcs with parallel lanes, and writes each lane as a navigation line
to DIR/lane_0.smoothed (the leftmost), DIR/lane_1.smoothed ... DIR is made if it does not exist.

  --out DIR            where to write
  --lanes N            number of lanes (3)
  --lane-width W       [m] from centerline to centerline (3.5)
  --spacing D          [m] of points along the middle of the road (0.4)
  --road ROAD          demo (the default; 1.08 km with curves to both sides), closed (a lap of 757 m), or pieces:
                       "straight LENGTH", "arc LENGTH [KAPPA]", "clothoid LENGTH [KAPPA_START] KAPPA_END",
                       in [m] and [1/m], positive to the left, with ';' between them. A curvature left out is the
                       one that the piece before ended with.
  --origin X Y HEADING pose of the road's start in the map frame, [m] and [rad], counter-clockwise from
                       east (0 0 0)
  --help               this text

Example: rosrun relative_map make_road --out road --road "straight 100; clothoid 40 0.01; arc 60; clothoid 40 0"
Exit codes: 0 written, 1 writing failed, 2 bad arguments.
)";

struct Options {
  std::string out;
  std::size_t lanes = 3;
  double lane_width = 3.5;  ///< [m]
  double spacing = 0.4;     ///< [m]
  std::string road = "demo";
  Pose2 origin;
};

Options parse(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--out", "--lanes", "--lane-width", "--spacing", "--road"}, {},
                         {"--origin"});
  line.files(0, 0, "");
  Options options;
  options.out = line.text("--out");
  if (options.out.empty()) throw UsageError("--out DIR is missing");
  const double lanes = line.number("--lanes", 3.0, 1.0, 20.0);
  if (lanes != std::floor(lanes)) throw UsageError("--lanes must be a whole number");
  options.lanes = static_cast<std::size_t>(lanes);
  options.lane_width = line.number("--lane-width", options.lane_width, 0.5, 20.0);
  options.spacing = line.number("--spacing", options.spacing, 0.01, 100.0);
  options.road = line.text("--road", options.road);
  if (line.has("--origin")) {
    const std::vector<double> origin = line.numbers("--origin", 3, -1e8, 1e8);
    if (std::abs(origin[2]) > 2.0 * kPi) throw UsageError("--origin's heading must lie in [-2 pi, 2 pi]");
    options.origin = Pose2(Point2(origin[0], origin[1]), origin[2]);
  }
  return options;
}

std::vector<RecordedLine> make_lanes(const Options& options) {
  try {
    return parse_road(options.road, options.origin).lanes(options.lanes, options.lane_width, options.spacing);
  } catch (const std::out_of_range&) {
    throw UsageError("the road's curves are too sharp for so many lanes of that width");
  } catch (const std::invalid_argument& fault) {
    throw UsageError(fault.what());
  }
}

void write_lane(const std::filesystem::path& folder, const RecordedLine& lane) {
  const std::string file = (folder / (lane.name + ".smoothed")).string();
  write_navigation_line(file, lane);
  double greatest_kappa = 0.0;
  for (const LinePoint& point : lane.points) greatest_kappa = std::max(greatest_kappa, std::abs(point.kappa));
  std::cout << file << ": " << lane.points.size() << " points, " << std::fixed << std::setprecision(2)
            << lane.points.back().s << " m, greatest curvature " << std::setprecision(5) << greatest_kappa
            << " 1/m\n";
}

int run(const std::vector<std::string>& words) {
  const Options options = parse(words);
  const std::vector<RecordedLine> lanes = make_lanes(options);
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) throw std::runtime_error("cannot make the folder " + options.out + ": " + error.message());
  for (const RecordedLine& lane : lanes) write_lane(options.out, lane);
  return 0;
}

}  // namespace
}  // namespace relative_map::core

int main(int argc, char** argv) {
  using namespace relative_map;
  return run_tool("make_road", core::kHelp, argc, argv, core::run);
}
