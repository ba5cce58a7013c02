// Measures the pipeline's maps against the truth of simulated drives. No ROS master is needed.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "relative_map/simulation/accuracy_benchmark.hpp"

namespace relative_map::core {
namespace {

constexpr const char* kHelp = R"(Usage: rosrun relative_map accuracy_benchmark [OPTION]...

Drives simulated roads with the errors that localization, recorded lines and cameras have, and compares the maps
that the node's own pipeline makes of them with the true lanes.

  --seeds N        drives of each scene (3)
  --scale F        errors F times as large as usual (1)
  --scene NAME     this scene only; may be given again
  --method NAME    this method only; may be given again
  --help           this text

Exit codes: 0 done, 1 a map broke the output contract, 2 bad arguments.
)";

struct Options {
  bool help = false;
  BenchmarkOptions benchmark;
};

double number_of(const std::string& option, const std::string& text, double low, double high) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(number >= low && number <= high)) {
    throw std::invalid_argument(option + " is '" + text + "', but must be a number in [" +
                                std::to_string(low) + ", " + std::to_string(high) + "]");
  }
  return number;
}

Options parse(const std::vector<std::string>& words) {
  Options options;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& name = words[i];
    if (name == "--help" || name == "-h") {
      options.help = true;
      return options;
    }
    if (name != "--seeds" && name != "--scale" && name != "--scene" && name != "--method") {
      throw std::invalid_argument("unknown argument '" + name + "'");
    }
    if (i + 1 == words.size()) throw std::invalid_argument(name + " lacks a value");
    const std::string& value = words[++i];
    if (name == "--seeds")
      options.benchmark.seeds = static_cast<std::uint64_t>(number_of(name, value, 1.0, 1e4));
    if (name == "--scale") options.benchmark.scale = number_of(name, value, 0.0, 10.0);
    if (name == "--scene") options.benchmark.scenes.push_back(value);
    if (name == "--method") options.benchmark.methods.push_back(value);
  }
  return options;
}

void print_header() {
  std::printf("%-20s %-13s|%41s |%41s | %6s %6s %6s | %6s %6s | %6s %5s\n", "", "",
              "RMS of the center [m], at [m] ahead", "95th percentile [m], at [m] ahead", "border", "width",
              "head.", "jit.10", "jit.30", "usable", "viol.");
  std::printf("%-20s %-13s|", "scene", "method");
  for (int i = 0; i < 2; ++i) {
    for (const double distance : kErrorDistances) std::printf(" %6.0f", distance);
    std::printf("%s", i == 0 ? "|" : "|");
  }
  std::printf(" %6s %6s %6s | %6s %6s | %6s %5s\n", "[m]", "[m]", "[deg]", "[m]", "[m]", "[%]", "");
}

void print(const AccuracyRow& row) {
  std::printf("%-20s %-13s|", row.scene.c_str(), row.method.c_str());
  for (const ErrorStatistics& error : row.center) std::printf(" %6.3f", error.rms());
  std::printf("|");
  for (const ErrorStatistics& error : row.center) std::printf(" %6.3f", error.percentile_95());
  const double usable = row.usable_of == 0
                            ? std::nan("")
                            : 100.0 * static_cast<double>(row.usable) / static_cast<double>(row.usable_of);
  std::printf("| %6.3f %6.3f %6.3f | %6.3f %6.3f | %6.2f %5zu\n", row.boundary.rms(), row.half_width.rms(),
              row.heading.rms() * 180.0 / kPi, row.jitter_10.rms(), row.jitter_30.rms(), usable,
              row.violations);
}

int run(const Options& options) {
  const BenchmarkResult result = run_benchmark(options.benchmark);
  std::printf("%llu seeds a scene, errors %g times as large as usual\n\n",
              static_cast<unsigned long long>(options.benchmark.seeds), options.benchmark.scale);
  print_header();
  for (const AccuracyRow& row : result.rows) print(row);
  std::printf("\n");
  for (const AccuracyRow& row : result.totals) print(row);
  std::printf(
      "\n%.0f s were driven, %.0f times as fast as real time; mapping and measuring ran at %.0f times real "
      "time\n",
      result.driven, result.driven / result.simulation_time, result.mapped / result.mapping_time);
  std::size_t violations = 0;
  for (const AccuracyRow& row : result.rows) {
    violations += row.violations;
    if (row.violations > 0) {
      std::printf("%s, %s: %s\n", row.scene.c_str(), row.method.c_str(), row.violation.c_str());
    }
  }
  return violations == 0 ? 0 : 1;
}

}  // namespace
}  // namespace relative_map::core

int main(int argc, char** argv) {
  try {
    const auto options = relative_map::core::parse({argv + 1, argv + argc});
    if (options.help) {
      std::cout << relative_map::core::kHelp;
      return 0;
    }
    return relative_map::core::run(options);
  } catch (const std::invalid_argument& fault) {
    std::cerr << "accuracy_benchmark: " << fault.what() << "; see accuracy_benchmark --help\n";
    return 2;
  }
}
