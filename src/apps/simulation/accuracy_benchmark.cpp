// Measures the pipeline's maps against the truth of simulated drives. No ROS master is needed.
#include <spawn.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "relative_map/io/navigation_line_file.hpp"
#include "relative_map/simulation/accuracy_report.hpp"
#include "relative_map/simulation/world.hpp"
#include "relative_map/simulation/world_report.hpp"

extern char** environ;

namespace relative_map::core {
namespace {

constexpr const char* kHelp = R"(Usage: rosrun relative_map accuracy_benchmark [OPTION]...

Drives simulated roads with the errors that localization, recorded lines and cameras have, and compares the maps
that the node's own pipeline makes of them with the true lanes.

  --seeds N        drives of each scene, each on a road of its own (3)
  --scale F        errors F times as large as usual (1)
  --harsh          cameras that fail twice as often, with noise that lasts longer and is common to all paint
  --scene NAME     this scene only; may be given again
  --worlds         drives in all worlds: roads, vehicles and errors of other kinds and sizes, in a table of their own
  --world NAME     drives in this world, or this family of worlds; may be given again
  --perception     the worlds' drives from lane markers alone, too
  --rows SECONDS   also print what the maps of each drive say, but for the line's, a row each SECONDS
  --line FILE      a drive along this navigation line, taken for the center of a lane; may be given again
  --method NAME    this method only; may be given again
  --csv FILE       also write the table to FILE
  --plot DIR       write every map's errors to DIR/maps.csv and draw them there, with python3 and matplotlib
  --list           names of scenes, worlds and methods
  --help           this text

Columns: lateral error of the current lane's centerline, at points of the true center so far ahead of the vehicle.
It counts 2 m at most, and a missing lane counts that much. Border: both boundaries, width: both half widths, head.:
heading, all three 10 m ahead. Jitter: how far the center moves from tick to tick, at points of the road. Usable: maps
whose lane covers the next 30 m and is within 1.5 m of the truth at 10 m. Cost:
median time of a map, its inputs included. Totals take all maps of a group together;
the first second of each drive does not count.

Of worlds: RMS of the centerline's error at 10 and 30 m ahead, usable maps, the share of maps whose error at the
vehicle is within three of the standard deviations that they claim (99 % or more is right), the RMS at 10 m of the worst
second of all drives, and the share of maps that paint took part in; beside it what the recorded lines alone give,
and a plain filter of four states (offset, heading and half widths of the lane), which "--method filter" names.
In rows: '!' not usable, '*' not within three standard deviations.

Exit codes: 0 done, 1 a map broke the output contract or a file could not be written, 2 bad arguments.
)";

struct Options {
  bool list = false;
  std::string csv, plot;
  double rows = 0.0;  ///< [s]; 0: none
  BenchmarkOptions benchmark;
};

Options parse(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--seeds", "--scale", "--rows", "--csv", "--plot"},
                         {"--list", "--harsh", "--worlds", "--perception"},
                         {"--scene", "--world", "--line", "--method"});
  line.files(0, 0, "");
  Options options;
  options.list = line.has("--list");
  options.csv = line.text("--csv");
  options.plot = line.text("--plot");
  options.rows = line.number("--rows", 0.0, 0.1, 1e4);
  BenchmarkOptions& benchmark = options.benchmark;
  benchmark.seeds =
      static_cast<std::uint64_t>(line.number("--seeds", static_cast<double>(benchmark.seeds), 1.0, 1e4));
  benchmark.level.scale = line.number("--scale", benchmark.level.scale, 0.0, 10.0);
  benchmark.level.harsh = line.has("--harsh");
  benchmark.markers_alone = line.has("--perception");
  benchmark.scenes = line.texts("--scene");
  benchmark.methods = line.texts("--method");
  if (line.has("--worlds")) {
    for (const World& world : worlds()) benchmark.worlds.push_back(world.name);
  }
  for (const std::string& name : line.texts("--world")) {
    for (std::string& world : worlds_named(name)) benchmark.worlds.push_back(std::move(world));
  }
  for (const std::string& file : line.texts("--line")) benchmark.lines.push_back(read_navigation_line(file));
  if (!benchmark.worlds.empty() && benchmark.methods.empty()) {
    benchmark.methods = {"line", "filter", "estimator"};
  }
  return options;
}

