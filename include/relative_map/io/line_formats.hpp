#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relative_map/io/geodetic_projection.hpp"
#include "relative_map/io/navigation_line_file.hpp"

namespace relative_map::core {

/// The files that navigation lines come in and go to.
enum class LineFormat {
  kSmoothed,  ///< one JSON object a line
  kOneLine,   ///< the same objects on one line
  kCsv,       ///< x,y[,z] in the map frame, or lon,lat[,alt] with a header
  kGpx,       ///< a track or route
  kGeoJson,   ///< a LineString
};

/// By the file's extension: .smoothed .jsonl .txt, .json, .csv .tsv, .gpx, .geojson; none: not known.
std::optional<LineFormat> format_of(const std::string& path);
/// "smoothed", "one-line", "csv", "gpx" or "geojson"; none: not known.
std::optional<LineFormat> parse_format(const std::string& name);

struct ReadOptions {
  /// Where longitudes and latitudes are projected to; without it, where the file says, or else to the UTM
  /// zone that they lie in.
  GeoReference reference;
};

struct WriteOptions {
  char separator = ',';     ///< CSV
  bool geographic = false;  ///< CSV: lon,lat,alt instead of x,y,z
};

/// All throw std::runtime_error, one sentence that names the file, the place in it and the fault.
LineFile read_line(const std::string& path, LineFormat format, const ReadOptions& options = {});
void write_line(const std::string& path, LineFormat format, const LineFile& file,
                const WriteOptions& options = {});

/// What a file holds that speaks of the earth and not of a map.
struct GeoLine {
  LineHeader header;  ///< as this package's files carry it along
  std::vector<GeoPoint> points;
};

/// Columns are told apart by whichever of , ; | tab or blanks the first line has, and named by a header, or
/// else are x, y and z. Columns of other names are left out. '#' starts a comment.
LineFile read_csv(const std::string& path, const ReadOptions& options);
std::string to_csv(const LineFile& file, const WriteOptions& options);

/// The points of the one track, or route, of a file; its segments follow each other.
GeoLine read_gpx(const std::string& path);
std::string to_gpx(const std::string& name, const GeoLine& line);

/// The one LineString of a file, whatever it is wrapped in; a MultiLineString's parts follow each other.
GeoLine read_geojson(const std::string& path);
std::string to_geojson(const std::string& name, const GeoLine& line);

}  // namespace relative_map::core
