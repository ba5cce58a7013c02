#include "relative_map/route/passage_choice.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

/// Whether a lane of `other` lies beside this piece of `own`, on the side to which `own` must be left.
bool leads_to(const RouteIndex& index, std::size_t piece, const PassageRange& own,
              const PassageRange& other) {
  const LaneNetwork::Lane& lane = index.lane_of(piece);
  const std::vector<std::size_t>& side = own.change_lane == ChangeLane::kLeft ? lane.left : lane.right;
  for (std::size_t k = other.first; k < other.end; ++k) {
    if (std::find(side.begin(), side.end(), index.pieces()[k].lane) != side.end()) return true;
  }
  return false;
}

bool beside(const RouteIndex& index, const PassageRange& own, const PassageRange& other) {
  for (std::size_t i = own.first; i < own.end; ++i) {
    if (leads_to(index, i, own, other)) return true;
  }
  return false;
}

}  // namespace

std::optional<std::size_t> next_passage(const RouteIndex& index, const PiecePlace& place) {
  const std::size_t own_number = index.pieces()[place.piece].passage;
  const auto& passages = index.passages();
  const PassageRange& own = passages[own_number];
  if (own.change_lane == ChangeLane::kForward || own.can_exit) return std::nullopt;
  const PiecePlace& waypoint = index.waypoints()[index.next_waypoint(place)];
  const bool ahead = waypoint.piece > place.piece || (waypoint.piece == place.piece && waypoint.s > place.s);
  if (ahead && waypoint.piece >= own.first && waypoint.piece < own.end) return std::nullopt;
  for (std::size_t i = own_number + 1; i < passages.size() && passages[i].road == own.road; ++i) {
    if (beside(index, own, passages[i])) return i;
  }
  for (std::size_t i = own_number; i > 0 && passages[i - 1].road == own.road; --i) {
    if (beside(index, own, passages[i - 1])) return i - 1;
  }
  return std::nullopt;
}

std::optional<ChangeZone> change_zone(const RouteIndex& index, const PiecePlace& place,
                                      std::size_t to_passage) {
  const PassageRange& own = index.passage_of(place.piece);
  const PassageRange& other = index.passages()[to_passage];
  std::optional<ChangeZone> zone;
  double ahead = index.pieces()[place.piece].start - place.s;  // of the piece's start
  for (std::size_t i = place.piece; i < own.end; ++i) {
    const double end = ahead + index.pieces()[i].end - index.pieces()[i].start;
    if (leads_to(index, i, own, other)) {
      if (!zone) zone = ChangeZone{std::max(0.0, ahead), end};
      zone->end = end;
    }
    ahead = end;
  }
  return zone;
}

}  // namespace relative_map::core
