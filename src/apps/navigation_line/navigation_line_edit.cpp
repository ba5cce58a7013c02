// Subcommands of navigation_line that make a new file of others.
#include <cmath>
#include <filesystem>

#include "navigation_line_command.hpp"
#include "relative_map/tools/bridged_gaps.hpp"
#include "relative_map/tools/line_check.hpp"
#include "relative_map/tools/line_edit.hpp"

namespace relative_map {
namespace {

using Remappings = std::map<std::string, std::string>;
using Words = std::vector<std::string>;

constexpr double kAnyLength = 1e7;  // [m]

double max_gap_of(const CommandLine& line) {
  return line.number("--max-gap", core::LineCheckParam().max_gap, 0.01, 1e4);
}

/// Reads IN, has `edit` make a line of it, whose points lie up to `beside` [m] beside, and writes OUT under
/// the same header.
template <class Edit>
int edit_file(const CommandLine& line, Edit edit, double beside = 0.0) {
  const Words& files = line.files(2, 2, "IN and OUT");
  expect_savable(files[1], may_replace(line) ? Words() : Words{files[0]});
  core::LineFile file = load_line(files[0]);
  try {
    std::vector<core::BridgedGap> gaps = core::all_gaps(file, max_gap_of(line));
    file.line = core::make_recorded(edit(core::make_editable(file.line)));
    file.header.bridged = core::still_bridged(gaps, file.line, beside + core::kBesideGap);
  } catch (const UsageError&) {
    throw;
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(files[0] + ": " + fault.what());
  }
  save_line(files[1], file);
  print_written(files[1], file.line);
  return 0;
}

int run_resample(const Words& words, const Remappings&) {
  const CommandLine line(words, {"--spacing", "--max-gap"}, {"--by-curvature", kReplace});
  if (line.has("--spacing") == line.has("--by-curvature")) {
    throw UsageError("either --spacing or --by-curvature must be given");
  }
  const double spacing = line.number("--spacing", 0.0, 0.01, 1000.0);
  return edit_file(line, [&](const core::EditableLine& in) {
    if (line.has("--spacing")) return core::resample(in, spacing);
    return core::resample_by_curvature(in, core::default_curvature_spacing());
  });
}

int run_close(const Words& words, const Remappings&) {
  const CommandLine line(words, {"--gap"}, {kReplace});
  const double gap = line.number("--gap", 5.0, 0.0, 100.0);
  return edit_file(line, [&](const core::EditableLine& in) { return core::close(in, gap); });
}

int run_offset(const Words& words, const Remappings&) {
  const CommandLine line(words, {"--distance", "--max-gap"}, {kReplace});
  if (!line.has("--distance")) throw UsageError("--distance is missing");
  const double distance = line.number("--distance", 0.0, -100.0, 100.0);
  return edit_file(
      line, [&](const core::EditableLine& in) { return core::offset(in, distance); }, std::abs(distance));
}

int run_reverse(const Words& words, const Remappings&) {
  return edit_file(CommandLine(words, {}, {kReplace}),
                   [](const core::EditableLine& in) { return core::reverse(in); });
}

int run_cut(const Words& words, const Remappings&) {
  const CommandLine line(words, {"--from", "--to"}, {kReplace});
  if (!line.has("--from") && !line.has("--to")) throw UsageError("--from or --to is missing");
  const double from = line.number("--from", 0.0, 0.0, kAnyLength);
  const double to = line.number("--to", 0.0, 0.0, kAnyLength);
  return edit_file(line, [&](const core::EditableLine& in) {
    return core::cut(in, from, line.has("--to") ? to : core::length_of(in));
  });
}

int run_join(const Words& words, const Remappings&) {
  const CommandLine line(words, {"--gap"}, {kReplace});
  const double gap = line.number("--gap", 5.0, 0.0, 100.0);
  const Words& files = line.files(3, 1000, "two or more IN and one OUT");
  expect_savable(files.back(), Words(files.begin(), files.end() - 1));
  core::LineFile joined;
  std::vector<core::EditableLine> lines;
  for (std::size_t i = 0; i + 1 < files.size(); ++i) {
    const core::LineFile file = load_line(files[i]);
    if (const std::string why = core::merge(joined.header, file.header); !why.empty()) {
      throw std::runtime_error(files[i] + ": cannot be joined to those before it: " + why);
    }
    try {
      lines.push_back(core::make_editable(file.line));
    } catch (const std::runtime_error& fault) {
      throw std::runtime_error(files[i] + ": " + fault.what());
    }
  }
  joined.line = core::make_recorded(core::join(lines, gap));
  joined.header.bridged = core::still_bridged(joined.header.bridged, joined.line, core::kBesideGap);
  // Of many files the last one may be meant to be read.
  if (!may_replace(line) && std::filesystem::is_regular_file(files.back())) {
    throw UsageError("OUT, " + files.back() + ", exists: name another one, or say --replace");
  }
  save_line(files.back(), joined);
  print_written(files.back(), joined.line);
  return 0;
}

char separator_of(const std::string& name) {
  const std::map<std::string, char> kNames = {{"comma", ','}, {",", ','},    {"semicolon", ';'},
                                              {";", ';'},     {"tab", '\t'}, {"blank", ' '},
                                              {" ", ' '},     {"bar", '|'},  {"|", '|'}};
  const auto found = kNames.find(name);
  if (found == kNames.end()) throw UsageError("--separator must be comma, semicolon, tab, blank or bar");
  return found->second;
}

int run_convert(const Words& words, const Remappings&) {
  const CommandLine line(words, {"--from", "--to", "--utm", "--origin", "--separator", "--topic", "--frame"},
                         {"--lonlat", kReplace});
  const Words& files = line.files(2, 2, "IN and OUT");
  core::WriteOptions write;
  write.separator = separator_of(line.text("--separator", "comma"));
  write.geographic = line.has("--lonlat");
  const core::GeoReference reference = reference_of(line);
  expect_savable(files[1], may_replace(line) ? Words() : Words{files[0]}, line.text("--to"),
                 line.text("--topic"));
  core::LineFile file = load_line(files[0], line.text("--from"), {reference}, line.text("--topic"));
  if (reference.projection != core::Projection::kNone) {
    const std::string why = core::conflict({"", reference}, {"", file.header.reference});
    if (!why.empty()) {
      throw std::runtime_error(files[0] +
                               ": says where it lies, and --utm or --origin says otherwise: " + why);
    }
    file.header.reference = reference;
  }
  if (line.has("--frame")) file.header.frame_id = line.text("--frame");
  save_line(files[1], file, line.text("--to"), write, line.text("--topic"));
  print_written(files[1], file.line);
  return 0;
}

}  // namespace

const Command kConvert = {"convert", "one file format to another",
                          R"(Usage: navigation_line convert IN OUT [OPTION]...

Reads a line in any format and writes it in another, with nothing lost down to a micrometre.

  --from FORMAT, --to FORMAT   smoothed, one-line, csv, gpx, geojson, bag: where the extension does not tell
  --utm ZONE                   the map frame is this UTM zone, like 50N
  --origin LAT,LON[,ALT]       the map frame is ENU about this place, in degrees and metres
                               (without these two: as the file says, else the UTM zone that longitudes and
                               latitudes lie in)
  --lonlat                     CSV with lon,lat,alt, not x,y,z
  --separator NAME             CSV with comma (the default), semicolon, tab, blank or bar
  --frame NAME                 name the map frame in the file
  --topic TOPIC                of a bag (its only nav_msgs/Path; /navigation_line)
  --replace                    OUT may be IN

CSV needs a first line with names of columns (x,y,z or lon,lat,alt), or has x,y,z.
Examples: navigation_line convert track.gpx lane.smoothed
          navigation_line convert lane.smoothed lane.csv --lonlat --separator semicolon
)",
                          run_convert};

