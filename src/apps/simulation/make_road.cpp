#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

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
  bool help = false;
  std::string out;
  std::size_t lanes = 3;
  double lane_width = 3.5;  ///< [m]
  double spacing = 0.4;     ///< [m]
  std::string road = "demo";
  Pose2 origin;
};

/// Walks through the arguments; throws std::invalid_argument with a sentence.
class Arguments {
 public:
  Arguments(int argc, char** argv) : arguments_(argv + 1, argv + argc) {}

  bool at_end() const { return next_ == arguments_.size(); }
  const std::string& take_name() { return arguments_[next_++]; }
  const std::string& take_value(const std::string& option) {
    if (at_end()) throw std::invalid_argument(option + " lacks a value");
    return arguments_[next_++];
  }
  double take_number(const std::string& option, double low, double high) {
    const std::string& text = take_value(option);
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') {
      throw std::invalid_argument(option + " must be a number, not '" + text + "'");
    }
    if (!(number >= low && number <= high)) {
      std::ostringstream fault;
      fault << option << " is " << text << ", but must lie in [" << low << ", " << high << "]";
      throw std::invalid_argument(fault.str());
    }
    return number;
  }

 private:
  std::vector<std::string> arguments_;
  std::size_t next_ = 0;
};

Options parse_options(Arguments arguments) {
  Options options;
  while (!arguments.at_end()) {
    const std::string name = arguments.take_name();
    if (name == "--help" || name == "-h") {
      options.help = true;
      return options;
    } else if (name == "--out") {
      options.out = arguments.take_value(name);
    } else if (name == "--lanes") {
      const double lanes = arguments.take_number(name, 1.0, 20.0);
      if (lanes != std::floor(lanes)) throw std::invalid_argument("--lanes must be a whole number");
      options.lanes = static_cast<std::size_t>(lanes);
    } else if (name == "--lane-width") {
      options.lane_width = arguments.take_number(name, 0.5, 20.0);
    } else if (name == "--spacing") {
      options.spacing = arguments.take_number(name, 0.01, 100.0);
    } else if (name == "--road") {
      options.road = arguments.take_value(name);
    } else if (name == "--origin") {
      const double x = arguments.take_number(name, -1e8, 1e8);
      const double y = arguments.take_number(name, -1e8, 1e8);
      options.origin = Pose2(Point2(x, y), arguments.take_number(name, -2.0 * kPi, 2.0 * kPi));
    } else {
      throw std::invalid_argument("unknown argument '" + name + "'");
    }
  }
  if (options.out.empty()) throw std::invalid_argument("--out DIR is missing");
  return options;
}

std::vector<RecordedLine> make_lanes(const Options& options) {
  try {
    return parse_road(options.road, options.origin).lanes(options.lanes, options.lane_width, options.spacing);
  } catch (const std::out_of_range&) {
    throw std::invalid_argument("the road's curves are too sharp for so many lanes of that width");
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

int run(int argc, char** argv) {
  const Options options = parse_options(Arguments(argc, argv));
  if (options.help) {
    std::cout << kHelp;
    return 0;
  }
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
  try {
    return relative_map::core::run(argc, argv);
  } catch (const std::invalid_argument& fault) {
    std::cerr << "make_road: " << fault.what() << "; see make_road --help\n";
    return 2;
  } catch (const std::exception& fault) {
    std::cerr << "make_road: " << fault.what() << '\n';
    return 1;
  }
}
