// Where the waypoints of a route are on it, and how far each piece is from the destination.
#include <algorithm>
#include <cmath>

#include "route_index_builder.hpp"

namespace relative_map::core {

namespace {

constexpr double kBeside = 20.0;  // [m] along the route that places beside each other may differ by

}  // namespace

bool RouteIndexBuilder::find_waypoints() {
  for (std::size_t i = 0; i < route_.waypoints.size(); ++i) {
    if (!find_waypoint(i, route_.waypoints[i], i + 1 == route_.waypoints.size())) return false;
  }
  return true;
}

std::optional<PiecePlace> RouteIndexBuilder::place_on(std::size_t piece, std::size_t lane, double s) const {
  const RoutePiece& candidate = index_->pieces_[piece];
  if (candidate.lane != lane || s < candidate.start - kOnPiece || s > candidate.end + kOnPiece)
    return std::nullopt;
  return PiecePlace{piece, std::clamp(s, candidate.start, candidate.end)};
}

std::optional<PiecePlace> RouteIndexBuilder::place_left_out(std::size_t lane, double s) const {
  for (const LeftOut& none : left_out_) {
    if (none.lane != lane || std::abs(none.s - s) > kOnPiece) continue;
    for (std::size_t piece = std::min(none.piece, index_->pieces_.size()); piece > 0; --piece) {
      const auto& successors = index_->lane_of(piece - 1).successors;
      const bool leads_there = std::find(successors.begin(), successors.end(), lane) != successors.end();
      if (leads_there && index_->passage_of(piece - 1).can_exit) {
        return PiecePlace{piece - 1, index_->pieces_[piece - 1].end};
      }
    }
    if (none.piece < index_->pieces_.size()) return PiecePlace{none.piece, index_->pieces_[none.piece].start};
    return PiecePlace{none.piece - 1, index_->pieces_[none.piece - 1].end};
  }
  return std::nullopt;
}

/// The start and what is on the way are looked for from where the last one was found, the destination from
/// the route's end: on a lap both ends may lie at the same place.
bool RouteIndexBuilder::find_waypoint(std::size_t number, const RouteWaypoint& waypoint, bool last) {
  const auto lane = index_->network().find(waypoint.lane_id);
  if (!lane) {
    return refuse(RouteCode::kBadWaypoint, "waypoint ", number, " is on lane '", waypoint.lane_id,
                  "', which is not in the lane graph");
  }
  if (!std::isfinite(waypoint.s)) {
    return refuse(RouteCode::kBadWaypoint, "waypoint ", number, " on lane '", waypoint.lane_id,
                  "' has an s that is not finite");
  }
  const PiecePlace from = index_->waypoints_.empty() ? PiecePlace{} : index_->waypoints_.back();
  const std::size_t count = index_->pieces_.size();
  std::optional<PiecePlace> found;
  for (std::size_t i = from.piece; i < count && !found; ++i) {
    const std::size_t piece = last ? count - 1 - (i - from.piece) : i;
    found = place_on(piece, *lane, waypoint.s);
    if (found && !index_->waypoints_.empty() && piece == from.piece && found->s < from.s) found.reset();
  }
  if (!found) {
    found = place_left_out(*lane, waypoint.s);
    if (found && last) index_->destination_lane_ = lane;
  }
  if (!found) {
    return refuse(RouteCode::kBadWaypoint, "waypoint ", number, ", lane '", waypoint.lane_id, "' at ",
                  waypoint.s, " m, lies nowhere on the route behind the waypoint before it");
  }
  index_->waypoints_.push_back(*found);
  return true;
}

/// Distances to the destination, from the last road to the first; on a road first of the passages that lead
/// on, then of those that need a lane change.
void RouteIndexBuilder::measure() {
  const auto& passages = index_->passages_;
  for (std::size_t end = passages.size(); end > 0;) {
    std::size_t first = end;
    while (first > 0 && passages[first - 1].road == passages[end - 1].road) --first;
    for (const bool exits : {true, false}) {
      for (std::size_t i = end; i > first; --i) {
        if (passages[i - 1].can_exit == exits) measure_passage(passages[i - 1]);
      }
    }
    end = first;
  }
  const PiecePlace& destination = index_->destination();
  const PiecePlace& before = index_->waypoints_[index_->waypoints_.size() - 2];
  for (const std::size_t piece : index_->pieces_on(index_->pieces_[destination.piece].lane)) {
    if (piece < before.piece || (piece == before.piece && destination.s < before.s)) continue;
    if (!place_on(piece, index_->pieces_[piece].lane, destination.s)) continue;
    const double left = index_->distance_to_destination({piece, destination.s});
    index_->destination_comes_twice_ = index_->destination_comes_twice_ || left > kBeside;
  }
}

void RouteIndexBuilder::measure_passage(const PassageRange& passage) {
  RouteIndex& index = *index_;
  const PiecePlace& destination = index.destination();
  const bool ends_here = destination.piece >= passage.first && destination.piece < passage.end;
  const auto measured = [&](std::size_t other) {
    const PassageRange& range = index.passage_of(other);
    return range.can_exit != passage.can_exit ? range.can_exit : range.passage > passage.passage;
  };
  double beyond = 0.0;
  if (ends_here) {
    beyond = destination.s - index.pieces_[destination.piece].end;
    for (std::size_t i = destination.piece + 1; i < passage.end; ++i) {
      beyond -= index.pieces_[i].end - index.pieces_[i].start;
    }
  } else if (const auto next = index.next_[passage.end - 1]) {
    beyond = index.pieces_[*next].to_destination_start;
  }
  for (std::size_t i = passage.end; i > passage.first; --i) {
    RoutePiece& piece = index.pieces_[i - 1];
    piece.to_destination_end = beyond;
    piece.to_destination_start = beyond + piece.end - piece.start;
    if (!passage.can_exit && !ends_here) {
      for (const std::size_t other : index.beside(i - 1)) {
        if (!measured(other)) continue;
        // Beside the same share of the other lane: neighbors are as long as each other but for bends.
        const double scale = index.lane_of(other).length() / index.lane_of(i - 1).length();
        piece.to_destination_end = index.distance_to_destination({other, piece.end * scale});
        piece.to_destination_start = index.distance_to_destination({other, piece.start * scale});
        break;
      }
    }
    beyond = piece.to_destination_start;
  }
}

}  // namespace relative_map::core
