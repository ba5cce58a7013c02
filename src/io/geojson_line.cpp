#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "json_stream.hpp"
#include "relative_map/io/line_formats.hpp"
#include "relative_map/io/text.hpp"

namespace relative_map::core {

namespace {

using Json = nlohmann::json;

GeoPoint parse_position(const Json& position, std::size_t index) {
  const bool good = position.is_array() && position.size() >= 2 && position[0].is_number() &&
                    position[1].is_number() &&
                    (position.size() == 2 || position[2].is_number() || position[2].is_null());
  if (!good) {
    throw std::runtime_error("position " + std::to_string(index) +
                             " is not [longitude, latitude] or "
                             "[longitude, latitude, altitude]");
  }
  GeoPoint point;
  point.longitude = position[0].get<double>();
  point.latitude = position[1].get<double>();
  point.altitude = position.size() > 2 && !position[2].is_null() ? position[2].get<double>()
                                                                 : std::numeric_limits<double>::quiet_NaN();
  return point;
}

const Json& member(const Json& object, const char* key) {
  static const Json kNothing;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && found != object.end() ? *found : kNothing;
}

/// Throws if the coordinates under `object` are not longitudes and latitudes of WGS 84, as an older GeoJSON
/// (2008) could have it.
void expect_wgs84(const Json& object) {
  const Json& crs = member(object, "crs");
  if (crs.is_null()) return;
  const Json& name = member(member(crs, "properties"), "name");
  const std::string text = name.is_string() ? name.get<std::string>() : crs.dump();
  for (const char* known : {"CRS84", "CRS84h", "EPSG:4326", "EPSG::4326", "EPSG:4979", "EPSG::4979"}) {
    const std::string end = known;
    if (text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0) return;
  }
  throw std::runtime_error("its crs is " + text +
                           ", but longitude and latitude of WGS 84 are read: convert it, e.g. by ogr2ogr "
                           "-t_srs EPSG:4326");
}

void add_positions(const Json& positions, std::vector<GeoPoint>& points) {
  if (!positions.is_array()) throw std::runtime_error("the coordinates of its LineString are no list");
  for (const Json& position : positions) points.push_back(parse_position(position, points.size()));
}

/// Takes every line of `object` and what is in it; the number of those.
int collect(const Json& object, GeoLine& line) {
  expect_wgs84(object);
  const Json& type = member(object, "type");
  int lines = 0;
  if (type == "FeatureCollection") {
    for (const Json& feature : member(object, "features")) lines += collect(feature, line);
  } else if (type == "Feature") {
    lines = collect(member(object, "geometry"), line);
    const Json& header = member(member(object, "properties"), "header");
    if (lines > 0 && header.is_object()) {
      line.header =
          parse_line_header(Json{{"header", header}}.dump(-1, ' ', false, Json::error_handler_t::replace));
    }
  } else if (type == "GeometryCollection") {
    for (const Json& geometry : member(object, "geometries")) lines += collect(geometry, line);
  } else if (type == "LineString") {
    add_positions(member(object, "coordinates"), line.points);
    lines = 1;
  } else if (type == "MultiLineString") {
    for (const Json& part : member(object, "coordinates")) {
      if (!line.points.empty()) line.parts.push_back(line.points.size());
      add_positions(part, line.points);
    }
    lines = 1;
  }
  return lines;
}

}  // namespace

GeoLine read_geojson(const std::string& path) {
  const std::string text = read_text(path);
  if (trimmed(text).empty()) throw std::runtime_error(path + ": has no points");
  GeoLine line;
  JsonStream objects(text);
  Json object;
  int lines = 0;
  try {
    while (objects.next(object)) lines += collect(object, line);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": " + fault.what());
  }
  if (lines == 1) return line;
  throw std::runtime_error(path + ": has " + std::to_string(lines) + " LineStrings, but must have one");
}

std::string to_geojson(const std::string& name, const GeoLine& line) {
  Json coordinates = Json::array();
  for (const GeoPoint& point : line.points) {
    Json position = {point.longitude, point.latitude};
    if (std::isfinite(point.altitude)) position.push_back(point.altitude);
    coordinates.push_back(std::move(position));
  }
  Json properties = {{"name", name}};
  if (!is_empty(line.header)) properties.update(Json::parse(to_json(line.header)));
  const Json feature = {{"type", "Feature"},
                        {"properties", properties},
                        {"geometry", {{"type", "LineString"}, {"coordinates", coordinates}}}};
  return feature.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace relative_map::core
