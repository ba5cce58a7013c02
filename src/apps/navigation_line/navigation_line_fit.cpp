// Subcommands of navigation_line that make a line fit to be driven on, or say whether it is.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <sstream>

#include "navigation_line_command.hpp"
#include "relative_map/tools/bridged_gaps.hpp"
#include "relative_map/tools/line_check.hpp"
#include "relative_map/tools/line_smoother.hpp"

namespace relative_map {
namespace {

using Remappings = std::map<std::string, std::string>;
using Words = std::vector<std::string>;

constexpr double kMaxBound = 10.0;  // [m]

/// "would do" for what find_feasible() has found.
std::string advice(const core::EditableLine& line, const core::SmootherParam& param) {
  ProgressBar bar;
  const std::optional<core::SmootherParam> found =
      core::find_feasible(line, param, kMaxBound, [&](double done) { bar.show(done); });
  std::ostringstream text;
  if (found) {
    text << "; --bound " << found->bound << " --follow " << found->follow << " would do";
  } else {
    text << "; nor is any bound up to " << kMaxBound << " m enough: cut that part out, or record it again";
  }
  return text.str();
}

core::SmoothedLine smooth(const core::LineFile& file, const core::SmootherParam& param,
                          const std::string& path) {
  try {
    const core::EditableLine line = core::make_editable(file.line);
    core::SmoothedLine result;
    {
      ProgressBar bar;
      result = core::smooth_line(line, param, [&](double done) { bar.show(done); });
    }
    if (!result.fault.empty()) throw std::runtime_error(result.fault + advice(line, param));
    return result;
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": " + fault.what());
  }
}

int run_smooth(const Words& words, const Remappings&) {
  const CommandLine line(words, {"--bound", "--spacing", "--follow", "--max-curvature", "--max-gap"},
                         {kReplace});
  const Words& files = line.files(2, 2, "IN and OUT");
  core::SmootherParam param;
  param.bound = line.number("--bound", param.bound, 0.01, kMaxBound);
  param.spacing = line.number("--spacing", param.spacing, 0.2, 2.0);
  param.follow = line.number("--follow", param.follow, 2.0, 50.0);
  param.max_curvature = line.number("--max-curvature", param.max_curvature, 1e-3, 10.0);
  const double max_gap = line.number("--max-gap", core::LineCheckParam().max_gap, 0.01, 1e4);
  expect_savable(files[1], may_replace(line) ? Words() : Words{files[0]});
  core::LineFile file = load_line(files[0]);
  const std::vector<core::BridgedGap> gaps = core::all_gaps(file, max_gap);
  const core::SmoothedLine result = smooth(file, param, files[0]);
  file.line = core::make_recorded(result.line);
  file.header.bridged = core::still_bridged(gaps, file.line, core::kBesideGap);
  save_line(files[1], file);
  std::printf("%s: %zu points, %.2f m%s\n", files[1].c_str(), file.line.points.size(), result.length,
              result.line.closed() ? ", a loop" : "");
  std::printf("greatest deviation      %.3f m at s = %.1f m\n", result.greatest_deviation,
              result.deviation_s);
  std::printf("greatest curvature      %.5f 1/m at s = %.1f m\n", result.greatest_kappa, result.kappa_s);
  std::printf("greatest curvature rate %.5f 1/m^2 at s = %.1f m\n", result.greatest_dkappa, result.dkappa_s);
  if (result.longest_gap > max_gap) {
    std::printf(
        "longest gap             %.2f m from s = %.1f m on: nothing is recorded there, and the line a "
        "guess; a fault in `check` until --max-gap accepts it\n",
        result.longest_gap, result.gap_s);
  }
  return 0;
}

/// What noise makes of a recording, and smoothing mends.
bool is_rough(const core::LineFault& fault) {
  return fault.kind == "kink" || fault.kind == "curvature" || fault.kind == "curvature rate";
}

/// In one line whether it can be driven on, and if not, what to do first.
void print_verdict(const std::string& path, const core::LineFile& file,
                   const std::vector<core::LineFault>& faults) {
  if (faults.empty()) {
    std::printf("%s: fit to be driven on, %zu points, %s, frame %s\n", path.c_str(), file.line.points.size(),
                core::describe(file.header.reference).c_str(),
                file.header.frame_id.empty() ? "not named" : ("'" + file.header.frame_id + "'").c_str());
    return;
  }
  const auto rough = static_cast<std::size_t>(std::count_if(faults.begin(), faults.end(), is_rough));
  std::printf("%s: not fit to be driven on, %zu fault%s%s\n", path.c_str(), faults.size(),
              faults.size() == 1 ? "" : "s",
              2 * rough > faults.size() ? ", as a raw recording: smooth it (navigation_line smooth)" : "");
}

/// The number of faults.
std::size_t check_file(const std::string& path, const core::LineFile& file,
                       const core::LineCheckParam& param) {
  const std::vector<core::LineFault> faults = core::check_line(file.line, file.header, param);
  print_verdict(path, file, faults);
  for (const core::LineFault& fault : faults) {
    std::printf("%s: %s at point %zu, s = %.1f m: %s", path.c_str(), fault.kind.c_str(), fault.point, fault.s,
                fault.what.c_str());
    if (fault.count > 1) {
      std::printf(" (the worst of %zu, from s = %.1f m to %.1f m)", fault.count, fault.from, fault.to);
    }
    std::printf("\n");
  }
  return faults.size();
}

int run_check(const Words& words, const Remappings&) {
  const CommandLine line(
      words, {"--max-gap", "--max-curvature", "--max-curvature-rate", "--utm", "--origin", "--frame"});
  const Words& files = line.files(1, 1000, "one or more files");
  core::LineCheckParam param;
  param.max_gap = line.number("--max-gap", param.max_gap, 0.01, 1e4);
  param.max_curvature = line.number("--max-curvature", param.max_curvature, 1e-3, 10.0);
  param.max_curvature_rate = line.number("--max-curvature-rate", param.max_curvature_rate, 1e-3, 100.0);
  core::LineHeader expected{line.text("--frame"), reference_of(line)};
  std::string expected_by = core::is_empty(expected) ? "" : "this call";
  std::size_t faults = 0;
  for (const std::string& path : files) {
    core::LineFile file;
    try {
      file = load_line(path);
    } catch (const std::runtime_error& fault) {
      std::printf("%s\n", fault.what());  // it names the file
      ++faults;
      continue;
    }
    if (const std::string why = core::merge(expected, file.header); !why.empty()) {
      std::printf("%s: zone: it does not fit to %s: %s\n", path.c_str(), expected_by.c_str(), why.c_str());
      ++faults;
    } else if (expected_by.empty()) {
      expected_by = path;
    }
    if (file.header.reference.projection == core::Projection::kNone)
      file.header.reference = expected.reference;
    faults += check_file(path, file, param);
  }
  if (faults > 0) std::printf("%zu fault%s\n", faults, faults == 1 ? "" : "s");
  return faults == 0 ? 0 : 1;
}

}  // namespace

