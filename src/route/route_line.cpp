#include "relative_map/route/route_line.hpp"

#include <algorithm>
#include <cmath>

#include "route_index_builder.hpp"

namespace relative_map::core {

namespace {

constexpr double kJoint = 1e-6;            // [m] pieces of one lane that are so near each other are one
constexpr double kBeside = 20.0;           // [m] along the route that places beside each other may differ by
constexpr double kTouched = 0.2;           // [m] of a lane at whose very start the destination is
constexpr std::size_t kMostSteps = 10000;  // a graph of lanes without length must not hang a tick

/// Where a walk is: on a piece of the route, or on a lane off it, and then `piece` is the last one it was on.
struct Step {
  std::size_t lane = 0;
  std::size_t piece = 0;
  bool on_route = true;
};

/// The lane to go on to where the route gives none: one of the route if there is, the first after this piece.
std::optional<Step> link_ahead(const RouteIndex& index, const Step& from) {
  const std::vector<std::size_t>& lanes = index.network().lane(from.lane).successors;
  for (const std::size_t lane : lanes) {
    const auto& pieces = index.pieces_on(lane);
    const auto later = std::upper_bound(pieces.begin(), pieces.end(), from.piece);
    if (later != pieces.end()) return Step{lane, *later, true};
  }
  for (const std::size_t lane : lanes) {
    if (!index.pieces_on(lane).empty()) return Step{lane, from.piece, false};
  }
  if (lanes.empty()) return std::nullopt;
  return Step{lanes.front(), from.piece, false};
}

/// The link back: a lane of the route if there is one, the first of the route.
std::optional<std::size_t> link_back(const RouteIndex& index, const std::vector<std::size_t>& lanes) {
  std::optional<std::size_t> best;
  for (const std::size_t lane : lanes) {
    const auto& pieces = index.pieces_on(lane);
    if (pieces.empty()) continue;
    if (!best || pieces.front() < index.pieces_on(*best).front()) best = lane;
  }
  if (best || lanes.empty()) return best;
  return lanes.front();
}

class Walk {
 public:
  Walk(const RouteIndex& index, const PiecePlace& place) : index_(index), place_(place) {}

  void ahead(double distance, RouteLine& line) {
    Step at{index_.pieces()[place_.piece].lane, place_.piece, true};
    double from = place_.s, left = distance;
    for (std::size_t step = 0; step < kMostSteps; ++step) {
      // Past the end of a passage its lane goes on, unless the route goes on elsewhere from there.
      const double length = index_.network().lane(at.lane).length();
      const auto next = at.on_route ? index_.next(at.piece) : std::nullopt;
      const double piece_end = at.on_route ? index_.pieces()[at.piece].end : length;
      double to = next ? piece_end : length;
      const bool ends = clip_at_destination(at, from, to);
      const double stop = std::min(to, from + left);
      if (last_of_own_passage(at) && piece_end <= stop + kOnPiece) line.has_passage_end = true;
      if (stop > from) append(line.pieces, {at.lane, from, stop});
      left -= std::max(0.0, stop - from);
      if (ends && stop >= to) {
        line.ends_at_destination = true;
        // Of a lane that the route only touches so much that a planner which looks for it finds it.
        if (const auto lane = index_.destination_lane()) append(line.pieces, {*lane, 0.0, kTouched});
        return;
      }
      if (left <= kJoint) return;
      if (next) {
        at = {index_.pieces()[*next].lane, *next, true};
        from = index_.pieces()[*next].start;
        continue;
      }
      const auto link = link_ahead(index_, at);
      if (!link) return;
      at = *link;
      from = 0.0;
    }
  }

  void behind(double distance, RouteLine& line) {
    std::vector<LanePiece> reversed;
    Step at{index_.pieces()[place_.piece].lane, place_.piece, true};
    double to = place_.s, left = distance;
    for (std::size_t step = 0; left > 0.0 && step < kMostSteps; ++step) {
      const auto previous = at.on_route ? index_.previous(at.piece) : std::nullopt;
      const double from = std::max(previous ? index_.pieces()[at.piece].start : 0.0, to - left);
      if (from < to) reversed.push_back({at.lane, from, to});
      left -= std::max(0.0, to - from);
      if (left <= kJoint) break;
      if (previous) {
        at = {index_.pieces()[*previous].lane, *previous, true};
        to = index_.pieces()[*previous].end;
        continue;
      }
      const auto link = link_back(index_, index_.network().lane(at.lane).predecessors);
      if (!link) break;
      at = {*link, at.piece, false};
      to = index_.network().lane(*link).length();
    }
    line.behind = distance - std::max(0.0, left);
    for (auto part = reversed.rbegin(); part != reversed.rend(); ++part) append(line.pieces, *part);
  }

 private:
  bool last_of_own_passage(const Step& at) const {
    return at.on_route && at.piece + 1 == index_.passage_of(at.piece).end &&
           index_.pieces()[at.piece].passage == index_.pieces()[place_.piece].passage;
  }

  /// Whether the destination lies on [from, to] of what is driven now; `to` is then there.
  bool clip_at_destination(const Step& at, double from, double& to) const {
    const PiecePlace& destination = index_.destination();
    if (index_.lane_of(destination.piece).closed || index_.pieces()[destination.piece].lane != at.lane)
      return false;
    // On an earlier pass of the same lane the route goes on.
    if (!index_.on_last_road(at.piece) || (at.on_route && !passes_destination(at.piece))) return false;
    if (destination.s > to + kOnPiece) return false;
    to = std::max(from, destination.s);
    return true;
  }

  bool passes_destination(std::size_t piece) const {
    const PiecePlace& destination = index_.destination();
    if (index_.leads_to_destination(piece)) return piece == destination.piece;
    return std::abs(index_.distance_to_destination({piece, destination.s})) < kBeside;
  }

  const RouteIndex& index_;
  PiecePlace place_;
};

}  // namespace

void append(std::vector<LanePiece>& line, const LanePiece& piece) {
  if (!line.empty() && line.back().lane == piece.lane && std::abs(line.back().end - piece.start) <= kJoint) {
    line.back().end = piece.end;
  } else {
    line.push_back(piece);
  }
}

RouteLine line_through(const RouteIndex& index, const PiecePlace& place, double back, double ahead) {
  RouteLine line;
  Walk walk(index, place);
  walk.behind(back, line);
  walk.ahead(ahead, line);
  return line;
}

}  // namespace relative_map::core
