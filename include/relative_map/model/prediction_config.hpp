#pragma once

#include <string>
#include <vector>

namespace relative_map::core {

/// How road users are remembered.
struct RoadUserStoreParam {
  double max_age = 0.5;           ///< [s] one that was not seen for so long is no longer predicted
  double forget_after = 3.0;      ///< [s] and then forgotten: an id that comes back is a new road user
  double history_length = 7.0;    ///< [s] of positions that are kept
  double time_jump = 10.0;        ///< [s] a stamp that jumps by more, either way, forgets everything
  double max_road_users = 300.0;  ///< [-] the nearest to the vehicle are kept
  double max_speed = 80.0;        ///< [m/s] faster ones are faults of the sensor
};

/// The motion filter: acceleration is a first-order process (Singer, 1970).
struct MotionFilterParam {
  std::string preset = "singer";   ///< or "seed": constant acceleration, Q 0.01, R 0.1, P0 0.1, whatever dt
  double acceleration_time = 3.0;  ///< [s] in which an acceleration of a vehicle fades to 1/e
  double vehicle_along = 1.2;      ///< [m/s^2] standard deviation of a vehicle's acceleration along
  double vehicle_across = 0.5;     ///< [m/s^2] and across its heading, on the straight
  double pedestrian_time = 0.3;    ///< [s] people change their pace within a step, then keep the new one
  double pedestrian_along = 0.2;   ///< [m/s^2] in any direction: 0.15 m/s of pace within a second
  double bicycle_time = 0.5;       ///< [s] a push on the pedals
  double bicycle_along = 0.4;      ///< [m/s^2]
  double min_position_stddev = 0.05;  ///< [m] no sensor is believed to be better
  double max_position_stddev = 1.0;   ///< [m] measured noise beyond it is taken for manoeuvres
};

/// How a lane is chosen.
struct LaneChoiceParam {
  double search_radius = 5.0;            ///< [m] lanes farther to the side are not considered
  double max_heading_difference = 1.05;  ///< [rad] between a road user and its lane
  double preview_time = 1.5;             ///< [s] the lateral offset is judged as it will be then
  double offset_scale = 0.9;             ///< [m] of that offset, over which a lane's odds fall to 1/e
  double change_odds = 0.5;              ///< [-] of a lane beside the own one, the offset apart
  double turn_odds = 0.35;               ///< [-] of a branch that turns, against one that goes straight on
  double lateral_acceleration = 3.0;     ///< [m/s^2] that drivers take in curves
  double brake_scale = 1.0;              ///< [m/s^2] over which needed braking costs odds, above comfort
  double min_probability = 0.02;         ///< [-] lanes less likely than this get no trajectory
  double max_modes = 6.0;                ///< [-] trajectories a road user
};

/// How fast they will be.
struct SpeedParam {
  double acceleration_time = 2.0;       ///< [s] an acceleration fades to 1/e where nobody is ahead
  double follow_time = 1.0;             ///< [s] the same behind a leader: then it is the leader who counts
  double follow_gain = 0.41;            ///< [1/s] towards the speed that the gap allows (Jiang 2001)
  double follow_difference_gain = 0.5;  ///< [1/s] towards the leader's speed (Jiang 2001)
  double standstill_gap = 2.5;          ///< [m] bumper to bumper
  double min_headway = 0.6;             ///< [s] bounds of the headway that a driver is seen to keep
  double max_headway = 2.0;             ///< [s]
  double follow_horizon = 60.0;         ///< [m] leaders beyond it don't count
  double comfortable_braking = 2.0;     ///< [m/s^2] before curves
  double max_braking = 6.0;             ///< [m/s^2]
  double max_acceleration = 2.5;        ///< [m/s^2]
};

/// Who matters (Apollo's numbers).
struct PriorityParam {
  double ahead = 80.0;               ///< [m] of the box in which road users are not ignored
  double beside = 6.0;               ///< [m] half its width
  double caution_distance = 60.0;    ///< [m] from the vehicle
  double caution_range = 50.0;       ///< [m] along its lanes
  double pedestrian_distance = 5.0;  ///< [m] from its lanes, now or in 3 s
  double max_caution = 6.0;          ///< [-] the farthest go back to normal
  double junction_distance = 10.0;   ///< [m] to a controlled junction that makes the scenario one
};

struct PredictionConfig {
  RoadUserStoreParam store;
  MotionFilterParam filter;
  LaneChoiceParam lane;
  SpeedParam speed;
  PriorityParam priority;
  std::string selection = "default";  ///< or "navi": which evaluator and predictor serve whom

  /// Every fault as one sentence that names the parameter and its value; empty: fit to run with.
  std::vector<std::string> validate() const;
};

/// Calls visit(name, member) for every parameter: what reads, writes or checks them goes through here.
template <class Config, class Visitor>
void visit_parameters(Config& config, Visitor&& visit) {
  visit("selection", config.selection);
  auto& store = config.store;
  visit("store/max_age", store.max_age);
  visit("store/forget_after", store.forget_after);
  visit("store/history_length", store.history_length);
  visit("store/time_jump", store.time_jump);
  visit("store/max_road_users", store.max_road_users);
  visit("store/max_speed", store.max_speed);
  auto& filter = config.filter;
  visit("filter/preset", filter.preset);
  visit("filter/acceleration_time", filter.acceleration_time);
  visit("filter/vehicle_along", filter.vehicle_along);
  visit("filter/vehicle_across", filter.vehicle_across);
  visit("filter/pedestrian_time", filter.pedestrian_time);
  visit("filter/pedestrian_along", filter.pedestrian_along);
  visit("filter/bicycle_time", filter.bicycle_time);
  visit("filter/bicycle_along", filter.bicycle_along);
  visit("filter/min_position_stddev", filter.min_position_stddev);
  visit("filter/max_position_stddev", filter.max_position_stddev);
  auto& lane = config.lane;
  visit("lane/search_radius", lane.search_radius);
  visit("lane/max_heading_difference", lane.max_heading_difference);
  visit("lane/preview_time", lane.preview_time);
  visit("lane/offset_scale", lane.offset_scale);
  visit("lane/change_odds", lane.change_odds);
  visit("lane/turn_odds", lane.turn_odds);
  visit("lane/lateral_acceleration", lane.lateral_acceleration);
  visit("lane/brake_scale", lane.brake_scale);
  visit("lane/min_probability", lane.min_probability);
  visit("lane/max_modes", lane.max_modes);
  auto& speed = config.speed;
  visit("speed/acceleration_time", speed.acceleration_time);
  visit("speed/follow_time", speed.follow_time);
  visit("speed/follow_gain", speed.follow_gain);
  visit("speed/follow_difference_gain", speed.follow_difference_gain);
  visit("speed/standstill_gap", speed.standstill_gap);
  visit("speed/min_headway", speed.min_headway);
  visit("speed/max_headway", speed.max_headway);
  visit("speed/follow_horizon", speed.follow_horizon);
  visit("speed/comfortable_braking", speed.comfortable_braking);
  visit("speed/max_braking", speed.max_braking);
  visit("speed/max_acceleration", speed.max_acceleration);
  auto& priority = config.priority;
  visit("priority/ahead", priority.ahead);
  visit("priority/beside", priority.beside);
  visit("priority/caution_distance", priority.caution_distance);
  visit("priority/caution_range", priority.caution_range);
  visit("priority/pedestrian_distance", priority.pedestrian_distance);
  visit("priority/max_caution", priority.max_caution);
  visit("priority/junction_distance", priority.junction_distance);
}

}  // namespace relative_map::core
