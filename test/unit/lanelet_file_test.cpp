#include "relative_map/io/lanelet_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "support/temporary_folder.hpp"

namespace relative_map::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// An OSM file, put together by hand. Nodes are at local coordinates, near 49 N, 8.4 E.
class Osm {
 public:
  int node(double x, double y) {
    const int id = ++ids_;
    text_ << "<node id='" << id << "' lat='" << 49.0 + y / 111200.0 << "' lon='" << 8.4 + x / 73000.0
          << "'><tag k='local_x' v='" << x << "'/><tag k='local_y' v='" << y << "'/></node>\n";
    return id;
  }
  int way(const std::vector<int>& nodes, const std::string& type = "line_thin",
          const std::string& subtype = "dashed") {
    const int id = ++ids_;
    text_ << "<way id='" << id << "'>";
    for (const int node : nodes) text_ << "<nd ref='" << node << "'/>";
    text_ << "<tag k='type' v='" << type << "'/><tag k='subtype' v='" << subtype << "'/></way>\n";
    return id;
  }
  std::string lanelet(int left, int right, const std::string& more = "",
                      const std::string& subtype = "road") {
    const int id = ++ids_;
    text_ << "<relation id='" << id << "'><member type='way' ref='" << left
          << "' role='left'/><member type='way' ref='" << right
          << "' role='right'/><tag k='type' v='lanelet'/><tag k='subtype' v='" << subtype << "'/>" << more
          << "</relation>\n";
    return std::to_string(id);
  }
  void add(const std::string& text) { text_ << text; }
  std::string text() const {
    return "<?xml version='1.0'?>\n<osm version='0.6'>\n" + text_.str() + "</osm>\n";
  }

 private:
  std::ostringstream text_;
  int ids_ = 100;
};

class LaneletFile : public test::TemporaryFolder {
 protected:
  LaneletMap read(const std::string& text) { return read_lanelet_map(write("map.osm", text), std::nullopt); }
  std::string fault(const std::string& text) {
    return test::fault_of([&] { read(text); });
  }
  static const GraphLane& lane(const LaneletMap& map, const std::string& id) {
    for (const GraphLane& candidate : map.graph.lanes) {
      if (candidate.id == id) return candidate;
    }
    throw std::runtime_error("no lane " + id);
  }
};

TEST_F(LaneletFile, TwoLanesSideBySideAndOneThatFollows) {
  Osm osm;
  const int a0 = osm.node(0, 3.5), a1 = osm.node(50, 3.5), a2 = osm.node(90, 3.5);
  const int b0 = osm.node(0, 0), b1 = osm.node(50, 0), b2 = osm.node(90, 0);
  const int c0 = osm.node(0, -3), c1 = osm.node(50, -3);
  const int a = osm.way({a0, a1}, "curbstone", "high"), b = osm.way({b0, b1}),
            c = osm.way({c0, c1}, "line_thin", "solid");
  const int on_left = osm.way({a1, a2}), on_right = osm.way({b1, b2});
  const std::string left = osm.lanelet(a, b, "<tag k='speed_limit' v='50 km/h'/>"), right = osm.lanelet(b, c);
  const std::string on = osm.lanelet(on_left, on_right, "<tag k='turn_direction' v='left'/>");
  const LaneletMap map = read(osm.text());
  EXPECT_THAT(map.remarks, IsEmpty());
  ASSERT_EQ(map.graph.lanes.size(), 3u);
  const GraphLane& one = lane(map, left);
  EXPECT_EQ(one.centerline.front(), Point2(0.0, 1.75));
  EXPECT_EQ(one.centerline.back(), Point2(50.0, 1.75));
  EXPECT_NEAR(one.left_width.front().width, 1.75, 1e-9);
  EXPECT_NEAR(one.speed_limit, 50.0 / 3.6, 1e-9);
  EXPECT_THAT(one.successors, ElementsAre(on));
  EXPECT_THAT(one.right_neighbors, ElementsAre(right));
  EXPECT_THAT(one.left_neighbors, IsEmpty());
  EXPECT_EQ(one.left_paint[0].type, BoundaryType::kCurb);
  EXPECT_EQ(one.right_paint[0].type, BoundaryType::kDottedWhite);
  EXPECT_THAT(lane(map, right).left_neighbors, ElementsAre(left));
  EXPECT_THAT(lane(map, right).successors, IsEmpty());
  EXPECT_EQ(lane(map, right).right_paint[0].type, BoundaryType::kSolidWhite);
  EXPECT_NEAR(lane(map, right).right_width.front().width, 1.5, 1e-9);
  EXPECT_THAT(lane(map, on).predecessors, ElementsAre(left));
  EXPECT_EQ(lane(map, on).turn, LaneTurn::kLeftTurn);
}

