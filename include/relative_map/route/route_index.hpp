#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "relative_map/model/route.hpp"
#include "relative_map/model/route_segments.hpp"
#include "relative_map/route/lane_network.hpp"

namespace relative_map::core {

/// A piece of a lane, as the route has it once its holes are closed.
struct RoutePiece {
  std::size_t lane = 0;               ///< of the network
  double start = 0.0, end = 0.0;      ///< [m] along the lane, start < end
  std::size_t passage = 0;            ///< of RouteIndex::passages()
  std::size_t segment = 0;            ///< of all segments of the route as it was given, in order
  std::size_t position = 0;           ///< of its passage's segments as it was given
  double to_destination_start = 0.0;  ///< [m] from its start along the route to the destination
  double to_destination_end = 0.0;    ///< [m] from its end; less than 0 past it
};

/// A passage as a run of pieces.
struct PassageRange {
  std::size_t first = 0, end = 0;     ///< pieces [first, end)
  std::size_t road = 0, passage = 0;  ///< as the route was given
  bool can_exit = false;
  ChangeLane change_lane = ChangeLane::kForward;
};

/// A place on the route.
struct PiecePlace {
  std::size_t piece = 0;
  double s = 0.0;  ///< [m] along the piece's lane
};

/// A route over a lane network, checked and ready to be followed. It does not change.
class RouteIndex {
 public:
  struct Result {
    std::shared_ptr<const RouteIndex> index;  ///< none: the status says why
    RouteStatus status;
    std::vector<std::string> repairs;  ///< what was closed or left out: a sentence each
  };

  /// Checks the route, closes holes inside of lanes, leaves out pieces of no length, and finds its waypoints.
  static Result build(std::shared_ptr<const LaneNetwork> network, const Route& route);

  const LaneNetwork& network() const { return *network_; }
  const std::vector<RoutePiece>& pieces() const { return pieces_; }
  const std::vector<PassageRange>& passages() const { return passages_; }
  const std::vector<PiecePlace>& waypoints() const { return waypoints_; }
  const PiecePlace& destination() const { return waypoints_.back(); }
  const LaneNetwork::Lane& lane_of(std::size_t piece) const { return network_->lane(pieces_[piece].lane); }
  const PassageRange& passage_of(std::size_t piece) const { return passages_[pieces_[piece].passage]; }

  /// The pieces that lie on a lane, rising.
  const std::vector<std::size_t>& pieces_on(std::size_t lane) const;
  /// The piece that follows along the route: of the same passage, or of the next road.
  std::optional<std::size_t> next(std::size_t piece) const { return next_[piece]; }
  std::optional<std::size_t> previous(std::size_t piece) const { return previous_[piece]; }
  /// The pieces of the same road whose lane is a direct neighbor of this piece's lane.
  std::vector<std::size_t> beside(std::size_t piece) const;
  /// Whether the road of a piece is the route's last.
  bool on_last_road(std::size_t piece) const;
  /// Whether the route ends on this piece's passage.
  bool leads_to_destination(std::size_t piece) const;

  /// The lane that the destination is at the very start of, where the route only touches it.
  std::optional<std::size_t> destination_lane() const { return destination_lane_; }
  /// Whether the route passes its destination between the waypoint before it and the end: on a lap that ends
  /// where it starts.
  bool destination_comes_twice() const { return destination_comes_twice_; }

  /// The first waypoint that lies farther along the route than this place; the last one if none does.
  std::size_t next_waypoint(const PiecePlace& place) const;
  /// [m] along the route; lane changes cost nothing.
  double distance_to_destination(const PiecePlace& place) const;

 private:
  friend class RouteIndexBuilder;

  std::shared_ptr<const LaneNetwork> network_;
  std::vector<RoutePiece> pieces_;
  std::vector<PassageRange> passages_;
  std::vector<PiecePlace> waypoints_;
  std::vector<std::optional<std::size_t>> next_, previous_;
  std::optional<std::size_t> destination_lane_;
  bool destination_comes_twice_ = false;
  std::unordered_map<std::size_t, std::vector<std::size_t>> by_lane_;
};

}  // namespace relative_map::core
