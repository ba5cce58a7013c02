#include "relative_map/tools/bridged_gaps.hpp"

#include <cmath>

namespace relative_map::core {

namespace {

double distance(const LinePoint& point, double x, double y) {
  return std::hypot(point.x - x, point.y - y);
}

}  // namespace

std::vector<BridgedGap> gaps_of(const RecordedLine& line, double max_gap) {
  std::vector<BridgedGap> gaps;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    const LinePoint &from = line.points[i - 1], &to = line.points[i];
    if (distance(from, to.x, to.y) > max_gap) gaps.push_back({from.x, from.y, to.x, to.y});
  }
  return gaps;
}

std::vector<BridgedGap> all_gaps(const LineFile& file, double max_gap) {
  std::vector<BridgedGap> gaps = gaps_of(file.line, max_gap);
  for (const BridgedGap& gap : file.header.bridged) {
    if (length_of(gap) > max_gap) gaps.push_back(gap);
  }
  return gaps;
}

std::size_t nearest_point(const RecordedLine& line, double x, double y) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    if (distance(line.points[i], x, y) < distance(line.points[nearest], x, y)) nearest = i;
  }
  return nearest;
}

std::vector<BridgedGap> still_bridged(const std::vector<BridgedGap>& gaps, const RecordedLine& edited,
                                      double beside) {
  std::vector<BridgedGap> bridged;
  if (edited.points.empty()) return bridged;
  for (const BridgedGap& gap : gaps) {
    const std::size_t from = nearest_point(edited, gap.from_x, gap.from_y);
    const std::size_t to = nearest_point(edited, gap.to_x, gap.to_y);
    const LinePoint &a = edited.points[from], &b = edited.points[to];
    const bool gone = from == to || distance(a, gap.from_x, gap.from_y) > beside ||
                      distance(b, gap.to_x, gap.to_y) > beside;
    const bool open = from + 1 == to || to + 1 == from;
    if (!gone && !open) bridged.push_back({a.x, a.y, b.x, b.y});
  }
  return bridged;
}

double length_of(const BridgedGap& gap) {
  return std::hypot(gap.to_x - gap.from_x, gap.to_y - gap.from_y);
}

}  // namespace relative_map::core
