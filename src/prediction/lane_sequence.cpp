#include "relative_map/prediction/lane_sequence.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr std::size_t kMaxLanes = 40;  // a circle of short lanes must end

std::size_t straightest(const LaneView& view, const std::vector<std::size_t>& lanes) {
  return *std::min_element(lanes.begin(), lanes.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(view.lanes()[a].turn) < std::abs(view.lanes()[b].turn);
  });
}

}  // namespace

double LaneSequence::turn(double s, double reach) const {
  std::size_t hint = 0;
  const Point2 first = at(s, hint).direction;
  // In quarters, so that a turn by more than 180 degrees is not taken for one to the other side.
  double sum = 0.0;
  Point2 before = first;
  for (int i = 1; i <= 8; ++i) {
    const Point2 next = at(s + reach * i / 8.0, hint).direction;
    sum += std::atan2(cross(before, next), before.dot(next));
    before = next;
  }
  return sum;
}

double LaneSequence::chord_angle(double s, double reach) const {
  std::size_t hint = 0;
  const LaneSample first = at(s, hint);
  const Point2 chord = at(s + reach, hint).position - first.position;
  return std::atan2(cross(first.direction, chord), first.direction.dot(chord));
}

void sequences_from(const LaneView& view, const LanePlace& place, double branch_reach, double reach,
                    std::size_t most, std::vector<LaneSequence>& result) {
  std::vector<LaneSequence> open{LaneSequence(view, place)};
  const std::size_t first_result = result.size();
  while (!open.empty()) {
    LaneSequence sequence = std::move(open.back());
    open.pop_back();
    for (;;) {
      const double ahead = sequence.length() - place.s;
      const auto& successors = view.lanes()[sequence.lanes().back()].successors;
      if (ahead > reach || successors.empty() || sequence.lanes().size() >= kMaxLanes) break;
      const std::size_t next = straightest(view, successors);
      if (ahead < branch_reach) {
        for (const std::size_t other : successors) {
          if (other == next || result.size() - first_result + open.size() + 1 >= most) continue;
          open.push_back(sequence);
          open.back().append(other);
        }
      }
      sequence.append(next);
    }
    result.push_back(std::move(sequence));
  }
}

}  // namespace relative_map::core
