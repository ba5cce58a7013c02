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
  double acceleration_time = 0.8;  ///< [s] in which an acceleration of a vehicle fades to 1/e
  double vehicle_along = 0.8;      ///< [m/s^2] standard deviation of a vehicle's acceleration along
  double vehicle_across = 0.5;     ///< [m/s^2] and across its heading, on the straight
  double pedestrian_time = 0.15;   ///< [s] people change their pace within a step, then keep the new one
  double pedestrian_along = 0.25;  ///< [m/s^2] in any direction: 0.15 m/s of pace within a second
  double bicycle_time = 0.2;       ///< [s] a push on the pedals
  double bicycle_along = 0.6;      ///< [m/s^2]
  double min_position_stddev = 0.06;    ///< [m] no sensor is believed to be better,
  double min_pedestrian_stddev = 0.03;  ///< [m] but of a pedestrian, whose box is small
  double max_position_stddev = 1.0;     ///< [m] measured noise beyond it is taken for manoeuvres
};

/// How a lane is chosen.
struct LaneChoiceParam {
  double search_radius = 5.0;            ///< [m] lanes farther to the side are not considered
  double max_heading_difference = 1.05;  ///< [rad] between a road user and its lane
  double preview_time = 1.2;             ///< [s] the lateral offset is judged as it will be then
  double offset_scale = 0.9;             ///< [m] of that offset, over which a lane's odds fall to 1/e
  double change_odds = 0.4;              ///< [-] of a lane beside the own one, the offset apart
  double turn_odds = 0.4;                ///< [-] of a branch that turns, against one that goes straight on
  double lateral_acceleration = 3.5;     ///< [m/s^2] that drivers take in curves
  double brake_scale = 1.0;              ///< [m/s^2] over which needed braking costs odds, above comfort
  double min_probability = 0.02;         ///< [-] lanes less likely than this get no trajectory
  double max_modes = 6.0;                ///< [-] trajectories a road user
};

/// How fast they will be.
struct SpeedParam {
  double acceleration_time = 1.5;       ///< [s] an acceleration fades to 1/e where nobody is ahead
  double follow_time = 0.8;             ///< [s] the same behind a leader: then it is the leader who counts
  double follow_gain = 0.25;            ///< [1/s] towards the speed that the gap allows
  double follow_difference_gain = 0.4;  ///< [1/s] towards the leader's speed
  double standstill_gap = 2.5;          ///< [m] bumper to bumper
  double min_headway = 0.4;             ///< [s] bounds of the headway that a driver is seen to keep
  double max_headway = 1.3;             ///< [s]
  double follow_horizon = 60.0;         ///< [m] leaders beyond it don't count
  double comfortable_braking = 2.0;     ///< [m/s^2] before curves
  double max_braking = 6.0;             ///< [m/s^2]
  double max_acceleration = 2.5;        ///< [m/s^2]
};

/// How far off a prediction may be, beyond what is not known of now: an error of speed and one of
/// acceleration, both for the whole horizon. 99 % of errors on recorded traffic lie within three of these
/// deviations.
struct SpreadParam {
  double along_speed = 1.35;              ///< [m/s] of vehicles and bicycles
  double along_acceleration = 0.46;       ///< [m/s^2]
  double across_speed = 0.55;             ///< [m/s] it may take another way than the likeliest
  double across_acceleration = 0.4;       ///< [m/s^2]
  double pedestrian_speed = 0.27;         ///< [m/s] in any direction
  double pedestrian_acceleration = 0.07;  ///< [m/s^2]
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

/// Who is evaluated and predicted by what, where the preset is not to decide; empty: as it has it.
struct ServiceParam {
  std::string evaluator;  ///< cost, keep_lane or mlp
  std::string
      predictor;  ///< move_sequence, lane_sequence, single_lane, free_move, extrapolation, regional ...
};
struct ServicesParam {
  ServiceParam on_lane, off_lane;
  std::string interactive_predictor;  ///< on a lane, where its way and the vehicle's meet
};

struct PredictionConfig {
  RoadUserStoreParam store;
  MotionFilterParam filter;
  LaneChoiceParam lane;
  SpeedParam speed;
  SpreadParam spread;
  PriorityParam priority;
  std::string selection = "default";  ///< or "navi": the preset of which evaluator and predictor serve whom
  ServicesParam vehicle, bicycle, pedestrian, unknown;  ///< what differs from it
  std::string network;                                  ///< file of the network that the evaluator mlp runs

  /// Every fault as one sentence that names the parameter and its value; empty: fit to run with.
  std::vector<std::string> validate() const;
};

/// Calls visit(name, member) for every parameter: what reads, writes or checks them goes through here.
template <class Config, class Visitor>
void visit_parameters(Config& config, Visitor&& visit) {
  visit("selection", config.selection);
  visit("network", config.network);
  const auto visit_services = [&](const std::string& type, auto& services) {
    const auto visit_service = [&](const std::string& where, auto& service) {
      visit("services/" + type + "/" + where + "/evaluator", service.evaluator);
      visit("services/" + type + "/" + where + "/predictor", service.predictor);
    };
    visit_service("on_lane", services.on_lane);
    visit_service("off_lane", services.off_lane);
    visit("services/" + type + "/interactive/predictor", services.interactive_predictor);
  };
  visit_services("vehicle", config.vehicle);
  visit_services("bicycle", config.bicycle);
  visit_services("pedestrian", config.pedestrian);
  visit_services("unknown", config.unknown);
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
  visit("filter/min_pedestrian_stddev", filter.min_pedestrian_stddev);
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
  auto& spread = config.spread;
  visit("spread/along_speed", spread.along_speed);
  visit("spread/along_acceleration", spread.along_acceleration);
  visit("spread/across_speed", spread.across_speed);
  visit("spread/across_acceleration", spread.across_acceleration);
  visit("spread/pedestrian_speed", spread.pedestrian_speed);
  visit("spread/pedestrian_acceleration", spread.pedestrian_acceleration);
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
