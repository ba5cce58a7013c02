#include "relative_map/pipeline/lanes/lane_width.hpp"

#include <algorithm>
#include <cmath>

#include "own_border.hpp"

namespace relative_map::core {

namespace {

constexpr double kForgetLength = 50.0;  // [m] past the paint over which a shared border goes to the middle
constexpr double kLeastShare = 0.3;     // of the spacing, for each of two neighbours
constexpr double kBlendLength = 10.0;   // [m] over which a border leaves the midline where the neighbour ends
constexpr double kJoinGap = 0.1;        // [m] nearer to the shared part no point is added
constexpr double kEndShare = 2.0;       // of the spacing a vertex before, at the end of a lane
constexpr double kLeastSideways = 0.3;  // of the spacing
constexpr double kSameBorder = 0.01;    // [m] apart that two borders may be and still be one
constexpr double kAlmostSquare = 0.1;   // [rad] past its end the other lane still counts as beside

/// What lies beside one vertex of a lane.
struct Beside {
  bool exists = false;   ///< false: the other lane does not reach here
  Point2 point;          ///< of the other centerline
  double spacing = 0.0;  ///< [m]
  double s = 0.0;        ///< [m] along the other centerline
  bool to_right = true;  ///< false: it lies ahead, behind or to the left
};

/// Of stretches on which the other lane seems to lie beside, only the one where it is nearest: where a road
/// bends back, the end of a lane that ended long before is beside it once more, at any distance.
void keep_nearest_stretch(std::vector<Beside>& beside) {
  std::size_t nearest = beside.size();
  for (std::size_t i = 0; i < beside.size(); ++i) {
    if (beside[i].exists && (nearest == beside.size() || beside[i].spacing < beside[nearest].spacing))
      nearest = i;
  }
  if (nearest == beside.size()) return;
  bool connected = true;
  for (std::size_t i = nearest; i < beside.size(); ++i)
    beside[i].exists = connected = connected && beside[i].exists;
  connected = true;
  for (std::size_t i = nearest + 1; i-- > 0;) beside[i].exists = connected = connected && beside[i].exists;
}

std::vector<Beside> look_beside(const LanePath& lane, const LanePath& other) {
  const Polyline centerline = positions_of(other.points);
  PolylineWalker walker(centerline);
  std::vector<Beside> result;
  result.reserve(lane.points.size());
  for (const PathPoint& vertex : lane.points) {
    const Foot foot = walker.next(vertex.position);
    const double spacing = std::sqrt(foot.squared_distance);
    const double start = other.points[foot.segment].s, end = other.points[foot.segment + 1].s;
    const double to_left = cross(vertex.direction, foot.point - vertex.position);
    result.push_back({true, foot.point, spacing, start + foot.fraction * (end - start),
                      to_left < -kLeastSideways * spacing});
    if (walker.beyond_end(foot)) {
      const PathPoint& end_vertex = foot.fraction < 0.5 ? other.points.front() : other.points.back();
      const double past_end = std::abs(end_vertex.direction.dot(vertex.position - foot.point));
      result.back().exists = past_end < kAlmostSquare * spacing;
    }
  }
  keep_nearest_stretch(result);
  return result;
}

/// Where a neighbour has ended, the border swings from the midline to the lane's own half width.
double half_width_past_neighbor(double own, double at_neighbor, double distance) {
  const double t = std::min(1.0, distance / kBlendLength);
  return at_neighbor + (own - at_neighbor) * t * t * (3.0 - 2.0 * t);
}

/// The stretch of a lane's vertices that have the other lane beside them: [first, last].
struct Stretch {
  std::size_t first = 0, last = 0;
};

std::optional<Stretch> stretch_beside(const std::vector<Beside>& beside) {
  std::optional<Stretch> stretch;
  for (std::size_t i = 0; i < beside.size(); ++i) {
    if (!beside[i].exists) continue;
    if (!stretch) stretch = Stretch{i, i};
    stretch->last = i;
  }
  return stretch;
}

/// Whether a lane and the one to its right are neighbours: beside each other on more than one vertex, nowhere
/// too far apart, and on these sides all along.
bool share_border(const std::vector<Beside>& beside, const std::optional<Stretch>& stretch,
                  double max_spacing) {
  return stretch && stretch->first < stretch->last &&
         std::all_of(beside.begin(), beside.end(), [max_spacing](const Beside& other) {
           return !other.exists || (other.to_right && other.spacing <= max_spacing);
         });
}

/// A point of the border that two lanes share, and the places beside it.
struct Middle {
  Point2 point;
  double left_width, right_width;  ///< [m] of it from the left and the right lane's centerline
  double left_s, right_s;          ///< [m] along the lanes
};

/// 1 where paint was seen, to 0 some way past it.
double seen_share(const SeenHalfWidths& seen, double s) {
  const double t = std::clamp((s - seen.to) / kForgetLength, 0.0, 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

/// [m] The shared border's distance from the left lane: where paint was seen, else half way to the right one.
double width_of_left(const LanePath& left, const LanePath& right, double spacing, double left_s,
                     double right_s) {
  const double middle = 0.5 * spacing;
  double width = middle;
  if (left.seen && left.seen->right) width += seen_share(*left.seen, left_s) * (*left.seen->right - middle);
  if (right.seen && right.seen->left)
    width -= seen_share(*right.seen, right_s) * (*right.seen->left - middle);
  return std::clamp(width, kLeastShare * spacing, (1.0 - kLeastShare) * spacing);
}

Middle middle_between(const LanePath& left, const Point2& on_left, double left_s, const LanePath& right,
                      const Point2& on_right, double right_s) {
  const double spacing = (on_right - on_left).norm();
  const double width = width_of_left(left, right, spacing, left_s, right_s);
  const double share = spacing > 0.0 ? width / spacing : 0.5;
  return {on_left + share * (on_right - on_left), width, spacing - width, left_s, right_s};
}

/// Beside an end of the right lane; none: the left lane does not reach there. `near` is a segment close by.
std::optional<Middle> middle_at_end(const LanePath& left, const LanePath& right, const PathPoint& end,
                                    std::size_t near) {
  const Polyline centerline = positions_of(left.points);
  PolylineWalker walker(centerline, std::min(near, centerline.size() - 2));
  const Foot foot = walker.next(end.position);
  if (walker.beyond_end(foot)) return std::nullopt;
  const double before = left.points[foot.segment].s, after = left.points[foot.segment + 1].s;
  return middle_between(left, foot.point, before + foot.fraction * (after - before), right, end.position,
                        end.s);
}

/// The border between two lanes, as far as both reach.
std::vector<Middle> midline(const LanePath& left, const LanePath& right, const std::vector<Beside>& beside,
                            const Stretch& stretch) {
  std::vector<Middle> line;
  line.reserve(stretch.last - stretch.first + 3);
  for (std::size_t i = stretch.first; i <= stretch.last; ++i) {
    const PathPoint& vertex = left.points[i];
    line.push_back(middle_between(left, vertex.position, vertex.s, right, beside[i].point, beside[i].s));
  }
  // Where the right lane starts or ends between two vertices of the left one, so does the shared border. Far
  // from its last point it does not: there the right lane is beside the left one by chance.
  const auto near = [](const Middle& end, const Middle& known) {
    return end.left_width + end.right_width <= kEndShare * (known.left_width + known.right_width);
  };
  const auto start = middle_at_end(left, right, right.points.front(), stretch.first);
  if (start && near(*start, line.front())) {
    line.front().right_s = start->right_s;
    if (start->left_s < line.front().left_s - kJoinGap) line.insert(line.begin(), *start);
  }
  const auto end = middle_at_end(left, right, right.points.back(), stretch.last);
  if (end && near(*end, line.back())) {
    line.back().right_s = end->right_s;
    if (end->left_s > line.back().left_s + kJoinGap) line.push_back(*end);
  }
  return line;
}

/// The midline, prolonged to the ends of one of its lanes. `own` [m] is that lane's half width; `s_of` tells
/// where along that lane a point of the midline is.
template <class PlaceAlong>
Polyline prolonged(const std::vector<Middle>& midline, const LanePath& lane, double own, Side side,
                   PlaceAlong s_of) {
  const Middle &first = midline.front(), &last = midline.back();
  Polyline border;
  border.reserve(lane.points.size() + 2);
  const auto add_beyond = [&](std::size_t i, const Middle& end) {
    const double distance = std::abs(lane.points[i].s - s_of(end));
    const double width =
        half_width_past_neighbor(own, side == Side::kRight ? end.left_width : end.right_width, distance);
    border.push_back(border_point(lane.points, i, width, side));
  };
  for (std::size_t i = 0; i < lane.points.size() && lane.points[i].s < s_of(first) - kJoinGap; ++i) {
    add_beyond(i, first);
  }
  for (const Middle& middle : midline) border.push_back(middle.point);
  for (std::size_t i = 0; i < lane.points.size(); ++i) {
    if (lane.points[i].s > s_of(last) + kJoinGap) add_beyond(i, last);
  }
  return border;
}

}  // namespace

LaneBorders find_borders(const std::vector<LanePath>& lanes, double max_half_width) {
  const std::size_t n = lanes.size();
  LaneBorders borders{std::vector<Polyline>(n), std::vector<Polyline>(n), std::vector<bool>(n, false)};
  borders.left[0] = own_border(lanes[0], nullptr, lanes[0].left_half_width, Side::kLeft);
  borders.right[n - 1] = own_border(lanes[n - 1], nullptr, lanes[n - 1].right_half_width, Side::kRight);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const LanePath &left = lanes[i], &right = lanes[i + 1];
    const std::vector<Beside> beside = look_beside(left, right);
    const std::optional<Stretch> stretch = stretch_beside(beside);
    if (share_border(beside, stretch, 2.0 * max_half_width)) {
      const std::vector<Middle> middle = midline(left, right, beside, *stretch);
      borders.right[i] = prolonged(middle, left, left.right_half_width, Side::kRight,
                                   [](const Middle& point) { return point.left_s; });
      borders.left[i + 1] = prolonged(middle, right, right.left_half_width, Side::kLeft,
                                      [](const Middle& point) { return point.right_s; });
      // Lines that fold beside each other, as no lanes do, have no border between them.
      borders.left_is_shared[i + 1] = widest_gap(borders.right[i], borders.left[i + 1]).width <= kSameBorder;
    }
    if (!borders.left_is_shared[i + 1]) {
      borders.right[i] = own_border(left, &right, left.right_half_width, Side::kRight);
      borders.left[i + 1] = own_border(right, &left, right.left_half_width, Side::kLeft);
    }
  }
  return borders;
}

}  // namespace relative_map::core
