#pragma once

#include <optional>
#include <vector>

#include "relative_map/route/route_index.hpp"

namespace relative_map::core {

/// A piece of a lane, driven from start to end.
struct LanePiece {
  std::size_t lane = 0;           ///< of the network
  double start = 0.0, end = 0.0;  ///< [m]
};

/// What is driven if the vehicle stays on a passage.
struct RouteLine {
  std::vector<LanePiece> pieces;
  double behind = 0.0;           ///< [m] of it before the place that it was made around
  bool has_passage_end = false;  ///< the end of the passage lies on it, ahead
  bool ends_at_destination = false;
};

/// The line through a place of the route, from `back` [m] behind it to `ahead` [m] ahead, along the route's
/// order. It goes on where the route does not: before the start and past a passage that does not lead on,
/// over lanes of the route where there is one, else over the first link. It ends at the destination, but for
/// closed lanes, which have no end: there it goes on through the seam. It is shorter where lanes end.
RouteLine line_through(const RouteIndex& index, const PiecePlace& place, double back, double ahead);

/// Puts a piece at the end of a line, as a longer last piece where it goes on on the same lane.
void append(std::vector<LanePiece>& line, const LanePiece& piece);

}  // namespace relative_map::core
