#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "relative_map/model/lane_graph.hpp"
#include "relative_map/route/lane_projection.hpp"

namespace relative_map::core {

/// What is wrong with a lane graph: one sentence that names the lane.
struct GraphFault {
  bool fatal = false;  ///< the graph can't be used; else what is wrong is left out
  std::string what;
};

/// A lane graph, prepared: ids are places in a list, links lead to those places, and lanes are found by where
/// they lie. It does not change, so ticks and searches may share it.
class LaneNetwork {
 public:
  /// A lane, with its links as places in the list. Links to lanes that are not there are left out; a link
  /// that is named at one of its ends only is one at both.
  struct Lane {
    GraphLane source;
    LaneLine line;
    std::vector<std::size_t> successors, predecessors, left, right;
    bool closed = false;  ///< it is its own successor: its end meets its start

    double length() const { return line.length(); }
    /// [m] half width at s, linear between samples, held at the ends; 0 where none is known.
    double left_half_width(double s) const;
    double right_half_width(double s) const;
  };

  /// Every fault is added to `faults`; none is returned if one of them is fatal.
  static std::shared_ptr<const LaneNetwork> prepare(LaneGraph graph, std::vector<GraphFault>& faults);

  const std::string& frame_id() const { return frame_id_; }
  const std::string& map_version() const { return map_version_; }
  std::size_t size() const { return lanes_.size(); }
  const Lane& lane(std::size_t index) const { return lanes_[index]; }
  std::optional<std::size_t> find(const std::string& id) const;
  /// The lanes that may come within `distance` [m] of a point, rising: none is missing, some may be farther.
  std::vector<std::size_t> lanes_near(const Point2& point, double distance) const;

 private:
  struct Tree;  ///< hidden: Boost.Geometry is slow to compile

  void link(std::vector<GraphFault>& faults);
  void index();

  std::string frame_id_, map_version_;
  std::vector<Lane> lanes_;
  std::unordered_map<std::string, std::size_t> by_id_;
  std::shared_ptr<const Tree> tree_;
};

}  // namespace relative_map::core