void list() {
  std::cout << "scenes:";
  for (const std::string& name : accuracy_scene_names()) std::cout << " " << name;
  std::cout << "\nmethods:";
  for (const AccuracyMethod& method : accuracy_methods()) std::cout << " " << method.name;
  std::cout << " " << reference_method().name << "\nworlds:\n";
  for (const World& world : worlds()) std::cout << "  " << world.name << ": " << world.what << "\n";
}

std::ofstream open(const std::string& file) {
  std::ofstream stream(file);
  if (!stream) throw std::runtime_error(file + ": can't be written");
  return stream;
}

void close(std::ofstream& stream, const std::string& file) {
  stream.close();
  if (!stream) throw std::runtime_error(file + ": can't be written");
}

/// The script lies beside this program.
void draw(const std::string& folder) {
  const auto script = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "plot_accuracy.py";
  std::vector<std::string> words = {"python3", script.string(), folder};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  int status = 0;
  if (posix_spawnp(&child, "python3", nullptr, nullptr, arguments.data(), environ) != 0 ||
      waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error(folder + ": the maps are there, but could not be drawn by " + script.string());
  }
}

void print_scenes(const Options& options, const BenchmarkResult& result) {
  std::cout << options.benchmark.seeds << " drives of each scene, errors " << options.benchmark.level.scale
            << " times as large as usual" << (options.benchmark.level.harsh ? ", a harsh camera" : "")
            << "\n\n";
  print_table(result, std::cout);
}

/// 1 if a map broke the contract.
int report(const Options& options, const BenchmarkResult& result) {
  if (!options.benchmark.worlds.empty()) {
    std::cout << options.benchmark.seeds << " drives in each world\n\n";
    print_worlds(result, std::cout);
  }
  const bool scenes = options.benchmark.worlds.empty() || !options.benchmark.scenes.empty() ||
                      !options.benchmark.lines.empty();
  if (scenes) print_scenes(options, result);
  std::printf(
      "\n%.0f s of driving, simulated %.0f times as fast as real time, mapped and measured %.0f times as "
      "fast\n",
      result.driven, result.driven / result.simulation_time, result.mapped / result.mapping_time);
  int code = 0;
  for (const AccuracyRow& row : result.rows) {
    if (row.violations == 0) continue;
    std::cout << row.scene << ", " << row.method << ": " << row.violation << "\n";
    code = 1;
  }
  return code;
}

int measure(const Options& options) {
  std::ofstream maps;
  const double period = options.rows;
  const std::string maps_file = options.plot + "/maps.csv";
  DriveObserver observer;
  if (period > 0.0) {
    observer = [period](const AccuracyScene& scene, std::uint64_t seed, const AccuracyMethod& method,
                        const std::vector<MeasuredMap>& measured) {
      if (method.name != "line") print_drive(scene, seed, method, measured, period, std::cout);
    };
  }
  if (!options.plot.empty()) {
    std::filesystem::create_directories(options.plot);
    maps = open(maps_file);
    write_maps_header(maps);
    observer = [&](const AccuracyScene& scene, std::uint64_t seed, const AccuracyMethod& method,
                   const std::vector<MeasuredMap>& measured) {
      write_maps(scene, seed, method, measured, maps);
      if (period > 0.0 && method.name != "line") {
        print_drive(scene, seed, method, measured, period, std::cout);
      }
    };
  }
  const BenchmarkResult result = run_benchmark(options.benchmark, observer);
  const int code = report(options, result);
  std::cout.flush();
  if (!options.csv.empty()) {
    std::ofstream table = open(options.csv);
    write_table(result, table);
    close(table, options.csv);
  }
  if (!options.plot.empty()) {
    close(maps, maps_file);
    draw(options.plot);
  }
  return code;
}

int run(const std::vector<std::string>& words) {
  try {
    const Options options = parse(words);
    if (!options.list) return measure(options);
    list();
    return 0;
  } catch (const std::invalid_argument& fault) {  // a scene, world or method of no such name
    throw UsageError(fault.what());
  }
}

}  // namespace
}  // namespace relative_map::core

int main(int argc, char** argv) {
  using namespace relative_map;
  return run_tool("accuracy_benchmark", core::kHelp, argc, argv, core::run);
}
