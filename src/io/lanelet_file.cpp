#include "relative_map/io/lanelet_file.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <stdexcept>

#include "lanelet_lane.hpp"
#include "relative_map/io/geodetic_projection.hpp"
#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

using lanelet::Bound;
using lanelet::Lanelet;
using lanelet::Tags;
using tinyxml2::XMLElement;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what);
}

std::string attribute(const XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  if (value == nullptr)
    fail("line " + std::to_string(element.GetLineNum()) + ": '" + element.Name() + "' lacks '" + name + "'");
  return value;
}

Tags tags_of(const XMLElement& element) {
  Tags tags;
  for (const XMLElement* tag = element.FirstChildElement("tag"); tag != nullptr;
       tag = tag->NextSiblingElement("tag")) {
    tags[attribute(*tag, "k")] = attribute(*tag, "v");
  }
  return tags;
}

template <class Visit>
void for_each(const XMLElement& root, const char* name, Visit visit) {
  for (const XMLElement* element = root.FirstChildElement(name); element != nullptr;
       element = element->NextSiblingElement(name)) {
    const char* action = element->Attribute("action");
    if (action == nullptr || std::string(action) != "delete") visit(*element);
  }
}

/// A number at the start of a text; the rest, without blanks, comes back.
std::optional<double> number_of(const std::string& text, std::string* unit = nullptr) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || !std::isfinite(value)) return std::nullopt;
  std::string rest = end;
  rest.erase(std::remove(rest.begin(), rest.end(), ' '), rest.end());
  if (unit != nullptr) *unit = rest;
  return value;
}

/// [m/s] of "50", "50 km/h", "30 mph", or of a sign like "de274-60".
std::optional<double> speed_of(const std::string& text) {
  const std::size_t dash = text.rfind('-');
  const bool sign = dash != std::string::npos && dash > 0;
  std::string unit;
  const auto value = number_of(sign ? text.substr(dash + 1) : text, &unit);
  if (!value || *value <= 0.0) return std::nullopt;
  if (unit == "mph") return *value * 0.44704;
  if (unit.empty() || unit == "km/h" || unit == "kmh" || unit == "kph") return *value / 3.6;
  return unit == "m/s" ? value : std::nullopt;
}

std::map<std::string, Point2> points_of(const XMLElement& root,
                                        const std::optional<GeoReference>& reference) {
  std::vector<std::string> ids;
  std::vector<GeoPoint> places;
  std::map<std::string, Point2> local;
  for_each(root, "node", [&](const XMLElement& node) {
    const std::string id = attribute(node, "id");
    const Tags tags = tags_of(node);
    const auto x = tags.count("local_x") ? number_of(tags.at("local_x")) : std::nullopt;
    const auto y = tags.count("local_y") ? number_of(tags.at("local_y")) : std::nullopt;
    if (x && y) local[id] = Point2(*x, *y);
    const auto latitude = number_of(attribute(node, "lat")), longitude = number_of(attribute(node, "lon"));
    if (!latitude || !longitude) fail("node " + id + " has a lat or lon that is no number");
    ids.push_back(id);
    places.push_back({*longitude, *latitude, std::nan("")});
  });
  if (ids.empty()) fail("has no node");
  if (local.size() == ids.size()) return local;
  const std::vector<LinePoint> projected = project(places, reference ? *reference : utm_zone_of(places));
  std::map<std::string, Point2> points;
  for (std::size_t i = 0; i < ids.size(); ++i) points[ids[i]] = Point2(projected[i].x, projected[i].y);
  return points;
}

std::map<std::string, Bound> ways_of(const XMLElement& root, const std::map<std::string, Point2>& points) {
  std::map<std::string, Bound> ways;
  for_each(root, "way", [&](const XMLElement& way) {
    Bound bound;
    bound.id = attribute(way, "id");
    bound.tags = tags_of(way);
    for (const XMLElement* nd = way.FirstChildElement("nd"); nd != nullptr;
         nd = nd->NextSiblingElement("nd")) {
      const std::string node = attribute(*nd, "ref");
      const auto found = points.find(node);
      if (found == points.end()) fail("way " + bound.id + " has node " + node + ", which is not in the file");
      bound.nodes.push_back(node);
      bound.points.push_back(found->second);
    }
    ways[bound.id] = bound;
  });
  return ways;
}

