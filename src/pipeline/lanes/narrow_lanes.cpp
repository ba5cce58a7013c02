#include "relative_map/pipeline/lanes/narrow_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr double kSearchStep = 1.0;  // [m] between the places where narrowness is looked for
constexpr double kShortestLane =
    30.0;                           // [m] ahead of the vehicle; what is left of a lane must be worth a change
constexpr double kOtherRoad = 0.5;  // [rad] beside the vehicle: more than any ramp that leaves or joins
constexpr double kCrossing = 0.35;  // [rad] where they meet: more than lanes that become one

/// A place of a lane beside a better one.
struct Place {
  double s = 0.0;         ///< [m] along the lane
  Point2 along, better;   ///< directions of the two
  bool beside = false;    ///< false: past an end of the better one
  double distance = 0.0;  ///< [m] between the two

  /// [rad] of the lane from the better one.
  double turned() const { return std::atan2(cross(better, along), better.dot(along)); }
};

/// The better lane, to be looked at from others.
class BetterLane {
 public:
  explicit BetterLane(const LanePath& lane) : centerline_(positions_of(lane.points)), id_(lane.id) {}

  const std::string& id() const { return id_; }
  /// Arc length at which `lane` first comes nearer than `spacing` [m]; none: it never does.
  std::optional<Place> first_nearer_place(const LanePath& lane, double spacing) const {
    PolylineWalker walker(centerline_, nearest_segment(lane.points.front().position));
    const double step = std::min(kSearchStep, 0.5 * spacing);
    double s = 0.0;
    std::size_t last = 0;
    for (std::size_t i = 0; i + 1 < lane.points.size(); ++i) {
      while (s < lane.points[i + 1].s) {
        const Place place = look(walker, lane, i, s, std::max<std::size_t>(1, i - last));
        last = i;
        // Past an end of the better one the lane may be what it goes on as.
        if (place.distance < spacing && (place.beside || std::abs(place.turned()) > kCrossing)) return place;
        s += std::max(step, place.distance - spacing);  // it comes no nearer by more than the way between
      }
    }
    return std::nullopt;
  }
  /// Where the vehicle is beside `lane`, or where that begins or ends.
  Place beside_vehicle(const LanePath& lane) const {
    const double s = std::clamp(lane.s_at_vehicle, 0.0, lane.points.back().s);
    std::size_t i = 0;
    while (i + 2 < lane.points.size() && lane.points[i + 1].s <= s) ++i;
    PolylineWalker walker(centerline_, nearest_segment(lane.points[i].position));
    return look(walker, lane, i, s, 1);
  }

 private:
  std::size_t nearest_segment(const Point2& point) const {
    const auto nearest =
        std::min_element(centerline_.begin(), centerline_.end(), [&](const Point2& a, const Point2& b) {
          return (a - point).squaredNorm() < (b - point).squaredNorm();
        });
    return std::min(static_cast<std::size_t>(nearest - centerline_.begin()), centerline_.size() - 2);
  }
  Place look(PolylineWalker& walker, const LanePath& lane, std::size_t i, double s, std::size_t steps) const {
    const PathPoint &a = lane.points[i], &b = lane.points[i + 1];
    const Point2 along = b.position - a.position;
    const Foot foot = walker.next(a.position + (s - a.s) / (b.s - a.s) * along, steps);
    const Point2 other = centerline_[foot.segment + 1] - centerline_[foot.segment];
    return {s, along, other, !walker.beyond_end(foot), std::sqrt(foot.squared_distance)};
  }

  Polyline centerline_;
  std::string id_;
};

template <class... Parts>
std::string sentence(const LanePath& lane, const Parts&... parts) {
  std::ostringstream text;
  text.precision(3);
  text << "line '" << lane.id << "' ";
  (text << ... << parts);
  return text.str();
}

double degrees(double angle) {
  return std::abs(angle) * 180.0 / kPi;
}

/// Whether a lane has room beside a better one; else it is cut short, or there is none at all. What it loses
/// is told in `sentences`.
bool has_room(LanePath& lane, const BetterLane& better, double half_width,
              std::vector<std::string>& sentences) {
  const std::optional<Place> narrow = better.first_nearer_place(lane, 2.0 * half_width);
  if (!narrow) return true;
  const double ahead = std::max(0.0, narrow->s - lane.s_at_vehicle);
  if (std::abs(narrow->turned()) > kCrossing) {
    sentences.push_back(sentence(lane, "is left out: ", ahead, " m ahead it crosses '", better.id(), "', by ",
                                 degrees(narrow->turned()), " degrees"));
    return false;
  }
  const bool cut = cut_short(lane, narrow->s);
  sentences.push_back(sentence(lane, cut ? "is cut short: " : "is left out: ", ahead,
                               " m ahead it comes so near to '", better.id(),
                               "' that the vehicle does not fit"));
  return cut;
}

}  // namespace

bool cut_short(LanePath& lane, double s) {
  const auto end = std::find_if(lane.points.begin(), lane.points.end(),
                                [s](const PathPoint& point) { return point.s >= s; });
  if (end - lane.points.begin() < 2 || (end - 1)->s - lane.s_at_vehicle < kShortestLane) return false;
  lane.points.erase(end, lane.points.end());
  lane.remaining = lane.points.back().s - lane.s_at_vehicle;
  return true;
}

std::vector<std::string> make_room(std::vector<LanePath>& lanes, std::size_t& current, double half_width) {
  std::vector<std::string> sentences;
  std::swap(lanes.front(), lanes[current]);
  std::sort(lanes.begin() + 1, lanes.end(),
            [](const LanePath& a, const LanePath& b) { return a.priority < b.priority; });
  std::vector<BetterLane> better;  // of those that stay
  std::vector<LanePath> kept;
  for (LanePath& lane : lanes) {
    bool stays = true;
    if (!better.empty()) {
      const Place beside = better.front().beside_vehicle(lane);
      stays = !beside.beside || std::abs(beside.turned()) <= kOtherRoad;
      if (!stays)
        sentences.push_back(sentence(lane, "is left out: it is another road's, ", degrees(beside.turned()),
                                     " degrees aside of '", better.front().id(), "'"));
    }
    for (const BetterLane& other : better) stays = stays && has_room(lane, other, half_width, sentences);
    if (!stays) continue;
    better.emplace_back(lane);
    kept.push_back(std::move(lane));
  }
  lanes = std::move(kept);
  current = 0;
  sort_left_to_right(lanes, current);
  return sentences;
}

}  // namespace relative_map::core
