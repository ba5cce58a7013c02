#include "relative_map/prediction/situation_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "relative_map/prediction/speed_model.hpp"

namespace relative_map::core {

namespace {

constexpr double kBranchTime = 5.0;         // [s] branches farther on are not told apart
constexpr double kLeastBranchReach = 25.0;  // [m] of one that stands
constexpr double kHorizon = 8.0;            // [s]
constexpr double kMargin = 40.0;            // [m] that it may gain on that
constexpr std::size_t kWaysPerPlace = 4;
constexpr std::size_t kMaxWays = 10;
constexpr double kTurnTime = 4.0;      // [s] a turn within them is one
constexpr double kBeside = 0.35;       // [rad] lanes beside the own one run along it
constexpr double kBesideMargin = 0.3;  // [m] by which a width may be wrong
constexpr double kPassingRoom = 0.6;   // [m] that drivers make by moving aside, before they wait
// Sizes where none is given [m], length and width.
constexpr double kVehicleSize[2] = {4.6, 1.9}, kBicycleSize[2] = {1.8, 0.6}, kPedestrianSize[2] = {0.6, 0.6};

const double* default_size(RoadUserType type) {
  if (type == RoadUserType::kPedestrian) return kPedestrianSize;
  return type == RoadUserType::kBicycle ? kBicycleSize : kVehicleSize;
}

bool may_use(RoadUserType type, LaneUse use) {
  switch (use) {
    // Bicycles ride beside the lanes of cars and across them: they go where they go.
    case LaneUse::kVehicles:
      return type != RoadUserType::kPedestrian && type != RoadUserType::kBicycle;
    case LaneUse::kBicycles:
      return type == RoadUserType::kBicycle;
    default:
      return false;
  }
}

LaneOption make_option(LaneSequence path, const Situation& situation, const LaneChoiceParam& param) {
  LaneOption option(std::move(path));
  const LanePlace& place = option.path.place();
  const ViewedLane& lane = option.path.view().lanes()[place.lane];
  option.l = place.l;
  option.half_width = place.l > 0.0 ? lane.left_width : lane.right_width;
  const Point2 across(-std::sin(place.theta), std::cos(place.theta));
  option.lateral_speed = situation.filter.velocity().dot(across);
  if (situation.still()) option.lateral_speed = 0.0;
  const double reach = std::max(kLeastBranchReach, kTurnTime * situation.speed);
  option.turn = option.path.turn(place.s, reach);
  option.bend = std::max(std::abs(option.turn), 2.0 * std::abs(option.path.chord_angle(place.s, reach)));
  option.braking =
      braking_for_curves(option.path, place.s, situation.speed, reach, param.lateral_acceleration);
  return option;
}

void find_ways(const LaneView& lanes, const LaneChoiceParam& param, Situation& situation) {
  const RoadUserType type = situation.user->type();
  lanes.places(situation.position(), param.search_radius, situation.places);
  auto& places = situation.places;
  places.erase(std::remove_if(places.begin(), places.end(),
                              [&](const LanePlace& place) {
                                return !may_use(type, lanes.lanes()[place.lane].use) ||
                                       std::abs(angle_difference(place.theta, situation.theta)) >
                                           param.max_heading_difference;
                              }),
               places.end());
  std::sort(places.begin(), places.end(),
            [](const LanePlace& a, const LanePlace& b) { return std::abs(a.l) < std::abs(b.l); });
  const auto inside = [&](const LanePlace& place) {
    const ViewedLane& lane = lanes.lanes()[place.lane];
    return std::abs(place.l) <= (place.l > 0.0 ? lane.left_width : lane.right_width) + kBesideMargin;
  };
  // The straight on from a lane's end counts only where there is no lane.
  const auto beyond = [&](const LanePlace& place) { return place.s > lanes.lanes()[place.lane].length; };
  if (std::any_of(places.begin(), places.end(),
                  [&](const auto& place) { return inside(place) && !beyond(place); })) {
    places.erase(std::remove_if(places.begin(), places.end(), beyond), places.end());
  }
  const bool on_lane = !places.empty() && inside(places.front());
  if (!on_lane) return;  // beside the road
  const double branch_reach = std::max(kLeastBranchReach, kBranchTime * situation.speed);
  const double reach = kHorizon * situation.speed + kMargin;
  std::vector<LaneSequence> paths;
  for (const LanePlace& place : places) {
    if (paths.size() >= kMaxWays) break;
    if (!inside(place) && std::abs(angle_difference(place.theta, places.front().theta)) > kBeside) continue;
    sequences_from(lanes, place, branch_reach, reach, kWaysPerPlace, paths);
  }
  for (LaneSequence& path : paths) {
    situation.options.push_back(make_option(std::move(path), situation, param));
  }
  // What all ways have in common is the bend of the road.
  double least = std::numeric_limits<double>::infinity();
  for (const LaneOption& option : situation.options) least = std::min(least, option.bend);
  for (LaneOption& option : situation.options) option.bend -= least;
}

Situation make_situation(const RoadUser& user, Time now, const LaneView& lanes,
                         const PredictionConfig& config) {
  Situation situation;
  situation.user = &user;
  situation.filter = user.filter_at(now, config.filter);
  situation.theta = user.theta();
  const Point2 forward = situation.forward();
  situation.speed = std::max(0.0, situation.filter.velocity().dot(forward));
  if (user.still()) situation.speed = 0.0;
  situation.acceleration = user.still() ? 0.0 : situation.filter.acceleration().dot(forward);
  const double* size = default_size(user.type());
  situation.half_length = 0.5 * (user.seen().length > 0.1 ? user.seen().length : size[0]);
  situation.half_width = 0.5 * (user.seen().width > 0.1 ? user.seen().width : size[1]);
  if (user.type() != RoadUserType::kPedestrian && user.theta_is_known()) {
    find_ways(lanes, config.lane, situation);
  }
  return situation;
}

/// Somebody on a lane.
struct OnLane {
  std::size_t index;
  double s, l;
  double half_length, half_width;  ///< along and across the lane
  double speed;                    ///< along it
};

}  // namespace

std::vector<Situation> build_situations(const std::vector<const RoadUser*>& users, Time now,
                                        const LaneView& lanes, const PredictionConfig& config) {
  std::vector<Situation> situations;
  situations.reserve(users.size());
  for (const RoadUser* user : users) situations.push_back(make_situation(*user, now, lanes, config));
  return situations;
}

void find_leaders(std::vector<Situation>& situations, const LaneView& lanes, const EgoVehicle& ego,
                  const std::vector<LanePlace>& ego_places, const SpeedParam& param) {
  std::vector<std::vector<OnLane>> on_lanes(lanes.lanes().size());
  std::vector<LanePlace> scratch;
  for (std::size_t i = 0; i < situations.size(); ++i) {
    const Situation& situation = situations[i];
    const std::vector<LanePlace>* places = &situation.places;
    if (places->empty()) {  // crosses the lanes, or stands on them
      lanes.places(situation.position(), 2.5, scratch, 0.0);
      places = &scratch;
    }
    for (const LanePlace& place : *places) {
      on_lanes[place.lane].push_back(
          {i, place.s, place.l, situation.half_extent(place.theta),
           situation.half_extent(place.theta + kPi / 2.0),
           std::max(0.0, situation.speed * std::cos(situation.theta - place.theta))});
    }
  }
  for (const LanePlace& place : ego_places) {
    const double angle = ego.pose.heading() - place.theta;
    if (std::abs(normalize_angle(angle)) > kPi / 3.0) continue;
    on_lanes[place.lane].push_back({situations.size(), place.s, place.l, 0.5 * kVehicleSize[0],
                                    0.5 * kVehicleSize[1], std::max(0.0, ego.speed * std::cos(angle))});
  }
  for (std::size_t i = 0; i < situations.size(); ++i) {
    if (!situations[i].drives_like_a_car()) continue;
    for (LaneOption& option : situations[i].options) {
      const double own_s = option.path.place().s;
      for (std::size_t k = 0; k < option.path.lanes().size(); ++k) {
        const double start = option.path.start_of(k) - own_s;
        if (start > param.follow_horizon || option.leader) break;
        for (const OnLane& other : on_lanes[option.path.lanes()[k]]) {
          const double ahead = start + other.s;
          if (other.index == i || ahead <= 0.0) continue;
          // In the way is what it would run into where both are now; a parked car that leaves room is passed.
          const double beside = std::abs(other.l - (option.inside() ? option.l : 0.0));
          if (beside > other.half_width + situations[i].half_width - kPassingRoom) continue;
          const double gap = std::max(0.0, ahead - other.half_length - situations[i].half_length);
          if (!option.leader || gap < option.leader->gap)
            option.leader = Leader{other.index, gap, other.speed};
        }
      }
    }
  }
}

SpeedProfile profile_of(const EgoVehicle& ego) {
  SpeedProfile profile;
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    profile.v[i] = std::max(0.0, ego.speed);
    profile.s[i] = profile.v[i] * kPredictionStep * static_cast<double>(i);
  }
  if (ego.trajectory.size() < 2) return profile;
  // The plan's points lie where it likes; past its end the last speed goes on.
  double s = 0.0;
  std::size_t next = 1;
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    const double t = kPredictionStep * static_cast<double>(i);
    while (next < ego.trajectory.size() && ego.trajectory[next].time <= t) {
      s += (ego.trajectory[next].position - ego.trajectory[next - 1].position).norm();
      ++next;
    }
    const TrajectoryPoint& before = ego.trajectory[next - 1];
    profile.v[i] = std::max(0.0, before.speed);
    profile.s[i] = s + profile.v[i] * std::max(0.0, t - before.time);
  }
  return profile;
}

}  // namespace relative_map::core
