// Routes on random graphs, against a model of the same rules that is slow and plain; and drives that no
// planner should see.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "relative_map/route/route_check.hpp"
#include "relative_map/route/route_map.hpp"
#include "relative_map/route/route_search.hpp"
#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

/// Rows of lanes side by side that start and end at the same x: what is driven on one of them is a matter of
/// its row and x alone, and so can be told without following any link.
struct Rows {
  std::vector<double> joints;  // [m] x
  int rows = 0;
  LaneGraph graph;

  std::string id(int row, std::size_t column) const {
    return std::to_string(row) + "/" + std::to_string(column);
  }
  double y(int row) const { return -3.5 * row; }
  std::size_t column(double x) const {
    return static_cast<std::size_t>(std::upper_bound(joints.begin() + 1, joints.end() - 1, x) -
                                    joints.begin()) -
           1;
  }
};

Rows random_rows(std::mt19937& random) {
  Rows rows;
  rows.rows = std::uniform_int_distribution<int>(1, 4)(random);
  const int columns = std::uniform_int_distribution<int>(2, 9)(random);
  rows.joints = {0.0};
  for (int i = 0; i < columns; ++i) {
    rows.joints.push_back(rows.joints.back() + std::uniform_real_distribution<double>(8.0, 160.0)(random));
  }
  for (int row = 0; row < rows.rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Point2 from(rows.joints[column], rows.y(row)), to(rows.joints[column + 1], rows.y(row));
      // Some of one chord, some of many.
      const bool one = std::bernoulli_distribution(0.3)(random);
      rows.graph.lanes.push_back(
          test::make_lane(rows.id(row, column), one ? Polyline{from, to} : test::straight(from, to)));
    }
  }
  for (int row = 0; row < rows.rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (column > 0) test::follow(rows.graph, rows.id(row, column - 1), rows.id(row, column));
      if (row > 0) test::neighbors(rows.graph, rows.id(row - 1, column), rows.id(row, column));
    }
  }
  std::shuffle(rows.graph.lanes.begin(), rows.graph.lanes.end(), random);
  return rows;
}

/// What is driven on a row: as a list of pieces, looked up metre by metre but for its ends.
std::vector<LaneSegment> plain_line(const Rows& rows, int row, double x, int end_row, double end_x) {
  const double first = std::max(0.0, x - 50.0);
  double last = std::min(rows.joints.back(), x + 180.0);
  if (row == end_row) last = std::min(last, end_x);
  std::vector<LaneSegment> pieces;
  for (std::size_t column = 0; column + 1 < rows.joints.size(); ++column) {
    const double from = std::max(first, rows.joints[column]), to = std::min(last, rows.joints[column + 1]);
    if (to - from > 1e-9)
      pieces.push_back({rows.id(row, column), from - rows.joints[column], to - rows.joints[column]});
  }
  return pieces;
}

void expect_same(const std::vector<LaneSegment>& wanted, const RouteSegments& told,
                 const std::string& where) {
  ASSERT_EQ(told.segments.size(), wanted.size()) << where;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(told.segments[i].lane_id, wanted[i].lane_id) << where;
    EXPECT_NEAR(told.segments[i].start_s, wanted[i].start_s, 1e-6) << where;
    EXPECT_NEAR(told.segments[i].end_s, wanted[i].end_s, 1e-6) << where;
  }
}

std::string text(const Route& route) {
  std::string all;
  for (const RouteRoad& road : route.roads) {
    all += "|";
    for (const Passage& passage : road.passages) {
      all += passage.can_exit ? " X" : passage.change_lane == ChangeLane::kLeft ? " L" : " R";
      for (const LaneSegment& segment : passage.segments) all += " " + segment.lane_id;
    }
  }
  return all;
}

