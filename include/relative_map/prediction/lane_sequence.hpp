#pragma once

#include <vector>

#include "relative_map/prediction/lane_view.hpp"

namespace relative_map::core {

/// Lanes that follow one another, from the one that a road user is on or beside. `s` is measured from the
/// start of the first lane; past the last lane's end the sequence goes straight on.
class LaneSequence {
 public:
  LaneSequence(const LaneView& view, const LanePlace& place) : view_(&view), place_(place) {
    append(place.lane);
  }

  void append(std::size_t lane) {
    lanes_.push_back(lane);
    starts_.push_back(length_);
    length_ += view_->lanes()[lane].length;
  }

  const LaneView& view() const { return *view_; }
  const LanePlace& place() const { return place_; }  ///< of the road user on the first lane
  const std::vector<std::size_t>& lanes() const { return lanes_; }
  double length() const { return length_; }  ///< [m] of all lanes
  double start_of(std::size_t i) const { return starts_[i]; }

  /// `hint` is the lane to start the search from, and comes back: walking forward costs O(1) a step.
  LaneSample at(double s, std::size_t& hint) const {
    while (hint + 1 < lanes_.size() && s >= starts_[hint + 1]) ++hint;
    return view_->lanes()[lanes_[hint]].at(s - starts_[hint]);
  }
  LaneSample at(double s) const {
    std::size_t hint = 0;
    return at(s, hint);
  }
  std::size_t lane_at(double s) const {
    std::size_t i = 0;
    while (i + 1 < lanes_.size() && s >= starts_[i + 1]) ++i;
    return lanes_[i];
  }
  /// [rad] how far it turns from s on over `reach` [m]
  double turn(double s, double reach) const;
  /// [rad] from the way's direction at s to the straight line over to where it is `reach` [m] farther; of an
  /// arc it is half of its turn, and lanes that part sideways have one, too
  double chord_angle(double s, double reach) const;

 private:
  const LaneView* view_;
  LanePlace place_;
  std::vector<std::size_t> lanes_;
  std::vector<double> starts_;
  double length_ = 0.0;
};

/// All ways on from a place. Branches within `branch_reach` [m] are ways of their own, at most `most` of
/// them; farther on, up to `reach`, each goes on straightest.
void sequences_from(const LaneView& view, const LanePlace& place, double branch_reach, double reach,
                    std::size_t most, std::vector<LaneSequence>& result);

}  // namespace relative_map::core