// Ways run as they were drawn: a lanelet's own direction is told by left and right.
TEST_F(LaneletFile, BoundsMayRunEitherWay) {
  Osm osm;
  const int a0 = osm.node(0, 3.5), a1 = osm.node(50, 3.5), b0 = osm.node(0, 0), b1 = osm.node(50, 0);
  const int c0 = osm.node(0, -3.5), c1 = osm.node(50, -3.5);
  const int a = osm.way({a1, a0}), b = osm.way({b0, b1}), c = osm.way({c0, c1});
  const std::string east = osm.lanelet(b, c), west = osm.lanelet(b, a);
  const LaneletMap map = read(osm.text());
  EXPECT_EQ(lane(map, east).centerline.front(), Point2(0.0, -1.75));
  EXPECT_EQ(lane(map, west).centerline.front(), Point2(50.0, 1.75));
  EXPECT_THAT(lane(map, east).left_neighbors, IsEmpty());
  EXPECT_THAT(lane(map, east).left_reverse, ElementsAre(west));
  EXPECT_THAT(lane(map, west).left_reverse, ElementsAre(east));
}

TEST_F(LaneletFile, ALineThatMayBeCrossedFromOneSideOnly) {
  Osm osm;
  const int a0 = osm.node(0, 3.5), a1 = osm.node(50, 3.5), b0 = osm.node(0, 0), b1 = osm.node(50, 0);
  const int c0 = osm.node(0, -3.5), c1 = osm.node(50, -3.5);
  const int a = osm.way({a0, a1}), b = osm.way({b0, b1}, "line_thin", "dashed_solid"), c = osm.way({c0, c1});
  const std::string left = osm.lanelet(a, b), right = osm.lanelet(b, c);
  const LaneletMap map = read(osm.text());
  EXPECT_EQ(lane(map, left).right_paint[0].type, BoundaryType::kDottedWhite);
  EXPECT_EQ(lane(map, right).left_paint[0].type, BoundaryType::kSolidWhite);
}

TEST_F(LaneletFile, ARoadThatIsNotOneWayIsTwoLanes) {
  Osm osm;
  const int a0 = osm.node(0, 2), a1 = osm.node(50, 2), b0 = osm.node(0, -2), b1 = osm.node(50, -2);
  const std::string id = osm.lanelet(osm.way({a0, a1}), osm.way({b0, b1}), "<tag k='one_way' v='no'/>");
  const LaneletMap map = read(osm.text());
  ASSERT_EQ(map.graph.lanes.size(), 2u);
  EXPECT_EQ(lane(map, "-" + id).centerline.front(), Point2(50.0, 0.0));
}

TEST_F(LaneletFile, SpeedLimitsOfRegulatoryElements) {
  Osm osm;
  const int a0 = osm.node(0, 2), a1 = osm.node(50, 2), b0 = osm.node(0, -2), b1 = osm.node(50, -2);
  const int a = osm.way({a0, a1}), b = osm.way({b0, b1});
  osm.add(
      "<relation id='7'><tag k='type' v='regulatory_element'/><tag k='subtype' v='speed_limit'/>"
      "<tag k='sign_type' v='de274-60'/></relation>");
  osm.add(
      "<relation id='8'><tag k='type' v='regulatory_element'/><tag k='subtype' "
      "v='traffic_light'/></relation>");
  const std::string sign = osm.lanelet(a, b, "<member type='relation' ref='7' role='regulatory_element'/>");
  const std::string miles = osm.lanelet(a, b, "<tag k='speed_limit' v='30 mph'/>");
  const std::string odd = osm.lanelet(a, b, "<tag k='speed_limit' v='walk'/>");
  const LaneletMap map = read(osm.text());
  EXPECT_NEAR(lane(map, sign).speed_limit, 60.0 / 3.6, 1e-9);
  EXPECT_NEAR(lane(map, miles).speed_limit, 30.0 * 0.44704, 1e-9);
  EXPECT_EQ(lane(map, odd).speed_limit, 0.0);
  EXPECT_THAT(map.remarks,
              ElementsAre(HasSubstr("'traffic_light' is not read"), HasSubstr("'walk' is not understood")));
}

