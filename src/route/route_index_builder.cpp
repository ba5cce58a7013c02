#include "route_index_builder.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

/// How far apart two lanes are that should meet.
std::string text_of_end(const LaneNetwork::Lane& from, const LaneNetwork::Lane& to) {
  std::ostringstream text;
  text << "it starts " << (from.line.points().back().position - to.line.points().front().position).norm()
       << " m from its end";
  return text.str();
}

constexpr double kNoLength = 1e-3;  // [m] a piece that is shorter is none
constexpr double kMeet = 1.0;       // [m] that lanes may be apart where one is driven after the other
constexpr double kBeside = 20.0;    // [m] along the route that places beside each other may differ by
// A map's length of a lane may differ from that of its points by this much [m], or this share of it.
constexpr double kMapLength = 1.0;
constexpr double kMapScale = 0.02;

}  // namespace

RouteIndexBuilder::RouteIndexBuilder(std::shared_ptr<const LaneNetwork> network, const Route& route)
    : route_(route), index_(std::make_shared<RouteIndex>()) {
  index_->network_ = std::move(network);
}

RouteIndex::Result RouteIndexBuilder::build() {
  if (check_header() && add_passages()) {
    link_roads();
    if (find_waypoints()) {
      measure();
      result_.index = index_;
    }
  }
  return std::move(result_);
}

bool RouteIndexBuilder::check_header() {
  const LaneNetwork& network = index_->network();
  if (!route_.frame_id.empty() && !network.frame_id().empty() && route_.frame_id != network.frame_id()) {
    return refuse(RouteCode::kFrameMismatch, "the route is in the frame '", route_.frame_id,
                  "', the lane graph in '", network.frame_id(), "'");
  }
  if (route_.roads.empty()) return refuse(RouteCode::kBadRoute, "the route has no road");
  if (route_.waypoints.size() < 2) {
    return refuse(RouteCode::kBadWaypoint, "the route has ", route_.waypoints.size(),
                  " waypoints, but needs a start and a destination");
  }
  if (!route_.map_version.empty() && !network.map_version().empty() &&
      route_.map_version != network.map_version()) {
    result_.repairs.push_back(text("the route was made for the map '", route_.map_version,
                                   "', the lane graph is '", network.map_version(), "'"));
  }
  return true;
}

bool RouteIndexBuilder::check_segment(const LaneSegment& segment, const std::string& where) {
  const auto lane = index_->network().find(segment.lane_id);
  if (!lane) {
    return refuse(RouteCode::kUnknownLane, where, " is on lane '", segment.lane_id,
                  "', which is not in the lane graph");
  }
  if (!std::isfinite(segment.start_s) || !std::isfinite(segment.end_s)) {
    return refuse(RouteCode::kBadRoute, where, " on lane '", segment.lane_id,
                  "' has an s that is not finite");
  }
  const double length = index_->network().lane(*lane).length();
  const double slack = std::max(kMapLength, kMapScale * length);
  if (segment.start_s < -slack || segment.end_s > length + slack) {
    return refuse(RouteCode::kBadRoute, where, " is [", segment.start_s, ", ", segment.end_s, "] m of lane '",
                  segment.lane_id, "', which is ", length, " m long");
  }
  if (segment.end_s < segment.start_s) {
    return refuse(RouteCode::kBadRoute, where, " on lane '", segment.lane_id, "' runs backwards, from ",
                  segment.start_s, " to ", segment.end_s, " m");
  }
  return true;
}

bool RouteIndexBuilder::add_passages() {
  std::size_t segment = 0;
  for (std::size_t road = 0; road < route_.roads.size(); ++road) {
    if (route_.roads[road].passages.empty()) {
      return refuse(RouteCode::kBadRoute, "road ", road, " of the route has no passage");
    }
    for (std::size_t passage = 0; passage < route_.roads[road].passages.size(); ++passage) {
      if (!add_passage(road, passage, segment)) return false;
    }
  }
  if (index_->pieces_.empty()) return refuse(RouteCode::kBadRoute, "the route has no length");
  return true;
}