const Command kResample = {
    "resample", "other distances between points",
    R"(Usage: navigation_line resample IN OUT (--spacing D | --by-curvature) [OPTION]...

  --spacing D      [m] evenly
  --by-curvature   3.0, 1.0, 0.4, 0.1 m where curvature is above 0, 0.002, 0.008, 0.02 1/m
  --max-gap D      [m] longer gaps in IN stay faults in OUT (5)

Example: navigation_line resample lane.smoothed thin.smoothed --by-curvature
)",
    run_resample};

const Command kClose = {"close", "make a loop of a line whose ends nearly meet",
                        R"(Usage: navigation_line close IN OUT [--gap D]

What goes on beyond the start is left out, a gap is bridged, and an error sideways is spread over the last 50 m.

  --gap D   [m] that may be bridged (5)

Example: navigation_line close lap.smoothed loop.smoothed
)",
                        run_close};

const Command kOffset = {"offset", "a parallel lane", R"(Usage: navigation_line offset IN OUT --distance D

Smooth the line first: noise has curves that no parallel can follow. A parallel that would fold, or cross itself where
the line comes near to itself, is refused with the place.

  --distance D   [m] to the left; negative: to the right
  --max-gap D    [m] longer gaps in IN stay faults in OUT (5)

Example: navigation_line offset lane.smoothed left.smoothed --distance 3.5
)",
                         run_offset};

const Command kReverse = {"reverse", "the other way round", R"(Usage: navigation_line reverse IN OUT
)",
                          run_reverse};

const Command kCut = {"cut", "a part of a line", R"(Usage: navigation_line cut IN OUT [--from S] [--to S]

  --from S, --to S   [m] along the line (its ends); across the start of a loop, from the greater to the smaller

Example: navigation_line cut lane.smoothed part.smoothed --from 100 --to 450
)",
                      run_cut};

const Command kJoin = {"join", "one line of several", R"(Usage: navigation_line join IN... OUT [--gap D]

In the order that they are driven in. Where two overlap, the first one is taken.

  --gap D     [m] that may be bridged (5)
  --replace   OUT may exist, and is replaced

Example: navigation_line join to_town.smoothed through_town.smoothed whole.smoothed
)",
                       run_join};

}  // namespace relative_map
