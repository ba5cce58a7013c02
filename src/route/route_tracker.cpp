#include "relative_map/route/route_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

namespace relative_map::core {

namespace {

constexpr double kEquallyNear = 1e-3;  // [m] poses come rounded to a tenth of it
constexpr double kReachScale = 1.5;    // of the straight way since the last pose: the road may bend,
constexpr double kReachSlack = 5.0;    // [m] and poses are not exact
// [m] that a place which could not have been driven to must be nearer: about a lane. Less is a crossing, more
// a jump.
constexpr double kJump = 3.0;
constexpr double kSetOff = 3.0;  // [m] before its start a vehicle that sets off may stand

}  // namespace

RouteTracker::RouteTracker(std::shared_ptr<const RouteIndex> index, const RouteParam& param)
    : index_(std::move(index)), param_(param) {}

std::vector<RouteTracker::Candidate> RouteTracker::candidates(const Pose2& pose, bool& wrong_way) const {
  std::vector<Candidate> found;
  for (const std::size_t lane : index_->network().lanes_near(pose.position(), param_.max_distance)) {
    const std::vector<std::size_t>& pieces = index_->pieces_on(lane);
    if (pieces.empty()) continue;
    const LaneLine& line = index_->network().lane(lane).line;
    for (const LaneProjection& projection : line.passes(pose.position(), param_.max_distance)) {
      const bool against =
          std::abs(angle_difference(projection.heading, pose.heading())) > param_.max_heading;
      for (const std::size_t piece : pieces) {
        const RoutePiece& part = index_->pieces()[piece];
        const double on_lane = std::clamp(projection.s, 0.0, line.length());
        const double gap = std::max({0.0, part.start - on_lane, on_lane - part.end});
        if (std::hypot(projection.distance, gap) > param_.max_distance) continue;
        wrong_way = wrong_way || against;
        if (!against) found.push_back({piece, projection, gap, std::nullopt});
      }
    }
  }
  return found;
}

/// Walks along the route both ways from the last place, and over to passages beside it, as far as the vehicle
/// may have come, and notes for each candidate how far it is.
void RouteTracker::measure_driven(std::vector<Candidate>& candidates, double reach) const {
  if (!last_) return;
  std::map<std::size_t, std::pair<double, double>>
      starts;  // piece: [m] from the last place to its start, scale
  const auto& pieces = index_->pieces();
  const auto visit = [&](std::size_t piece, double start) {
    const double length = index_->lane_of(piece).length();
    starts.emplace(piece, std::make_pair(start, 1.0));
    // And over to all that lies beside it, by the same share of the lanes.
    for (std::vector<std::size_t> open = {piece}; !open.empty();) {
      const std::size_t from = open.back();
      open.pop_back();
      for (const std::size_t other : index_->beside(from)) {
        const double scale = length / index_->lane_of(other).length();
        const double other_start = start + pieces[other].start * scale - pieces[piece].start;
        if (starts.emplace(other, std::make_pair(other_start, scale)).second) open.push_back(other);
      }
    }
  };
  double start = pieces[last_->piece].start - last_->s;
  std::optional<std::size_t> piece = last_->piece;
  for (double at = start; piece && at <= reach; piece = index_->next(*piece)) {
    visit(*piece, at);
    at += pieces[*piece].end - pieces[*piece].start;
  }
  piece = index_->previous(last_->piece);
  for (double at = start; piece && at >= -reach; piece = index_->previous(*piece)) {
    at -= pieces[*piece].end - pieces[*piece].start;
    visit(*piece, at);
  }
  for (Candidate& candidate : candidates) {
    const auto found = starts.find(candidate.piece);
    if (found == starts.end()) continue;
    const RoutePiece& part = pieces[candidate.piece];
    const double s = std::clamp(candidate.projection.s, part.start, part.end);
    const double driven = found->second.first + (s - part.start) * found->second.second;
    if (std::abs(driven) <= reach) candidate.driven = driven;
  }
}

/// [m] How near a candidate is. What is past the end of a piece is not on it, but for the route's own ends:
/// there the vehicle stops a little late, or sets off a little early.
double RouteTracker::cost(const Candidate& candidate) const {
  const RoutePiece& piece = index_->pieces()[candidate.piece];
  const double at = std::clamp(candidate.projection.s, 0.0, index_->lane_of(candidate.piece).length());
  const bool arrived = candidate.driven && index_->leads_to_destination(candidate.piece) &&
                       !index_->next(candidate.piece) && at > piece.end;
  const bool sets_off = !last_ && candidate.piece == 0 && candidate.gap <= kSetOff && at < piece.start;
  return candidate.projection.distance + (arrived || sets_off ? 0.0 : candidate.gap);
}

/// Whether the vehicle has left a piece for the next one: past its end, and not before the start of the
/// other.
bool RouteTracker::beside_next(const Candidate& piece, const Candidate& next) const {
  return piece.projection.s > index_->lane_of(piece.piece).length() + kEquallyNear &&
         next.projection.s > -kEquallyNear;
}

/// Whether `a` comes before `b`, where both could have been driven to or neither could.
bool RouteTracker::better(const Candidate& a, const Candidate& b, double moved) const {
  const double cost_a = cost(a), cost_b = cost(b);
  if (std::abs(cost_a - cost_b) > kEquallyNear) return cost_a < cost_b;
  // Where one piece ends and the next one starts, the vehicle is on the first until it is beside the second.
  const auto ends_here = [&](const Candidate& first, const Candidate& second) {
    return index_->next(first.piece) == second.piece && first.piece != second.piece;
  };
  if (ends_here(a, b)) return !beside_next(a, b);
  if (ends_here(b, a)) return beside_next(b, a);
  if (!last_) return a.piece < b.piece;  // the first time around
  // A waypoint that is still to come is not passed by being on another passage of the same lane.
  const std::size_t next = index_->next_waypoint(*last_);
  const auto missed = [&](const Candidate& candidate) {
    const std::size_t waypoint = index_->next_waypoint({candidate.piece, candidate.projection.s});
    const bool by_driving =
        index_->pieces()[candidate.piece].passage == index_->pieces()[last_->piece].passage;
    return !by_driving && waypoint > next;
  };
  if (missed(a) != missed(b)) return missed(b);
  if (!a.driven) {
    const auto away = [&](const Candidate& candidate) {
      return std::max(candidate.piece, last_->piece) - std::min(candidate.piece, last_->piece);
    };
    return away(a) != away(b) ? away(a) < away(b) : a.piece > b.piece;
  }
  const double miss_a = std::abs(std::abs(*a.driven) - moved), miss_b = std::abs(std::abs(*b.driven) - moved);
  if (a.piece == b.piece || std::abs(miss_a - miss_b) > kReachSlack) return miss_a < miss_b;
  return a.piece > b.piece;  // the route goes on
}

RouteTracker::Result RouteTracker::off_route(const Pose2& pose, bool wrong_way) const {
  Result result;
  std::ostringstream text;
  if (wrong_way) {
    result.status.code = RouteCode::kWrongWay;
    text << "the vehicle points against the route, heading " << pose.heading() << " rad";
  } else if (last_ && index_->leads_to_destination(last_->piece) &&
             index_->distance_to_destination(*last_) < param_.max_distance) {
    result.status.code = RouteCode::kRouteEnd;
    text << "the vehicle has left the route past its destination on lane '"
         << index_->lane_of(index_->destination().piece).source.id << "'";
  } else {
    result.status.code = RouteCode::kOffRoute;
    text << "no lane of the route within " << param_.max_distance << " m of the vehicle";
  }
  result.status.message = text.str();
  return result;
}

RouteTracker::Result RouteTracker::update(const Pose2& pose) {
  bool wrong_way = false;
  std::vector<Candidate> found = candidates(pose, wrong_way);
  if (found.empty()) return off_route(pose, wrong_way);
  const double moved = last_ ? (pose.position() - last_position_).norm() : 0.0;
  measure_driven(found, kReachScale * moved + kReachSlack);
  const auto best_of = [&](std::vector<Candidate>::iterator first, std::vector<Candidate>::iterator end) {
    return std::min_element(first, end,
                            [&](const Candidate& a, const Candidate& b) { return better(a, b, moved); });
  };
  const auto jumps = std::partition(found.begin(), found.end(),
                                    [](const Candidate& candidate) { return candidate.driven.has_value(); });
  const auto driven = best_of(found.begin(), jumps), jump = best_of(jumps, found.end());
  const bool jumped = driven == jumps || (jump != found.end() && cost(*jump) + kJump < cost(*driven));
  const Candidate& best = jumped ? *jump : *driven;
  const RoutePiece& piece = index_->pieces()[best.piece];
  TrackedPlace place;
  place.place = {best.piece, std::clamp(best.projection.s, piece.start, piece.end)};
  place.s = best.projection.s;
  place.l = best.projection.l;
  last_ = place.place;
  last_position_ = pose.position();
  return {RouteStatus{}, place};
}

}  // namespace relative_map::core
