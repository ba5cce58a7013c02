#include "navigation_line_command.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "navigation_line_bag.hpp"
#include "relative_map/io/whole_file.hpp"

namespace relative_map {

namespace {

core::LineFormat format_for(const std::string& path, const std::string& format) {
  const std::optional<core::LineFormat> known =
      format.empty() ? core::format_of(path) : core::parse_format(format);
  if (known) return *known;
  if (!format.empty())
    throw UsageError("'" + format + "' is no format: smoothed, one-line, csv, gpx, geojson, bag");
  throw UsageError(path +
                   ": its format is not known by its extension, which may be .smoothed, .json, .csv, .gpx, "
                   ".geojson or .bag");
}

bool is_bag(const std::string& path, const std::string& format) {
  return format.empty() ? std::filesystem::path(path).extension() == ".bag" : format == "bag";
}

}  // namespace

core::GeoReference reference_of(const CommandLine& line) {
  if (line.has("--utm") && line.has("--origin")) throw UsageError("--utm and --origin exclude each other");
  core::GeoReference reference;
  try {
    if (line.has("--utm")) reference = core::parse_utm_zone(line.text("--utm"));
  } catch (const std::runtime_error& fault) {
    throw UsageError(fault.what());
  }
  if (line.has("--origin")) {
    const std::vector<double> origin = parse_numbers("--origin", line.text("--origin"), 2, 3);
    reference.projection = core::Projection::kLocal;
    reference.latitude = origin[0];
    reference.longitude = origin[1];
    reference.altitude = origin.size() > 2 ? origin[2] : 0.0;
    if (!(std::abs(origin[0]) <= 90.0 && std::abs(origin[1]) <= 180.0)) {
      throw UsageError("--origin must be a latitude and a longitude in degrees, not '" +
                       line.text("--origin") + "'");
    }
  }
  return reference;
}

core::LineFile load_line(const std::string& path, const std::string& format, const core::ReadOptions& options,
                         const std::string& topic) {
  core::LineFile file = is_bag(path, format) ? read_path_bag(path, topic)
                                             : core::read_line(path, format_for(path, format), options);
  for (const std::string& note : file.notes) std::fprintf(stderr, "%s: %s\n", path.c_str(), note.c_str());
  return file;
}

void save_line(const std::string& path, const core::LineFile& file, const std::string& format,
               const core::WriteOptions& options, const std::string& topic) {
  if (is_bag(path, format)) return write_path_bag(path, topic, file);
  core::write_line(path, format_for(path, format), file, options);
}

void expect_savable(const std::string& path, const std::vector<std::string>& inputs,
                    const std::string& format, const std::string& topic) {
  core::expect_not_among(path, inputs);
  if (is_bag(path, format)) return expect_path_bag_writable(path, topic);
  format_for(path, format);
  core::expect_writable(path);
}

void print_written(const std::string& path, const core::RecordedLine& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    length += std::hypot(line.points[i].x - line.points[i - 1].x, line.points[i].y - line.points[i - 1].y);
  }
  std::printf("%s: %zu points, %.2f m\n", path.c_str(), line.points.size(), length);
}

}  // namespace relative_map
