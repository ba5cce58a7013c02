// Drives on routes, against what an independent model of the original gives. Where that is one of its known
// faults, the value that is right stands here.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "reference_data.hpp"
#include "relative_map/io/lane_graph_file.hpp"
#include "relative_map/route/route_check.hpp"
#include "relative_map/route/route_map.hpp"

namespace relative_map::core {
namespace {

using nlohmann::json;

constexpr double kRounded = 2e-3;  // [m] the cases are rounded to a tenth of a millimetre a piece

std::string folder() {
  return test::reference_folder().value() + "/route/";
}

#define REQUIRE_ROUTE_DATA() \
  REQUIRE_REFERENCE_DATA();  \
  if (!std::ifstream(folder() + "cases.json")) GTEST_SKIP() << "the reference data has no routes"

std::shared_ptr<const LaneNetwork> network(const std::string& name) {
  std::vector<GraphFault> faults;
  auto prepared = LaneNetwork::prepare(read_lane_graph(folder() + "graph_" + name + ".json"), faults);
  EXPECT_NE(prepared, nullptr) << name;
  return prepared;
}

Pose2 pose_of(const json& step) {
  return Pose2({step["x"].get<double>(), step["y"].get<double>()}, step["heading"].get<double>());
}

void expect_contract(const RouteUpdate& update, const RouteMap& map, const std::string& where) {
  for (const RouteViolation& violation : check_route(update, map.index())) {
    ADD_FAILURE() << where << ": " << violation.row << ": " << violation.what;
  }
}

/// The expected pieces, cut where the destination is: the original drives on past it.
std::vector<LaneSegment> up_to_destination(const json& lanes, const RoutePlace& place, double s,
                                           const LaneNetwork& graph) {
  std::vector<LaneSegment> pieces;
  double left = place.distance_to_destination + s;
  for (const json& lane : lanes) {
    LaneSegment piece{lane[0], lane[1], lane[2]};
    const double length = piece.end_s - piece.start_s;
    const bool closed = graph.lane(*graph.find(piece.lane_id)).closed;
    if (!closed) piece.end_s = std::min(piece.end_s, piece.start_s + left);
    if (piece.end_s - piece.start_s > kRounded) pieces.push_back(piece);
    left -= length;
  }
  return pieces;
}

void expect_pieces(const std::vector<LaneSegment>& wanted, const RouteSegments& segments,
                   const std::string& where) {
  ASSERT_EQ(segments.segments.size(), wanted.size()) << where;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(segments.segments[i].lane_id, wanted[i].lane_id) << where;
    EXPECT_NEAR(segments.segments[i].start_s, wanted[i].start_s, kRounded) << where;
    EXPECT_NEAR(segments.segments[i].end_s, wanted[i].end_s, kRounded) << where;
  }
}

const char* name(ChangeLane change) {
  constexpr const char* kNames[] = {"FORWARD", "LEFT", "RIGHT"};
  return kNames[static_cast<std::size_t>(change)];
}

void expect_segments(const json& wanted, const RouteSegments& segments, const RouteUpdate& update,
                     const LaneNetwork& graph, bool exits, const std::string& where) {
  EXPECT_EQ(segments.id, wanted["id"]) << where;
  EXPECT_EQ(segments.is_on_segment, wanted["on_segment"]) << where;
  EXPECT_EQ(segments.can_exit, wanted["can_exit"]) << where;
  EXPECT_EQ(name(segments.next_action), wanted["next_action"]) << where;
  EXPECT_EQ(name(segments.previous_action), wanted["previous_action"]) << where;
  EXPECT_EQ(segments.stop_for_destination, wanted["stop_for_destination"]) << where;
  EXPECT_EQ(segments.route_end.has_value(), !wanted["route_end"].is_null()) << where;
  if (segments.route_end && !wanted["route_end"].is_null()) {
    EXPECT_EQ(segments.route_end->lane_id, wanted["route_end"][0]) << where;
    EXPECT_NEAR(segments.route_end->s, wanted["route_end"][1].get<double>(), kRounded) << where;
  }
  std::vector<LaneSegment> pieces;
  if (exits) {
    pieces = up_to_destination(wanted["lanes"], *update.place, segments.s, graph);
  } else {
    for (const json& lane : wanted["lanes"]) pieces.push_back({lane[0], lane[1], lane[2]});
  }
  expect_pieces(pieces, segments, where);
}

/// Steps of cases.json at which the original is wrong; a test of its own has what is right there.
const std::map<std::string, std::set<std::size_t>> kWrong = {
    {"via", {3, 4}},             // faults 9 and 3
    {"aside", {2}},              // 5
    {"wrong_way", {1, 2, 3}},    // 5
    {"sample", {0, 1, 2, 3, 4}}  // 7, 9 and 3
};

TEST(RouteCases, EveryPoseIsThatOfTheOriginalWhereThatIsRight) {
  REQUIRE_ROUTE_DATA();
  std::size_t poses = 0;
  const json cases = test::read_json(folder() + "cases.json");
  for (const json& drive : cases["drives"]) {
    const std::string drive_name = drive["name"];
    RouteMap map{RouteParam{}};
    map.set_graph(network(drive["graph"]));
    const RouteStatus taken =
        map.set_route(read_route(folder() + "route_" + drive["route"].get<std::string>() + ".json"));
    ASSERT_EQ(taken.code, RouteCode::kOk) << drive_name << ": " << taken.message;
    for (std::size_t i = 0; i < drive["steps"].size(); ++i) {
      const json& step = drive["steps"][i];
      const std::string where = drive_name + ", pose " + std::to_string(i);
      const RouteUpdate update = map.update(pose_of(step), drive["speed"]);
      expect_contract(update, map, where);
      const auto wrong = kWrong.find(drive_name);
      if (wrong != kWrong.end() && wrong->second.count(i) > 0) continue;
      ++poses;
      const json& expected = step["expected"];
      if (expected.contains("refused")) {
        EXPECT_NE(update.status.code, RouteCode::kOk) << where;
        continue;
      }
      ASSERT_EQ(update.status.code, RouteCode::kOk) << where << ": " << update.status.message;
      const RoutePlace& place = *update.place;
      EXPECT_EQ(place.lane_id, expected["lane"]) << where;
      EXPECT_NEAR(place.s, expected["s"].get<double>(), kRounded) << where;
      EXPECT_NEAR(place.l, expected["l"].get<double>(), kRounded) << where;
      EXPECT_EQ(place.segment, expected["route_index"]) << where;
      EXPECT_EQ((std::vector<std::size_t>{place.road, place.passage, place.position}),
                expected["road_passage_place"].get<std::vector<std::size_t>>())
          << where;
      EXPECT_EQ(place.next_waypoint, expected["next_waypoint"]) << where;
      ASSERT_EQ(update.segments.size(), expected["segments"].size()) << where;
      for (std::size_t k = 0; k < update.segments.size(); ++k) {
        expect_segments(expected["segments"][k], update.segments[k], update, *map.network(),
                        update.segments[k].can_exit, where);
      }
    }
  }
  EXPECT_EQ(poses, 32u);
}

/// A drive of defects.json, and what is told at each pose.
class Defect {
 public:
  explicit Defect(const std::string& drive_name) : map_(RouteParam{}) {
    const json drives = test::read_json(folder() + "defects.json");
    for (const json& drive : drives) {
      if (drive["name"] != drive_name) continue;
      map_.set_graph(network(drive["graph"]));
      const std::string file = testing::TempDir() + "route_of_defect.json";
      std::ofstream(file) << drive["route"].dump();
      EXPECT_EQ(map_.set_route(read_route(file)).code, RouteCode::kOk) << drive_name;
      for (const json& step : drive["steps"]) {
        updates.push_back(map_.update(pose_of(step), 10.0));
        expect_contract(updates.back(), map_, drive_name);
      }
    }
  }
  std::vector<RouteUpdate> updates;

