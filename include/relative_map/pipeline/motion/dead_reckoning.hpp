#pragma once

#include <deque>
#include <optional>

#include "relative_map/pipeline/motion/vehicle_state.hpp"

namespace relative_map::core {

/// The way of the vehicle by odometry alone: speed and yaw rate, integrated once, in a frame of its own that
/// begins where the first of them was added. Localization's noise, bias and jumps are not in it, so that it
/// says how the vehicle moved between two times, and never where it is.
///
/// Use: add() each new state with the speed and yaw rate that are believed (PoseBuffer::newest), then
///   moved(image.stamp, vehicle.stamp)  the pose of the vehicle now, seen from where the image was taken
///   way(image.stamp, vehicle.stamp)    how far it went meanwhile
/// Between two states both are the mean of the two, so that each piece is a circle's arc; a little beyond the
/// newest one they are its own. Nothing is known of what lies before a pause in the states, and older states
/// than `kept` are forgotten: an answer is then none.
///
/// Errors, for a filter that is fed with it: a bias b of the yaw rate [rad/s] turns the end of a piece of dt
/// by -b dt, a scale error of the speed lengthens its chord. dead reckoning itself claims no accuracy.
class DeadReckoning {
 public:
  /// `kept`: how long ago the oldest question may be about.
  explicit DeadReckoning(Duration kept = std::chrono::seconds(4)) : kept_(kept) {}
  void keep(Duration kept) { kept_ = kept; }

  /// Stamp, speed and yaw rate of `state`; its pose is not looked at. NaN reads as: as before. A stamp that
  /// is not later than the newest one's is none of a new state, and dropped.
  void add(const VehicleState& state);
  void clear() { nodes_.clear(); }

  /// The newest state; none: nothing is known.
  std::optional<Time> newest() const;
  /// In the own frame; none: nothing is known of that time.
  std::optional<Pose2> at(Time stamp) const;
  /// The pose at `to` in the frame of the pose at `from`, which may be the later one.
  std::optional<Pose2> moved(Time from, Time to) const;
  /// [m] driven from `from` to `to`, reversing counts as driving; negative if `to` is the earlier one.
  std::optional<double> way(Time from, Time to) const;

 private:
  /// A state, and how it goes on from there.
  struct Node {
    Time stamp{};
    Pose2 pose;             ///< in the own frame
    double way = 0.0;       ///< [m] driven since the frame began
    double speed = 0.0;     ///< [m/s] up to the next node
    double yaw_rate = 0.0;  ///< [rad/s] likewise
  };
  /// The node that a time belongs to, and `stamp` less its time [s]; null: nothing is known.
  const Node* node_of(Time stamp, double& seconds) const;

  Duration kept_;
  double speed_ = 0.0;      ///< [m/s] of the newest state
  double yaw_rate_ = 0.0;   ///< [rad/s]
  std::deque<Node> nodes_;  ///< by rising stamp
};

}  // namespace relative_map::core
