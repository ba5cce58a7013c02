#include "relative_map/io/line_formats.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

template <class Key>
std::optional<LineFormat> find(const std::map<std::string, LineFormat>& formats, const Key& key) {
  const auto found = formats.find(key);
  return found == formats.end() ? std::nullopt : std::optional<LineFormat>(found->second);
}

LineFile projected(const std::string& path, GeoLine geo, const ReadOptions& options) {
  LineFile file;
  file.header = geo.header;
  file.line.name = line_name(path);
  if (geo.points.empty()) throw std::runtime_error(path + ": has no points");
  try {
    if (options.reference.projection != Projection::kNone) file.header.reference = options.reference;
    GeoReference& reference = file.header.reference;
    if (reference.projection == Projection::kNone) reference = utm_zone_of(geo.points);
    file.line.points = project(geo.points, reference);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": " + fault.what());
  }
  return file;
}

GeoLine unprojected(const std::string& path, const LineFile& file) {
  expect_finite_positions(path, file.line);
  try {
    return {file.header, unproject(file.line.points, file.header.reference)};
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": not written, since " + fault.what());
  }
}

}  // namespace

std::optional<LineFormat> format_of(const std::string& path) {
  return find({{".smoothed", LineFormat::kSmoothed},
               {".jsonl", LineFormat::kSmoothed},
               {".txt", LineFormat::kSmoothed},
               {".json", LineFormat::kOneLine},
               {".csv", LineFormat::kCsv},
               {".tsv", LineFormat::kCsv},
               {".gpx", LineFormat::kGpx},
               {".geojson", LineFormat::kGeoJson}},
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
