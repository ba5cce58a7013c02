#pragma once

#include <limits>
#include <string>
#include <vector>

#include "relative_map/model/traffic_lanes.hpp"

namespace relative_map::core {

constexpr std::size_t kNoLane = std::numeric_limits<std::size_t>::max();

/// A point of a lane's centerline.
struct LaneSample {
  Point2 position = Point2::Zero();
  Point2 direction = Point2::UnitX();  ///< unit tangent
  double kappa = 0.0;                  ///< [1/m] left positive, over a few metres
};

/// A lane's centerline at even steps, with its links by index.
struct ViewedLane {
  std::string id;
  std::vector<LaneSample> samples;
  double step = 1.0;                           ///< [m] between samples
  double length = 0.0;                         ///< [m]
  double left_width = 0.0, right_width = 0.0;  ///< [m] half widths
  double speed_limit = 0.0;                    ///< [m/s] 0: not known
  double turn = 0.0;                           ///< [rad] from its start to its end
  double sharpest = 0.0;                       ///< [1/m] greatest |kappa|
  LaneUse use = LaneUse::kVehicles;
  bool in_junction = false;
  std::vector<std::size_t> successors;
  std::size_t left_neighbor = kNoLane, right_neighbor = kNoLane;
  Point2 low = Point2::Zero(), high = Point2::Zero();  ///< the box around it

  /// At s [m]; straight on before its start and past its end.
  LaneSample at(double s) const;
};

/// Where a point lies on a lane.
struct LanePlace {
  std::size_t lane = kNoLane;
  double s = 0.0;      ///< [m] past the length where the lane ends there and goes straight on
  double l = 0.0;      ///< [m] from this lane's own centerline, left positive
  double theta = 0.0;  ///< [rad] of the lane there
};

/// Lanes as prediction looks at them, in the map frame. Built once for a map that stands, each tick for one
/// that moves along.
class LaneView {
 public:
  LaneView() = default;
  explicit LaneView(const TrafficLanes& lanes);

  const std::vector<ViewedLane>& lanes() const { return lanes_; }
  const std::vector<JunctionArea>& junctions() const { return junctions_; }
  std::size_t ego_lane() const { return ego_lane_; }
  const std::vector<std::size_t>& ego_targets() const { return ego_targets_; }
  std::size_t find(const std::string& id) const;

  /// All lanes whose centerline passes within `radius` [m], each at its nearest point. A lane without a
  /// successor goes straight on for `beyond_end` [m].
  void places(const Point2& point, double radius, std::vector<LanePlace>& result,
              double beyond_end = 50.0) const;

 private:
  std::vector<ViewedLane> lanes_;
  std::vector<JunctionArea> junctions_;
  std::size_t ego_lane_ = kNoLane;
  std::vector<std::size_t> ego_targets_;
};

inline LaneSample ViewedLane::at(double s) const {
  if (s <= 0.0 || s >= length) {
    LaneSample end = s <= 0.0 ? samples.front() : samples.back();
    end.position += (s <= 0.0 ? s : s - length) * end.direction;
    if (s < 0.0 || s > length) end.kappa = 0.0;
    return end;
  }
  const double place = s / step;
  const auto i = std::min(static_cast<std::size_t>(place), samples.size() - 2);
  const double weight = place - static_cast<double>(i);
  const LaneSample &a = samples[i], &b = samples[i + 1];
  LaneSample sample;
  sample.position = a.position + weight * (b.position - a.position);
  const Point2 direction = a.direction + weight * (b.direction - a.direction);
  sample.direction = direction / direction.norm();
  sample.kappa = a.kappa + weight * (b.kappa - a.kappa);
  return sample;
}

}  // namespace relative_map::core