TEST(RouteProperty, OnRandomGraphsTheSameIsToldAsByAPlainModel) {
  std::size_t poses = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937 random(seed);
    const Rows rows = random_rows(random);
    const auto network = test::prepared(rows.graph);
    const auto any_row = [&] { return std::uniform_int_distribution<int>(0, rows.rows - 1)(random); };
    const auto any_x = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const double road = rows.joints.back();
    const int start_row = any_row(), end_row = any_row();
    const double start_x = any_x(0.0, 0.3 * road), end_x = any_x(0.7 * road, road);
    const auto place = [&](int row, double x) {
      return LanePosition{rows.id(row, rows.column(x)), x - rows.joints[rows.column(x)]};
    };
    const SearchResult found =
        RouteSearch(network, SearchParam{}).find({{place(start_row, start_x), place(end_row, end_x)}, {}});
    ASSERT_TRUE(found.route) << seed << ": " << found.why_not;
    EXPECT_NEAR(found.route->distance, end_x - start_x, 1e-6) << seed << text(*found.route);
    RouteMap map{RouteParam{}};
    map.set_graph(network);
    const RouteStatus status = map.set_route(*found.route);
    ASSERT_EQ(status.code, RouteCode::kOk) << seed << ": " << status.message << text(*found.route);
    ASSERT_TRUE(map.repairs().empty()) << seed << ": " << map.repairs()[0] << text(*found.route);

    // Wherever the vehicle is put on a lane that the route has, forwards, backwards, or far off.
    for (int i = 0; i < 20; ++i) {
      const double x = any_x(start_x, end_x);
      const int row = any_row();
      const auto lane = network->find(rows.id(row, rows.column(x)));
      // No other row may be as near, and no joint: there two answers are right.
      const double l = any_x(-1.6, 1.6);
      const RouteUpdate update = map.update(Pose2({x, rows.y(row) + l}, any_x(-0.5, 0.5)), 10.0);
      for (const RouteViolation& violation : check_route(update, map.index())) {
        ADD_FAILURE() << seed << ": " << violation.row << ": " << violation.what << text(*found.route);
      }
      if (map.index()->pieces_on(*lane).empty()) continue;
      const std::string where = "seed " + std::to_string(seed) + ", row " + std::to_string(row) + ", x " +
                                std::to_string(x) + text(*found.route);
      const auto& pieces = map.index()->pieces_on(*lane);
      const bool on_piece = std::any_of(pieces.begin(), pieces.end(), [&](std::size_t piece) {
        const double s = x - rows.joints[rows.column(x)];
        return s >= map.index()->pieces()[piece].start && s <= map.index()->pieces()[piece].end;
      });
      if (!on_piece) continue;
      ++poses;
      ASSERT_TRUE(update.place) << where << ": " << update.status.message;
      EXPECT_EQ(update.place->lane_id, rows.id(row, rows.column(x))) << where;
      EXPECT_NEAR(update.place->s, x - rows.joints[rows.column(x)], 1e-6) << where;
      EXPECT_NEAR(update.place->l, l, 1e-6) << where;
      EXPECT_NEAR(update.place->distance_to_destination, end_x - x, 1e-6) << where;
      expect_same(plain_line(rows, row, x, end_row, end_x), update.segments.at(0), where);
      // A lane change leads one row nearer to where the route ends.
      const int nearer = row + (end_row > row ? 1 : -1);
      if (update.segments.size() > 1) {
        ASSERT_NE(row, end_row) << where;
        EXPECT_EQ(update.segments[0].next_action, end_row > row ? ChangeLane::kRight : ChangeLane::kLeft)
            << where;
        EXPECT_EQ(update.segments[1].previous_action, update.segments[0].next_action) << where;
        expect_same(plain_line(rows, nearer, x, end_row, end_x), update.segments[1], where);
      } else if (row != end_row && !update.segments[0].can_exit) {
        // Only where the row that it leads to is not there yet, or not any more.
        const auto beside = network->find(rows.id(nearer, rows.column(x)));
        EXPECT_TRUE(map.index()->pieces_on(*beside).empty()) << where;
      }
    }
  }
  EXPECT_GT(poses, 5000u);
}

TEST(RouteProperty, NoDriveBreaksTheContractOrMeetsSilence) {
  const LaneGraph graphs[] = {test::grid(3, 4), test::ring(4, 50.0), test::ring(1, 40.0)};
  std::vector<std::shared_ptr<const LaneNetwork>> networks;
  for (const LaneGraph& graph : graphs) networks.push_back(test::prepared(graph));
  std::size_t on_route = 0, told_why = 0;
  for (unsigned seed = 0; seed < 10000; ++seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto& network = networks[seed % networks.size()];
    const auto any_lane = [&] {
      return std::uniform_int_distribution<std::size_t>(0, network->size() - 1)(random);
    };
    std::size_t lane = any_lane();
    const std::size_t goal = any_lane();
    double s = uniform(0.0, network->lane(lane).length());
    const SearchResult found =
        RouteSearch(network, SearchParam{})
            .find({{{network->lane(lane).source.id, s},
                    {network->lane(goal).source.id, uniform(0.0, network->lane(goal).length())}},
                   {}});
    if (!found.route) continue;
    RouteMap map{RouteParam{}};
    map.set_graph(network);
    const RouteStatus status = map.set_route(*found.route);
    ASSERT_EQ(status.code, RouteCode::kOk) << seed << ": " << status.message << text(*found.route);
    for (int step = 0; step < 20; ++step) {
      const double chance = uniform(0.0, 1.0);
      std::optional<Pose2> pose;
      s += chance < 0.2 ? -uniform(0.0, 4.0) : uniform(0.0, 20.0);
      while (s > network->lane(lane).length() && !network->lane(lane).successors.empty()) {
        s -= network->lane(lane).length();
        lane = network->lane(lane).successors.front();
      }
      if (chance > 0.95) lane = any_lane();  // a jump
      const LaneLine& line = network->lane(lane).line;
      const double heading = line.heading_at(s) + (chance > 0.9 && chance < 0.93 ? kPi : uniform(-0.4, 0.4));
      const double l = chance > 0.85 && chance < 0.9 ? uniform(-60.0, 60.0) : uniform(-2.0, 2.0);
      pose = Pose2(line.point_at(s) + l * Point2(-std::sin(heading), std::cos(heading)),
                   normalize_angle(heading));
      if (chance > 0.8 && chance < 0.82) pose.reset();
      if (chance > 0.82 && chance < 0.83) pose = Pose2({std::nan(""), 0.0}, 0.0);
      const RouteUpdate update = map.update(pose, uniform(-5.0, 60.0));
      for (const RouteViolation& violation : check_route(update, map.index())) {
        ADD_FAILURE() << seed << ", step " << step << ": " << violation.row << ": " << violation.what;
      }
      if (update.segments.empty()) {
        ASSERT_FALSE(update.status.message.empty()) << seed;
        ++told_why;
      } else {
        ++on_route;
      }
    }
  }
  EXPECT_GT(on_route, 50000u);
  EXPECT_GT(told_why, 5000u);
}

}  // namespace
}  // namespace relative_map::core
