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

/// By the file's extension: .smoothed .jsonl .txt, .json, .csv .tsv, .gpx, .geojson .geojsonl; none: not
/// known.
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
  LineHeader header = {};  ///< as this package's files carry it along
  std::vector<GeoPoint> points = {};
  std::vector<std::size_t> parts = {};  ///< of several, where each but the first one starts
  std::vector<std::string> notes = {};
};

/// Map coordinates of a line that was read from `path`; points that were never set (longitude and latitude 0)
/// are left out, and told in the notes, as are the gaps between its parts.
LineFile projected(const std::string& path, const GeoLine& geo, const ReadOptions& options);

/// RFC 4180, with any one of , ; | tab or blanks between the cells, as the first line has it. Columns are
/// named by a first line, or by a comment above the numbers ('#' starts one), in any order and with their
/// units, like "x [m]" or "s_m"; without names there must be x, y and perhaps z, and nothing else. Columns of
/// other names are left out and told. A cell of a column that is used is a number as a whole, or the line is
/// refused.
LineFile read_csv(const std::string& path, const ReadOptions& options);
std::string to_csv(const LineFile& file, const WriteOptions& options);

/// The points of the one track, or route, of a file; its segments follow each other.
GeoLine read_gpx(const std::string& path);
std::string to_gpx(const std::string& name, const GeoLine& line);

/// The one LineString of a file, whatever it is wrapped in, also as an object on each line; a
/// MultiLineString's parts follow each other. Coordinates other than WGS 84 are refused.
GeoLine read_geojson(const std::string& path);
std::string to_geojson(const std::string& name, const GeoLine& line);

}  // namespace relative_map::core
