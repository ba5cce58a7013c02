#include "relative_map/io/lane_graph_file.hpp"

#include <array>
#include <utility>

#include "json_fields.hpp"

namespace relative_map::core {

namespace {

using json_fields::Json;

template <class Value>
using Name = std::pair<const char*, Value>;

constexpr std::array<Name<BoundaryType>, 7> kBoundaryTypes = {{
    {"unknown", BoundaryType::kUnknown},
    {"dotted_yellow", BoundaryType::kDottedYellow},
    {"dotted_white", BoundaryType::kDottedWhite},
    {"solid_yellow", BoundaryType::kSolidYellow},
    {"solid_white", BoundaryType::kSolidWhite},
    {"double_yellow", BoundaryType::kDoubleYellow},
    {"curb", BoundaryType::kCurb},
}};
constexpr std::array<Name<LaneType>, 7> kLaneTypes = {{
    {"city_driving", LaneType::kCityDriving},
    {"none", LaneType::kNone},
    {"biking", LaneType::kBiking},
    {"sidewalk", LaneType::kSidewalk},
    {"parking", LaneType::kParking},
    {"shoulder", LaneType::kShoulder},
    {"unknown", LaneType::kUnknown},
}};
// The first name of a value is the one that is written.
constexpr std::array<Name<LaneTurn>, 7> kTurns = {{
    {"no_turn", LaneTurn::kNoTurn},
    {"left", LaneTurn::kLeftTurn},
    {"right", LaneTurn::kRightTurn},
    {"u_turn", LaneTurn::kUTurn},
    {"left_turn", LaneTurn::kLeftTurn},
    {"right_turn", LaneTurn::kRightTurn},
    {"unknown", LaneTurn::kUnknown},
}};

template <class Names>
auto value_of(const Names& names, const std::string& name, const std::string& where) {
  for (const auto& [known, value] : names) {
    if (name == known) return value;
  }
  json_fields::fail(where, "'" + name + "' is not known");
}

template <class Names, class Value>
const char* name_in(const Names& names, Value value) {
  for (const auto& [name, known] : names) {
    if (known == value) return name;
  }
  return names.front().first;
}

Polyline points_of(const Json& list, const std::string& where) {
  Polyline points;
  for (const Json& element : list) {
    const Json& pair = json_fields::pair(element, where);
    points.emplace_back(json_fields::number(pair[0], where), json_fields::number(pair[1], where));
  }
  return points;
}

std::vector<WidthSample> widths_of(const Json& list, const std::string& where) {
  std::vector<WidthSample> samples;
  for (const Json& element : list) {
    const Json& pair = json_fields::pair(element, where);
    samples.push_back({json_fields::number(pair[0], where), json_fields::number(pair[1], where)});
  }
  return samples;
}

std::vector<PaintSpan> paint_of(const Json& list, const std::string& where) {
  std::vector<PaintSpan> spans;
  for (const Json& element : list) {
    const Json& pair = json_fields::pair(element, where);
    spans.push_back({json_fields::number(pair[0], where),
                     value_of(kBoundaryTypes, json_fields::text(pair[1], where), where + ": paint")});
  }
  return spans;
}

GraphLane lane_of(const Json& object, const std::string& file, std::size_t number) {
  const std::string place = file + ": lane " + std::to_string(number);
  if (!object.is_object()) json_fields::fail(place, "must be an object");
  GraphLane lane;
  lane.id = json_fields::text(json_fields::required(object, "id", place), place + " 'id'");
  const std::string where = file + ": lane '" + lane.id + "'";
  const auto list = [&](const char* key) -> const Json& {
    return json_fields::list_or_none(object, key, where);
  };
  const auto at = [&](const char* key) { return where + " '" + key + "'"; };
  lane.centerline = points_of(json_fields::list(object, "centerline", where), at("centerline"));
  lane.left_width = widths_of(list("left_width"), at("left_width"));
  lane.right_width = widths_of(list("right_width"), at("right_width"));
  lane.successors = json_fields::texts(object, "successors", where);
  lane.predecessors = json_fields::texts(object, "predecessors", where);
  lane.left_neighbors = json_fields::texts(object, "left_neighbors", where);
  lane.right_neighbors = json_fields::texts(object, "right_neighbors", where);
  lane.left_reverse = json_fields::texts(object, "left_reverse", where);
  lane.right_reverse = json_fields::texts(object, "right_reverse", where);
  lane.left_paint = paint_of(list("left_paint"), at("left_paint"));
  lane.right_paint = paint_of(list("right_paint"), at("right_paint"));
  lane.speed_limit = json_fields::number_or(object, "speed_limit", 0.0, where);
  lane.type =
      value_of(kLaneTypes, json_fields::text_or(object, "type", "city_driving", where), where + ": type");
  lane.turn = value_of(kTurns, json_fields::text_or(object, "turn", "no_turn", where), where + ": turn");
  lane.road = json_fields::text_or(object, "road", "", where);
  lane.junction = json_fields::text_or(object, "junction", "", where);
  return lane;
}

Json json_of(const Polyline& points) {
  Json list = Json::array();
  for (const Point2& point : points) list.push_back({point.x(), point.y()});
  return list;
}

Json json_of(const std::vector<WidthSample>& samples) {
  Json list = Json::array();
  for (const WidthSample& sample : samples) list.push_back({sample.s, sample.width});
  return list;
}

Json json_of(const std::vector<PaintSpan>& spans) {
  Json list = Json::array();
  for (const PaintSpan& span : spans) list.push_back({span.s, name_in(kBoundaryTypes, span.type)});
  return list;
}

Json json_of(const GraphLane& lane) {
  return {{"id", lane.id},
          {"centerline", json_of(lane.centerline)},
          {"left_width", json_of(lane.left_width)},
          {"right_width", json_of(lane.right_width)},
          {"successors", lane.successors},
          {"predecessors", lane.predecessors},
          {"left_neighbors", lane.left_neighbors},
          {"right_neighbors", lane.right_neighbors},
          {"left_reverse", lane.left_reverse},
          {"right_reverse", lane.right_reverse},
          {"left_paint", json_of(lane.left_paint)},
          {"right_paint", json_of(lane.right_paint)},
          {"speed_limit", lane.speed_limit},
          {"type", name_in(kLaneTypes, lane.type)},
          {"turn", name_in(kTurns, lane.turn)},
          {"road", lane.road},
          {"junction", lane.junction}};
}

}  // namespace

LaneGraph read_lane_graph(const std::string& path) {
  const Json object = json_fields::read_object(path);
  LaneGraph graph;
  graph.frame_id = json_fields::text_or(object, "frame_id", "", path + ":");
  graph.map_version = json_fields::text_or(object, "map_version", "", path + ":");
  for (const Json& lane : json_fields::list(object, "lanes", path + ":")) {
    graph.lanes.push_back(lane_of(lane, path, graph.lanes.size()));
  }
  return graph;
}

void write_lane_graph(const std::string& path, const LaneGraph& graph) {
  // A lane a line, so that a change of one lane is a change of one line.
  std::string text = "{";
  if (!graph.frame_id.empty()) text += "\"frame_id\": " + Json(graph.frame_id).dump() + ",\n";
  if (!graph.map_version.empty()) text += "\"map_version\": " + Json(graph.map_version).dump() + ",\n";
  text += "\"lanes\": [";
  for (std::size_t i = 0; i < graph.lanes.size(); ++i) {
    text += (i == 0 ? "\n" : ",\n") + json_of(graph.lanes[i]).dump();
  }
  write_whole_file(path, text + "\n]}\n");
}

BoundaryType boundary_type_of(const std::string& name) {
  return value_of(kBoundaryTypes, name, "the boundary type");
}

const char* name_of(BoundaryType type) {
  return name_in(kBoundaryTypes, type);
}

}  // namespace relative_map::core
