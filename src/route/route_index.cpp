#include "relative_map/route/route_index.hpp"

#include <algorithm>

#include "route_index_builder.hpp"

namespace relative_map::core {

RouteIndex::Result RouteIndex::build(std::shared_ptr<const LaneNetwork> network, const Route& route) {
  return RouteIndexBuilder(std::move(network), route).build();
}

const std::vector<std::size_t>& RouteIndex::pieces_on(std::size_t lane) const {
  static const std::vector<std::size_t> kNone;
  const auto found = by_lane_.find(lane);
  return found == by_lane_.end() ? kNone : found->second;
}

std::vector<std::size_t> RouteIndex::beside(std::size_t piece) const {
  const LaneNetwork::Lane& lane = lane_of(piece);
  const std::size_t road = passage_of(piece).road;
  std::vector<std::size_t> found;
  for (const std::vector<std::size_t>* side : {&lane.left, &lane.right}) {
    for (const std::size_t neighbor : *side) {
      for (const std::size_t other : pieces_on(neighbor)) {
        if (passage_of(other).road == road) found.push_back(other);
      }
    }
  }
  return found;
}

bool RouteIndex::on_last_road(std::size_t piece) const {
  return passage_of(piece).road == passages_.back().road;
}

bool RouteIndex::leads_to_destination(std::size_t piece) const {
  return pieces_[piece].passage == pieces_[destination().piece].passage;
}

std::size_t RouteIndex::next_waypoint(const PiecePlace& place) const {
  const auto farther = std::upper_bound(
      waypoints_.begin(), waypoints_.end(), place, [](const PiecePlace& here, const PiecePlace& waypoint) {
        return std::make_pair(here.piece, here.s) < std::make_pair(waypoint.piece, waypoint.s);
      });
  const auto passed = static_cast<std::size_t>(farther - waypoints_.begin());
  return std::min(passed, waypoints_.size() - 1);
}

double RouteIndex::distance_to_destination(const PiecePlace& place) const {
  const RoutePiece& piece = pieces_[place.piece];
  const double fraction = (place.s - piece.start) / (piece.end - piece.start);
  return piece.to_destination_start + fraction * (piece.to_destination_end - piece.to_destination_start);
}

}  // namespace relative_map::core