bool RouteIndexBuilder::add_passage(std::size_t road, std::size_t passage, std::size_t& segment) {
  const Passage& source = route_.roads[road].passages[passage];
  const std::string name = text("passage ", passage, " of road ", road);
  if (source.segments.empty()) return refuse(RouteCode::kBadRoute, name, " has no segment");
  PassageRange range;
  range.first = index_->pieces_.size();
  range.road = road;
  range.passage = passage;
  range.can_exit = source.can_exit;
  range.change_lane = source.change_lane;
  for (std::size_t position = 0; position < source.segments.size(); ++position, ++segment) {
    const LaneSegment& given = source.segments[position];
    const std::string where = text("segment ", position, " of ", name);
    if (!check_segment(given, where)) return false;
    RoutePiece piece;
    piece.lane = *index_->network().find(given.lane_id);
    const double length = index_->network().lane(piece.lane).length();
    piece.start = std::clamp(given.start_s, 0.0, length);
    piece.end = std::clamp(given.end_s, 0.0, length);
    piece.passage = index_->passages_.size();
    piece.segment = segment;
    piece.position = position;
    if (piece.end - piece.start < kNoLength) {
      result_.repairs.push_back(text(where, " on lane '", given.lane_id, "' has no length: it is left out"));
      left_out_.push_back({piece.lane, given.start_s, index_->pieces_.size()});
      continue;
    }
    index_->pieces_.push_back(piece);
    const std::size_t last = index_->pieces_.size() - 1;
    if (last > range.first && !close_hole(last - 1, last)) return false;
  }
  range.end = index_->pieces_.size();
  if (range.end > range.first) index_->passages_.push_back(range);
  return true;
}

bool RouteIndexBuilder::connected(std::size_t before, std::size_t after) const {
  const RoutePiece &a = index_->pieces_[before], &b = index_->pieces_[after];
  const LaneNetwork::Lane &from = index_->network().lane(a.lane), &to = index_->network().lane(b.lane);
  if (a.lane == b.lane && b.start >= a.end - kOnPiece) return true;
  const auto& successors = from.successors;
  if (std::find(successors.begin(), successors.end(), b.lane) != successors.end()) return true;
  return (from.line.points().back().position - to.line.points().front().position).norm() <= kMeet;
}

/// Makes one piece end where the next one starts: what lies between is driven, too.
bool RouteIndexBuilder::close_hole(std::size_t before, std::size_t after) {
  RoutePiece &a = index_->pieces_[before], &b = index_->pieces_[after];
  const LaneNetwork::Lane &from = index_->network().lane(a.lane), &to = index_->network().lane(b.lane);
  if (!connected(before, after)) {
    return refuse(RouteCode::kBadRoute, "lane '", to.source.id, "' does not follow lane '", from.source.id,
                  "' (", text_of_end(from, to), ")");
  }
  double hole = 0.0;
  if (a.lane == b.lane && b.start >= a.end - kOnPiece) {
    hole = std::abs(b.start - a.end);
    a.end = b.start;
  } else {
    hole = from.length() - a.end + b.start;
    a.end = from.length();
    b.start = 0.0;
  }
  if (hole > kOnPiece) {
    result_.repairs.push_back(text("the route has a hole of ", hole, " m between lane '", from.source.id,
                                   "' and lane '", to.source.id, "': it is closed"));
  }
  return true;
}

void RouteIndexBuilder::link_roads() {
  RouteIndex& index = *index_;
  for (std::size_t piece = 0; piece < index.pieces_.size(); ++piece) {
    index.by_lane_[index.pieces_[piece].lane].push_back(piece);
  }
  index.next_.resize(index.pieces_.size());
  index.previous_.resize(index.pieces_.size());
  for (const PassageRange& passage : index.passages_) {
    for (std::size_t piece = passage.first; piece + 1 < passage.end; ++piece) {
      index.next_[piece] = piece + 1;
      index.previous_[piece + 1] = piece;
    }
  }
  // Passages are in the order of their roads: those of the next road follow those of this one.
  for (std::size_t i = 0; i < index.passages_.size(); ++i) {
    const std::size_t last = index.passages_[i].end - 1;
    std::size_t k = i + 1;
    while (k < index.passages_.size() && index.passages_[k].road == index.passages_[i].road) ++k;
    if (k == index.passages_.size()) continue;
    for (const std::size_t road = index.passages_[k].road;
         k < index.passages_.size() && index.passages_[k].road == road; ++k) {
      const std::size_t first = index.passages_[k].first;
      if (!connected(last, first)) continue;
      if (!index.next_[last]) {
        index.next_[last] = first;
        close_hole(last, first);
      }
      // The passage that leads to the next road is the one that the vehicle has come along.
      const auto& known = index.previous_[first];
      if (!known || (!index.passage_of(*known).can_exit && index.passages_[i].can_exit)) {
        index.previous_[first] = last;
      }
    }
    if (index.passages_[i].can_exit && !index.next_[last]) {
      result_.repairs.push_back(text("passage ", index.passages_[i].passage, " of road ",
                                     index.passages_[i].road, " does not lead to the next road"));
    }
  }
}

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
