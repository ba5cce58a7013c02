#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "relative_map/io/line_formats.hpp"
#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

using Json = nlohmann::json;

GeoPoint parse_position(const Json& position, std::size_t index) {
  const bool good = position.is_array() && position.size() >= 2 && position[0].is_number() &&
                    position[1].is_number() && (position.size() == 2 || position[2].is_number());
  if (!good) {
    throw std::runtime_error("position " + std::to_string(index) +
                             " is not [longitude, latitude] or "
                             "[longitude, latitude, altitude]");
  }
  GeoPoint point;
  point.longitude = position[0].get<double>();
  point.latitude = position[1].get<double>();
  point.altitude = position.size() > 2 ? position[2].get<double>() : std::numeric_limits<double>::quiet_NaN();
  return point;
}

const Json& member(const Json& object, const char* key) {
  static const Json kNothing;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && found != object.end() ? *found : kNothing;
}

void add_positions(const Json& positions, std::vector<GeoPoint>& points) {
  if (!positions.is_array()) throw std::runtime_error("the coordinates of its LineString are no list");
  for (const Json& position : positions) points.push_back(parse_position(position, points.size()));
}

/// Takes every line of `object` and what is in it; the number of those.
int collect(const Json& object, GeoLine& line) {
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
    for (const Json& part : member(object, "coordinates")) add_positions(part, line.points);
    lines = 1;
  }
  return lines;
}

}  // namespace

GeoLine read_geojson(const std::string& path) {
  const std::string content = read_whole_file(path);
  if (content.empty()) throw std::runtime_error(path + ": has no points");
  Json document;
  try {
    document = Json::parse(content);
  } catch (const Json::parse_error& error) {
    throw std::runtime_error(path + ": not valid JSON near byte " + std::to_string(error.byte));
  } catch (const Json::exception&) {
    throw std::runtime_error(path + ": not valid JSON: a number is out of range");
  }
  GeoLine line;
  try {
    const int lines = collect(document, line);
    if (lines != 1) {
      throw std::runtime_error("has " + std::to_string(lines) + " LineStrings, but must have one");
    }
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": " + fault.what());
  }
  return line;
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