TEST_F(LaneletFile, WhatIsNotForCarsIsLeftOutAndNamed) {
  Osm osm;
  const int a0 = osm.node(0, 2), a1 = osm.node(50, 2), b0 = osm.node(0, -2), b1 = osm.node(50, -2);
  const int a = osm.way({a0, a1}), b = osm.way({b0, b1});
  osm.lanelet(a, b);
  osm.lanelet(a, b, "", "walkway");
  const LaneletMap map = read(osm.text());
  EXPECT_EQ(map.graph.lanes.size(), 1u);
  EXPECT_THAT(map.remarks, ElementsAre(HasSubstr("'walkway' is not for cars")));
}

TEST_F(LaneletFile, WithoutLocalCoordinatesTheEarthIsProjected) {
  const std::string text =
      "<osm><node id='1' lat='49.0' lon='8.40'/><node id='2' lat='49.0' lon='8.41'/>"
      "<node id='3' lat='48.99997' lon='8.40'/><node id='4' lat='48.99997' lon='8.41'/>"
      "<way id='5'><nd ref='1'/><nd ref='2'/></way><way id='6'><nd ref='3'/><nd ref='4'/></way>"
      "<relation id='9'><member type='way' ref='5' role='left'/><member type='way' ref='6' role='right'/>"
      "<tag k='type' v='lanelet'/></relation></osm>";
  GeoReference local;
  local.projection = Projection::kLocal;
  local.latitude = 49.0;
  local.longitude = 8.40;
  const LaneletMap map = read_lanelet_map(write("earth.osm", text), local);
  // A hundredth of a degree of longitude at 49 degrees: a * cos(phi) / sqrt(1 - e^2 sin^2(phi)).
  const double radius = 6378137.0 * std::cos(49.0 * kPi / 180.0) /
                        std::sqrt(1.0 - 0.00669437999014 * std::pow(std::sin(49.0 * kPi / 180.0), 2));
  EXPECT_NEAR(map.graph.lanes[0].centerline.back().x(), radius * 0.01 * kPi / 180.0, 0.01);
  EXPECT_NEAR(map.graph.lanes[0].left_width[0].width, 0.00003 * 111200.0 / 2.0, 0.01);
  const LaneletMap utm = read_lanelet_map(write("earth.osm", text), std::nullopt);
  EXPECT_GT(utm.graph.lanes[0].centerline[0].y(), 5e6);
}

TEST_F(LaneletFile, BadFilesAreSentences) {
  Osm osm;
  const int a0 = osm.node(0, 2), a1 = osm.node(50, 2), b0 = osm.node(0, -2), b1 = osm.node(50, -2);
  const int a = osm.way({a0, a1}), b = osm.way({b0, b1});
  osm.lanelet(a, b);
  const std::string good = osm.text();
  EXPECT_EQ(fault(good), "");
  EXPECT_THAT(fault(good.substr(0, good.size() / 2)), HasSubstr("is it cut off?"));
  EXPECT_THAT(fault("<gpx/>"), HasSubstr("is no OSM file"));
  EXPECT_THAT(fault("<osm/>"), HasSubstr("has no node"));
  Osm none;
  none.node(0, 0);
  EXPECT_THAT(fault(none.text()), HasSubstr("has no lanelet for cars"));
  Osm way;
  way.lanelet(way.way({way.node(0, 2), way.node(9, 2)}), 4711);
  EXPECT_THAT(fault(way.text()), HasSubstr("has way 4711, which is not in the file"));
  Osm node;
  node.node(0, 0);
  node.way({4711, 4712});
  EXPECT_THAT(fault(node.text()), HasSubstr("has node 4711, which is not in the file"));
  Osm bound;
  const int only = bound.way({bound.node(0, 2), bound.node(9, 2)});
  bound.add("<relation id='3'><member type='way' ref='" + std::to_string(only) +
            "' role='left'/><tag k='type' v='lanelet'/></relation>");
  EXPECT_THAT(fault(bound.text()), HasSubstr("lanelet 3 has no right bound"));
  EXPECT_THROW(read_lanelet_map(path("nothing.osm"), std::nullopt), std::runtime_error);
}

}  // namespace
}  // namespace relative_map::core