const Command kSmooth = {"smooth", "least curvature change within a bound",
                         R"(Usage: navigation_line smooth IN OUT [OPTION]...

Finds the line of least curvature change that stays beside the recording. The ends are kept, and a loop stays one.
theta, kappa, dkappa and s are those of the result. If the bound cannot be held it says where, and with which --bound and
--follow it could be, and writes nothing.

  --bound D           [m] that the recorded points may lie beside the result (0.25)
  --spacing D         [m] of the result's points (0.5)
  --follow L          [m] bends much longer than this stay where they were recorded (30); with a wide bound for
                      a noisy recording, 5 keeps curves from being cut
  --max-curvature K   [1/m] that the vehicle can drive (0.25)
  --max-gap D         [m] a longer gap is bridged, too, but stays a fault in `check`: look at it first (5)

Example: navigation_line smooth raw.smoothed lane.smoothed
         navigation_line smooth gps.smoothed lane.smoothed --bound 1.0 --follow 5
)",
                         run_smooth};

const Command kCheck = {"check", "is a file fit to be driven on?",
                        R"(Usage: navigation_line check FILE... [OPTION]...

Says whether it is, and lists every fault with its place: gaps, kinks, duplicate points, s or a line that goes backward, curvature above the
vehicle's limit, curvature that changes faster than the vehicle can steer (at up to 15 m/s, and 3 m/s² sideways), also at
the seam of a loop, a line beside itself, coordinates that can't be of their zone, files that don't fit to each other.
Exit code 0: none; 1: some.

  --max-gap D              [m] between points, also where they were put across a gap later (5)
  --max-curvature K        [1/m] that the vehicle can drive (0.25)
  --max-curvature-rate R   [1/(m s)] that its steering can change that by (0.3)
  --utm ZONE, --origin LAT,LON[,ALT], --frame NAME   what the files should be in

Example: navigation_line check left.smoothed middle.smoothed right.smoothed --utm 50N
)",
                        run_check};

}  // namespace relative_map
