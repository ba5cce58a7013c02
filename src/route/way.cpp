#include "way.hpp"

#include <algorithm>
#include <iterator>

namespace relative_map::core {

namespace {

bool contains(const std::vector<std::size_t>& lanes, std::size_t lane) {
  return std::find(lanes.begin(), lanes.end(), lane) != lanes.end();
}

bool crossable(const std::vector<PaintSpan>& paint) {
  return std::all_of(paint.begin(), paint.end(), [](const PaintSpan& span) {
    return span.type == BoundaryType::kDottedWhite || span.type == BoundaryType::kDottedYellow;
  });
}

/// A row of lanes that is driven without a change; the pieces [first, end) are of the way itself, those
/// before and after them were added because the rows beside it can be changed to from there.
struct Row {
  std::vector<LanePiece> pieces;
  std::size_t first = 0, end = 0;
  ChangeLane leave = ChangeLane::kForward;
};

bool has_lane(const Row& row, std::size_t lane) {
  return std::any_of(row.pieces.begin(), row.pieces.end(),
                     [&](const LanePiece& piece) { return piece.lane == lane; });
}

/// Whether a change to the side leads from a lane to one of a row.
bool leads_to(const LaneNetwork& network, std::size_t lane, ChangeLane side, const Row& row) {
  const LaneNetwork::Lane& from = network.lane(lane);
  const auto& beside = side == ChangeLane::kLeft ? from.left : from.right;
  return std::any_of(beside.begin(), beside.end(), [&](std::size_t other) {
    return has_lane(row, other) && may_change(network, lane, other, side);
  });
}

/// Whether a change to the side leads from one of a row to a lane.
bool reached_from(const LaneNetwork& network, const Row& row, ChangeLane side, std::size_t lane) {
  return std::any_of(row.pieces.begin(), row.pieces.end(), [&](const LanePiece& piece) {
    const LaneNetwork::Lane& from = network.lane(piece.lane);
    return contains(side == ChangeLane::kLeft ? from.left : from.right, lane) &&
           may_change(network, piece.lane, lane, side);
  });
}

std::vector<Row> rows_of(const Way& way) {
  std::vector<Row> rows(1);
  for (const WayStep& step : way) {
    rows.back().pieces.push_back(step.piece);
    if (step.leave == ChangeLane::kForward) continue;
    rows.back().leave = step.leave;
    rows.emplace_back();
  }
  for (Row& row : rows) row.end = row.pieces.size();
  return rows;
}

void lengthen_ahead(const LaneNetwork& network, const std::set<std::size_t>& closed, Row& row,
                    const Row& next) {
  for (bool longer = true; longer;) {
    longer = false;
    const LaneNetwork::Lane& last = network.lane(row.pieces.back().lane);
    if (row.pieces.back().end < last.length()) return;  // it ends in its lane, beside the destination
    for (const std::size_t lane : last.successors) {
      if (closed.count(lane) > 0 || has_lane(row, lane) || !leads_to(network, lane, row.leave, next))
        continue;
      row.pieces.push_back({lane, 0.0, network.lane(lane).length()});
      longer = true;
      break;
    }
  }
}

void lengthen_back(const LaneNetwork& network, const std::set<std::size_t>& closed, Row& row,
                   const Row& before) {
  for (bool longer = true; longer;) {
    longer = false;
    if (row.pieces.front().start > 0.0) return;
    for (const std::size_t lane : network.lane(row.pieces.front().lane).predecessors) {
      if (closed.count(lane) > 0 || has_lane(row, lane) || !reached_from(network, before, before.leave, lane))
        continue;
      row.pieces.insert(row.pieces.begin(), {lane, 0.0, network.lane(lane).length()});
      ++row.first;
      ++row.end;
      longer = true;
      break;
    }
  }
}

Passage passage_of(const LaneNetwork& network, const Row& row, std::size_t first, std::size_t end) {
  Passage passage;
  for (std::size_t i = first; i < end; ++i) {
    passage.segments.push_back(
        {network.lane(row.pieces[i].lane).source.id, row.pieces[i].start, row.pieces[i].end});
  }
  return passage;
}

/// The pieces of a row that lie beside the row before it, or the row after it.
struct Beside {
  std::size_t end = 0;    ///< pieces [0, end) can be come to from the row before
  std::size_t first = 0;  ///< pieces [first, ...) lead to the row after
};

Beside beside_of(const LaneNetwork& network, const std::vector<Row>& rows, std::size_t i) {
  const Row& row = rows[i];
  Beside beside{0, row.pieces.size()};
  for (std::size_t k = 0; k < row.pieces.size(); ++k) {
    if (i > 0 && reached_from(network, rows[i - 1], rows[i - 1].leave, row.pieces[k].lane))
      beside.end = k + 1;
    if (i + 1 < rows.size() && beside.first == row.pieces.size() &&
        leads_to(network, row.pieces[k].lane, row.leave, rows[i + 1])) {
      beside.first = k;
    }
  }
  return beside;
}

}  // namespace

void widen(const LaneNetwork& network, Way& way) {
  for (std::size_t i = 1; i < way.size() && way[i - 1].leave != ChangeLane::kForward; ++i) {
    way[i].piece.start = 0.0;
  }
  for (std::size_t i = way.size() - 1; i > 0 && way[i - 1].leave != ChangeLane::kForward; --i) {
    way[i - 1].piece.end = network.lane(way[i - 1].piece.lane).length();
  }
}

void join(Way& way, const Way& leg) {
  if (way.empty()) {
    way = leg;
    return;
  }
  way.back().piece.end = leg.front().piece.end;
  way.back().leave = leg.front().leave;
  way.insert(way.end(), leg.begin() + 1, leg.end());
}

bool may_change(const LaneNetwork& network, std::size_t from, std::size_t to, ChangeLane side) {
  const GraphLane &here = network.lane(from).source, &there = network.lane(to).source;
  if (here.type != LaneType::kCityDriving || there.type != LaneType::kCityDriving) return false;
  return crossable(side == ChangeLane::kLeft ? here.left_paint : here.right_paint);
}

std::vector<RouteRoad> roads_of(const LaneNetwork& network, const Way& way,
                                const std::set<std::size_t>& closed) {
  std::vector<Row> rows = rows_of(way);
  for (std::size_t i = rows.size() - 1; i > 0; --i) lengthen_ahead(network, closed, rows[i - 1], rows[i]);
  for (std::size_t i = 1; i < rows.size(); ++i) lengthen_back(network, closed, rows[i], rows[i - 1]);

  std::vector<RouteRoad> roads;
  const auto add_single = [&](const Row& row, std::size_t piece) {
    RouteRoad road;
    road.id = network.lane(row.pieces[piece].lane).source.road;
    road.passages = {passage_of(network, row, piece, piece + 1)};
    road.passages.back().can_exit = true;
    roads.push_back(road);
  };
  bool open = false;  // whether the last road goes on with the next row
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const Beside beside = beside_of(network, rows, i);
    std::size_t at = 0;
    if (open) {
      const bool goes_on = i + 1 < rows.size() && beside.first <= beside.end;
      const std::size_t end = goes_on ? row.pieces.size() : std::max<std::size_t>(beside.end, 1);
      Passage passage = passage_of(network, row, 0, end);
      passage.can_exit = !goes_on;
      passage.change_lane = goes_on ? row.leave : ChangeLane::kForward;
      roads.back().passages.push_back(passage);
      if (goes_on) continue;
      at = end;
    }
    const std::size_t changes = i + 1 < rows.size() ? std::max(at, beside.first) : row.pieces.size();
    for (; at < std::min(changes, row.pieces.size()); ++at) add_single(row, at);
    open = i + 1 < rows.size();
    if (!open) break;
    RouteRoad road;
    road.id = network.lane(row.pieces[std::min(at, row.pieces.size() - 1)].lane).source.road;
    Passage passage = passage_of(network, row, at, row.pieces.size());
    passage.change_lane = row.leave;
    road.passages.push_back(passage);
    roads.push_back(road);
  }
  return roads;
}

}  // namespace relative_map::core
