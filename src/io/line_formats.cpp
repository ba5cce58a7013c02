#include "relative_map/io/line_formats.hpp"

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <map>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/text.hpp"
#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

template <class Key>
std::optional<LineFormat> find(const std::map<std::string, LineFormat>& formats, const Key& key) {
  const auto found = formats.find(key);
  return found == formats.end() ? std::nullopt : std::optional<LineFormat>(found->second);
}

/// Somewhere in the Gulf of Guinea: no road is there, but fields that were never filled are.
bool was_never_set(const GeoPoint& point) {
  return point.longitude == 0.0 && point.latitude == 0.0;
}

/// How far apart the parts are that follow each other.
std::string note_on_parts(const std::vector<std::size_t>& parts, const std::vector<LinePoint>& points) {
  double widest = -1.0;
  std::size_t before = 0;
  for (std::size_t start : parts) {
    if (start == 0 || start >= points.size()) continue;
    const double gap =
        std::hypot(points[start].x - points[start - 1].x, points[start].y - points[start - 1].y);
    if (gap <= widest) continue;
    widest = gap;
    before = start;
  }
  if (widest < 0.0) return "";
  std::ostringstream note;
  note << std::fixed << std::setprecision(1) << "consists of " << parts.size() + 1
       << " parts, which are taken to follow each other; the widest gap between two is " << widest
       << " m, before point " << before;
  return note.str();
}

GeoLine unprojected(const std::string& path, const LineFile& file) {
  expect_finite_positions(path, file.line);
  try {
    return {file.header, unproject(file.line.points, file.header.reference), {}, {}};
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": not written, since " + fault.what());
  }
}

}  // namespace

LineFile projected(const std::string& path, const GeoLine& geo, const ReadOptions& options) {
  LineFile file;
  file.header = geo.header;
  file.notes = geo.notes;
  file.line.name = line_name(path);
  if (geo.points.empty()) throw std::runtime_error(path + ": has no points");
  std::vector<GeoPoint> points;
  std::vector<std::size_t> parts;
  auto part = geo.parts.begin();
  for (std::size_t i = 0; i < geo.points.size(); ++i) {
    for (; part != geo.parts.end() && *part == i; ++part) parts.push_back(points.size());
    if (!was_never_set(geo.points[i])) points.push_back(geo.points[i]);
  }
  const std::size_t never_set = geo.points.size() - points.size();
  if (points.empty()) throw std::runtime_error(path + ": all of its points are at longitude 0, latitude 0");
  if (never_set > 0) {
    file.notes.push_back(std::to_string(never_set) +
                         " points at longitude 0, latitude 0 are left out: there was no fix");
  }
  try {
    if (options.reference.projection != Projection::kNone) file.header.reference = options.reference;
    GeoReference& reference = file.header.reference;
    if (reference.projection == Projection::kNone) reference = utm_zone_of(points);
    file.line.points = project(points, reference);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": " + fault.what());
  }
  const std::string note = note_on_parts(parts, file.line.points);
  if (!note.empty()) file.notes.push_back(note);
  return file;
}

std::optional<LineFormat> format_of(const std::string& path) {
  return find({{".smoothed", LineFormat::kSmoothed},
               {".jsonl", LineFormat::kSmoothed},
               {".txt", LineFormat::kSmoothed},
               {".json", LineFormat::kOneLine},
               {".csv", LineFormat::kCsv},
               {".tsv", LineFormat::kCsv},
               {".gpx", LineFormat::kGpx},
               {".geojson", LineFormat::kGeoJson},
               {".geojsonl", LineFormat::kGeoJson}},
              lower(std::filesystem::path(path).extension().string()));
}

std::optional<LineFormat> parse_format(const std::string& name) {
  return find({{"smoothed", LineFormat::kSmoothed},
               {"one-line", LineFormat::kOneLine},
               {"csv", LineFormat::kCsv},
               {"gpx", LineFormat::kGpx},
               {"geojson", LineFormat::kGeoJson}},
              name);
}

LineFile read_line(const std::string& path, LineFormat format, const ReadOptions& options) {
  switch (format) {
    case LineFormat::kCsv:
      return read_csv(path, options);
    case LineFormat::kGpx:
      return projected(path, read_gpx(path), options);
    case LineFormat::kGeoJson:
      return projected(path, read_geojson(path), options);
    default:
      return read_line_file(path);
  }
}

void write_line(const std::string& path, LineFormat format, const LineFile& file,
                const WriteOptions& options) {
  switch (format) {
    case LineFormat::kSmoothed:
      return write_line_file(path, file);
    case LineFormat::kOneLine:
      return write_line_file(path, file, Layout::kOneLine);
    case LineFormat::kCsv:
      expect_finite_positions(path, file.line);
      if (options.geographic) unprojected(path, file);  // says what hinders it
      return write_whole_file(path, to_csv(file, options));
    case LineFormat::kGpx:
      return write_whole_file(path, to_gpx(file.line.name, unprojected(path, file)));
    case LineFormat::kGeoJson:
      return write_whole_file(path, to_geojson(file.line.name, unprojected(path, file)));
  }
}

}  // namespace relative_map::core
