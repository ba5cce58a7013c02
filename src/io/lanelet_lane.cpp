#include "lanelet_lane.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core::lanelet {

namespace {

constexpr double kSpacing = 5.0;  // [m] of a centerline's points, where neither bound has one nearer

void turn(Bound& bound) {
  std::reverse(bound.nodes.begin(), bound.nodes.end());
  std::reverse(bound.points.begin(), bound.points.end());
  bound.turned = !bound.turned;
}

/// The point at a share [0, 1] of a polyline's length.
Point2 at_share(const Polyline& points, double share) {
  double left = share * chord_length(points);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double chord = (points[i] - points[i - 1]).norm();
    if (left <= chord && chord > 0.0) return points[i - 1] + left / chord * (points[i] - points[i - 1]);
    left -= chord;
  }
  return points.back();
}

/// The shares of its length at which a polyline has vertices.
void add_shares(const Polyline& points, std::vector<double>& shares) {
  const double length = chord_length(points);
  double s = 0.0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    s += (points[i] - points[i - 1]).norm();
    shares.push_back(length > 0.0 ? s / length : 0.0);
  }
}

/// Signed area between a line and another beside it: positive where `right` lies on the right.
double area(const Polyline& left, const Polyline& right) {
  Polyline around(left.rbegin(), left.rend());
  around.insert(around.end(), right.begin(), right.end());
  double twice = 0.0;
  for (std::size_t i = 0; i < around.size(); ++i) {
    twice += cross(around[i] - around[0], around[(i + 1) % around.size()] - around[0]);
  }
  return twice / 2.0;
}

std::vector<PaintSpan> paint_of(const Bound& bound, bool is_left) {
  const std::string type = value(bound.tags, "type"), subtype = value(bound.tags, "subtype");
  const bool yellow = value(bound.tags, "color") == "yellow";
  const BoundaryType dotted = yellow ? BoundaryType::kDottedYellow : BoundaryType::kDottedWhite;
  const BoundaryType solid = yellow ? BoundaryType::kSolidYellow : BoundaryType::kSolidWhite;
  if (type == "curbstone" || type == "road_border" || type == "wall" || type == "fence" ||
      type == "guard_rail") {
    return {{0.0, BoundaryType::kCurb}};
  }
  if (type != "line_thin" && type != "line_thick") return {{0.0, BoundaryType::kUnknown}};
  if (subtype == "dashed") return {{0.0, dotted}};
  if (subtype == "solid") return {{0.0, solid}};
  if (subtype == "solid_solid") return {{0.0, yellow ? BoundaryType::kDoubleYellow : solid}};
  // Named from the way's left to its right; a lane sees what is on its own side first.
  const bool on_the_ways_left = is_left == bound.turned;
  if (subtype == "dashed_solid") return {{0.0, on_the_ways_left ? dotted : solid}};
  if (subtype == "solid_dashed") return {{0.0, on_the_ways_left ? solid : dotted}};
  return {{0.0, BoundaryType::kUnknown}};
}

GraphLane lane_of(const Lanelet& lanelet) {
  GraphLane lane;
  lane.id = lanelet.id;
  lane.speed_limit = lanelet.speed_limit;
  lane.turn = lanelet.turn;
  lane.left_paint = paint_of(lanelet.left, true);
  lane.right_paint = paint_of(lanelet.right, false);
  const Polyline &left = lanelet.left.points, &right = lanelet.right.points;
  std::vector<double> shares = {0.0, 1.0};
  add_shares(left, shares);
  add_shares(right, shares);
  const int chords =
      static_cast<int>(std::ceil(std::max(chord_length(left), chord_length(right)) / kSpacing));
  for (int i = 1; i < chords; ++i) shares.push_back(static_cast<double>(i) / chords);
  std::sort(shares.begin(), shares.end());
  double s = 0.0;
  for (const double share : shares) {
    const Point2 on_left = at_share(left, share), on_right = at_share(right, share);
    const Point2 middle = (on_left + on_right) / 2.0;
    if (!lane.centerline.empty()) {
      const double chord = (middle - lane.centerline.back()).norm();
      if (chord < 0.01 && share < 1.0) continue;
      s += chord;
    }
    lane.centerline.push_back(middle);
    lane.left_width.push_back({s, (on_left - middle).norm()});
    lane.right_width.push_back({s, (on_right - middle).norm()});
  }
  return lane;
}

}  // namespace

std::string value(const Tags& tags, const std::string& key) {
  const auto found = tags.find(key);
  return found == tags.end() ? "" : found->second;
}

void align(Lanelet& lanelet) {
  Polyline &left = lanelet.left.points, &right = lanelet.right.points;
  const double straight = (left.front() - right.front()).norm() + (left.back() - right.back()).norm();
  const double crossed = (left.front() - right.back()).norm() + (left.back() - right.front()).norm();
  if (crossed < straight) turn(lanelet.right);
  if (area(left, right) < 0.0) {
    turn(lanelet.left);
    turn(lanelet.right);
  }
}

Lanelet reversed(const Lanelet& lanelet) {
  Lanelet back = lanelet;
  back.id = "-" + lanelet.id;
  std::swap(back.left, back.right);
  turn(back.left);
  turn(back.right);
  if (lanelet.turn == LaneTurn::kLeftTurn) back.turn = LaneTurn::kRightTurn;
  if (lanelet.turn == LaneTurn::kRightTurn) back.turn = LaneTurn::kLeftTurn;
  return back;
}

std::vector<GraphLane> lanes_of(const std::vector<Lanelet>& lanelets) {
  std::vector<GraphLane> lanes;
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> by_start;
  std::map<std::string, std::vector<std::size_t>> by_left, by_right;
  for (std::size_t i = 0; i < lanelets.size(); ++i) {
    lanes.push_back(lane_of(lanelets[i]));
    by_start[{lanelets[i].left.nodes.front(), lanelets[i].right.nodes.front()}].push_back(i);
    by_left[lanelets[i].left.id].push_back(i);
    by_right[lanelets[i].right.id].push_back(i);
  }
  for (std::size_t i = 0; i < lanelets.size(); ++i) {
    const Lanelet& own = lanelets[i];
    const auto next = by_start.find({own.left.nodes.back(), own.right.nodes.back()});
    if (next != by_start.end()) {
      for (const std::size_t k : next->second) {
        lanes[i].successors.push_back(lanelets[k].id);
        lanes[k].predecessors.push_back(own.id);
      }
    }
    for (const std::size_t k : by_right[own.left.id]) {
      if (k != i && lanelets[k].right.turned == own.left.turned)
        lanes[i].left_neighbors.push_back(lanelets[k].id);
    }
    for (const std::size_t k : by_left[own.right.id]) {
      if (k != i && lanelets[k].left.turned == own.right.turned)
        lanes[i].right_neighbors.push_back(lanelets[k].id);
    }
    for (const std::size_t k : by_left[own.left.id]) {
      if (k != i && lanelets[k].left.turned != own.left.turned)
        lanes[i].left_reverse.push_back(lanelets[k].id);
    }
    for (const std::size_t k : by_right[own.right.id]) {
      if (k != i && lanelets[k].right.turned != own.right.turned)
        lanes[i].right_reverse.push_back(lanelets[k].id);
    }
  }
  return lanes;
}

}  // namespace relative_map::core::lanelet