/// The speed limits among the regulatory elements.
std::map<std::string, double> limits_of(const XMLElement& root, std::vector<std::string>& remarks) {
  std::map<std::string, double> limits;
  for_each(root, "relation", [&](const XMLElement& relation) {
    const Tags tags = tags_of(relation);
    if (lanelet::value(tags, "type") != "regulatory_element") return;
    const std::string id = attribute(relation, "id"), kind = lanelet::value(tags, "subtype");
    if (kind != "speed_limit") {
      remarks.push_back("regulatory element " + id + " of the subtype '" + kind + "' is not read");
      return;
    }
    for (const char* key : {"limit", "sign_type", "speed_limit"}) {
      const auto speed = tags.count(key) ? speed_of(tags.at(key)) : std::nullopt;
      if (speed) limits.emplace(id, *speed);
    }
    if (limits.count(id) == 0)
      remarks.push_back("regulatory element " + id + " has no speed limit that is understood");
  });
  return limits;
}

bool for_cars(const Tags& tags) {
  static const std::set<std::string> kDriven = {"road", "highway", "play_street", "bus_lane", ""};
  const std::string vehicles = lanelet::value(tags, "participant:vehicle");
  if (vehicles == "no") return false;
  return kDriven.count(lanelet::value(tags, "subtype")) > 0 || vehicles == "yes";
}

const Bound& bound_of(const XMLElement& relation, const char* role,
                      const std::map<std::string, Bound>& ways) {
  const std::string name = "lanelet " + attribute(relation, "id");
  const Bound* found = nullptr;
  for (const XMLElement* member = relation.FirstChildElement("member"); member != nullptr;
       member = member->NextSiblingElement("member")) {
    if (attribute(*member, "role") != role) continue;
    if (found != nullptr) fail(name + " has more than one " + role + " bound");
    const std::string id = attribute(*member, "ref");
    const auto way = ways.find(id);
    if (way == ways.end()) fail(name + " has way " + id + ", which is not in the file");
    found = &way->second;
  }
  if (found == nullptr) fail(name + " has no " + role + " bound");
  if (found->points.size() < 2)
    fail(name + ": its " + role + " bound, way " + found->id + ", has fewer than two nodes");
  return *found;
}

double limit_of(const XMLElement& relation, const Tags& tags, const std::map<std::string, double>& limits,
                std::vector<std::string>& remarks) {
  for (const XMLElement* member = relation.FirstChildElement("member"); member != nullptr;
       member = member->NextSiblingElement("member")) {
    if (attribute(*member, "role") != "regulatory_element") continue;
    const auto limit = limits.find(attribute(*member, "ref"));
    if (limit != limits.end()) return limit->second;
  }
  const std::string tag = lanelet::value(tags, "speed_limit");
  if (tag.empty()) return 0.0;
  const auto speed = speed_of(tag);
  if (!speed)
    remarks.push_back("lanelet " + attribute(relation, "id") + ": the speed limit '" + tag +
                      "' is not understood");
  return speed.value_or(0.0);
}

LaneTurn turn_of(const Tags& tags) {
  const std::string turn = lanelet::value(tags, "turn_direction");
  if (turn == "left") return LaneTurn::kLeftTurn;
  return turn == "right" ? LaneTurn::kRightTurn : LaneTurn::kNoTurn;
}

LaneletMap read(const XMLElement& root, const std::optional<GeoReference>& reference) {
  LaneletMap map;
  const auto points = points_of(root, reference);
  const auto ways = ways_of(root, points);
  const auto limits = limits_of(root, map.remarks);
  std::vector<Lanelet> lanelets;
  for_each(root, "relation", [&](const XMLElement& relation) {
    const Tags tags = tags_of(relation);
    if (lanelet::value(tags, "type") != "lanelet") return;
    const std::string id = attribute(relation, "id");
    if (!for_cars(tags)) {
      map.remarks.push_back("lanelet " + id + " of the subtype '" + lanelet::value(tags, "subtype") +
                            "' is not for cars: it is left out");
      return;
    }
    Lanelet lane{id, bound_of(relation, "left", ways), bound_of(relation, "right", ways)};
    lane.speed_limit = limit_of(relation, tags, limits, map.remarks);
    lane.turn = turn_of(tags);
    lanelet::align(lane);
    lanelets.push_back(lane);
    if (lanelet::value(tags, "one_way") == "no") lanelets.push_back(lanelet::reversed(lane));
  });
  if (lanelets.empty()) fail("has no lanelet for cars");
  map.graph.lanes = lanelet::lanes_of(lanelets);
  return map;
}

}  // namespace

LaneletMap read_lanelet_map(const std::string& path, const std::optional<GeoReference>& reference) {
  tinyxml2::XMLDocument document;
  const std::string content = read_whole_file(path);
  if (document.Parse(content.data(), content.size()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error(path + ": line " + std::to_string(document.ErrorLineNum()) +
                             ": not valid XML; is it cut off?");
  }
  const XMLElement* root = document.FirstChildElement("osm");
  if (root == nullptr) throw std::runtime_error(path + ": is no OSM file: it has no element 'osm'");
  try {
    return read(*root, reference);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": " + fault.what());
  }
}

}  // namespace relative_map::core
