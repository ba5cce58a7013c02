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

}  // namespace relative_map::core