 private:
  RouteMap map_;
};

std::vector<std::string> ids(const RouteUpdate& update) {
  std::vector<std::string> result;
  for (const RouteSegments& segments : update.segments) result.push_back(segments.id);
  return result;
}

std::vector<std::string> lanes(const RouteSegments& segments) {
  std::vector<std::string> result;
  for (const LaneSegment& piece : segments.segments) result.push_back(piece.lane_id);
  return result;
}

TEST(RouteDefects, AJumpBack) {
  REQUIRE_ROUTE_DATA();
  const Defect drive("jump_back");
  EXPECT_EQ(drive.updates.at(1).place->lane_id, "b0");
  EXPECT_EQ(drive.updates.at(2).place->lane_id, "b0");
}

TEST(RouteDefects, AnAbandonedChange) {
  REQUIRE_ROUTE_DATA();
  const Defect drive("abandoned_change");
  EXPECT_THAT(ids(drive.updates.at(2)), testing::ElementsAre("0_0", "0_1"));
  EXPECT_THAT(ids(drive.updates.at(3)), testing::ElementsAre("0_0", "0_1"));
  EXPECT_EQ(drive.updates.at(3).place->lane_id, "c0");
}

TEST(RouteDefects, ARepeatedLaneAfterAGap) {
  REQUIRE_ROUTE_DATA();
  const Defect drive("repeated_lane_after_a_gap");
  EXPECT_THAT(ids(drive.updates.at(1)), testing::ElementsAre("0_3"));
  EXPECT_TRUE(drive.updates.at(1).segments[0].stop_for_destination);
}

TEST(RouteDefects, AnOvershoot) {
  REQUIRE_ROUTE_DATA();
  const Defect drive("overshoot");
  EXPECT_EQ(drive.updates.at(1).place->lane_id, "b3");
  EXPECT_NEAR(drive.updates.at(1).place->distance_to_destination, -0.3, 1e-9);
}

TEST(RouteDefects, AnEndWithoutLength) {
  REQUIRE_ROUTE_DATA();
  const Defect drive("zero_length_end");
  EXPECT_THAT(lanes(drive.updates.at(0).segments.at(0)), testing::ElementsAre("b1", "b2"));
}

TEST(RouteDefects, AClosedLane) {
  REQUIRE_ROUTE_DATA();
  const Defect drive("closed_lane");
  for (const RouteUpdate& update : drive.updates) {
    EXPECT_NEAR(update.segments.at(0).length(), 230.0, 1e-3);
    EXPECT_NEAR(update.segments[0].s, 50.0, 1e-3);
    EXPECT_THAT(lanes(update.segments[0]), testing::ElementsAre("ring", "ring"));
  }
}

TEST(RouteDefects, TheSameLanesTwice) {
  REQUIRE_ROUTE_DATA();
  EXPECT_THAT(ids(Defect("same_lanes_twice").updates.at(0)), testing::ElementsAre("0_1", "0_2"));
}

TEST(RouteDefects, ALaneOfTwoPoints) {
  REQUIRE_ROUTE_DATA();
  EXPECT_EQ(Defect("two_point_lane").updates.at(0).status.code, RouteCode::kOffRoute);
}

TEST(RouteDefects, ALapThatEndsWhereItStarts) {
  REQUIRE_ROUTE_DATA();
  EXPECT_FALSE(Defect("lap_that_ends_where_it_starts").updates.at(0).segments.at(0).stop_for_destination);
}

TEST(RouteDefects, ACorner) {
  REQUIRE_ROUTE_DATA();
  for (const RouteUpdate& update : Defect("corner").updates) EXPECT_EQ(update.status.code, RouteCode::kOk);
}

// The recorded route with its hole closed: the lane that the original jumps over is driven to its end.
TEST(RouteDefects, AHoleOfARecordedRoute) {
  REQUIRE_ROUTE_DATA();
  RouteMap map{RouteParam{}};
  map.set_graph(network("sunnyvale_straight"));
  ASSERT_EQ(map.set_route(read_route(folder() + "route_sample_sunnyvale_loop_routing.json")).code,
            RouteCode::kOk);
  EXPECT_THAT(map.repairs(), testing::ElementsAre(testing::HasSubstr("9_1_-2")));
  const Point2 on_hole = map.network()->lane(*map.network()->find("9_1_-2")).line.point_at(120.0);
  const RouteUpdate update = map.update(Pose2(on_hole, kPi), 10.0);
  expect_contract(update, map, "in the hole");
  EXPECT_EQ(update.place->lane_id, "9_1_-2");
  EXPECT_THAT(lanes(update.segments.at(0)), testing::ElementsAre("9_1_-2", "13_1_-2", "12_1_-3"));
}

/// Straight lanes that a route without its map could lie on: as long as it needs, one after the other.
LaneGraph graph_for(const Route& route) {
  LaneGraph graph;
  std::map<std::string, std::size_t> known;
  double row = 0.0;
  const auto lane = [&](const LaneSegment& segment) -> GraphLane& {
    const auto [found, added] = known.emplace(segment.lane_id, graph.lanes.size());
    if (added) {
      graph.lanes.emplace_back();
      graph.lanes.back().id = segment.lane_id;
      graph.lanes.back().centerline = {{0.0, row}, {1.0, row}};
      row += 30.0;
    }
    GraphLane& it = graph.lanes[found->second];
    it.centerline[1].x() = std::max(it.centerline[1].x(), segment.end_s);
    return it;
  };
  for (const RouteRoad& road : route.roads) {
    for (const Passage& passage : road.passages) {
      for (std::size_t i = 0; i < passage.segments.size(); ++i) {
        lane(passage.segments[i]);
        if (i > 0) lane(passage.segments[i - 1]).successors.push_back(passage.segments[i].lane_id);
      }
    }
  }
  return graph;
}

TEST(RecordedRoutes, AllAreTaken) {
  REQUIRE_ROUTE_DATA();
  std::size_t routes = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder())) {
    const std::string file_name = file.path().filename().string();
    if (file_name.rfind("route_", 0) != 0) continue;
    ++routes;
    const Route route = read_route(file.path().string());
    std::vector<GraphFault> faults;
    const auto made = LaneNetwork::prepare(graph_for(route), faults);
    ASSERT_NE(made, nullptr);
    const RouteIndex::Result result = RouteIndex::build(made, route);
    EXPECT_NE(result.index, nullptr) << file_name << ": " << result.status.message;
  }
  EXPECT_GE(routes, 46u);
}

}  // namespace
}  // namespace relative_map::core
