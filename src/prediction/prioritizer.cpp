#include "relative_map/prediction/prioritizer.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace relative_map::core {

namespace {

constexpr double kLooksAhead = 3.0;      // [s] in which a pedestrian's way counts
constexpr double kBehind = -2.0;         // [m] pedestrians farther behind the vehicle don't matter
constexpr double kJunctionMargin = 1.0;  // [m] around a junction
constexpr double kWayStep = 2.0;         // [m]

/// A polygon's inside, and [m] around it.
bool in_junction(const JunctionArea& junction, const Point2& point, double margin) {
  bool inside = false;
  double nearest = 1e12;
  const Polyline& border = junction.border;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Point2 &a = border[i], &b = border[(i + 1) % border.size()];
    nearest = std::min(nearest, project_on_segment(a, b, point).squared_distance);
    if ((a.y() > point.y()) != (b.y() > point.y()) &&
        point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
  return inside || nearest <= margin * margin;
}

bool is_person(RoadUserType type) {
  return type == RoadUserType::kPedestrian || type == RoadUserType::kBicycle ||
         type == RoadUserType::kUnknown;
}

/// The lanes that the vehicle will drive on, as a way from where it is.
struct EgoWay {
  std::vector<LaneSequence> paths;
  std::set<std::size_t> lanes;

  double distance_to(const Point2& point, double reach) const {
    double best = 1e12;
    for (const LaneSequence& path : paths) {
      std::size_t hint = 0;
      for (double s = 0.0; s <= reach; s += kWayStep) {
        best = std::min(best, (path.at(path.place().s + s, hint).position - point).norm());
      }
    }
    return best;
  }
};

EgoWay ego_way(const LaneView& lanes, const EgoVehicle& ego, const std::vector<LanePlace>& places,
               double reach) {
  EgoWay way;
  const LanePlace* nearest = nullptr;
  for (const LanePlace& place : places) {
    if (std::abs(angle_difference(place.theta, ego.pose.heading())) > kPi / 4.0) continue;
    const bool target = std::find(lanes.ego_targets().begin(), lanes.ego_targets().end(), place.lane) !=
                        lanes.ego_targets().end();
    if (place.lane == lanes.ego_lane() || target) sequences_from(lanes, place, reach, reach, 4, way.paths);
    if (nearest == nullptr || std::abs(place.l) < std::abs(nearest->l)) nearest = &place;
  }
  if (way.paths.empty() && nearest != nullptr) sequences_from(lanes, *nearest, reach, reach, 4, way.paths);
  for (const LaneSequence& path : way.paths) way.lanes.insert(path.lanes().begin(), path.lanes().end());
  return way;
}

bool is_ignored(const Situation& situation, const LaneView& lanes, const EgoVehicle& ego,
                const PriorityParam& param) {
  const Point2 local = ego.pose.to_local(situation.position());
  if (local.x() >= 0.0 && local.x() <= param.ahead && std::abs(local.y()) <= param.beside) return false;
  if (!situation.options.empty()) return false;
  for (const JunctionArea& junction : lanes.junctions()) {
    if (in_junction(junction, situation.position(), kJunctionMargin)) return false;
  }
  if (is_person(situation.user->type()) && local.x() > kBehind) {
    std::vector<LanePlace> places;
    lanes.places(situation.position(), param.pedestrian_distance, places, 0.0);
    if (!places.empty()) return false;
  }
  return true;
}

/// The next ones ahead and behind on each of the vehicle's paths.
void next_on(const EgoWay& way, const std::vector<Situation>& situations, const PriorityParam& param,
             std::set<std::size_t>& caution) {
  for (const LaneSequence& path : way.paths) {
    std::size_t ahead = situations.size(), behind = situations.size();
    double nearest_ahead = param.caution_range, nearest_behind = -param.caution_range;
    for (std::size_t i = 0; i < situations.size(); ++i) {
      for (const LanePlace& place : situations[i].places) {
        for (std::size_t k = 0; k < path.lanes().size(); ++k) {
          if (path.lanes()[k] != place.lane || std::abs(place.l) > 2.0) continue;
          const double s = path.start_of(k) + place.s - path.place().s;
          if (s >= 0.0 && s < nearest_ahead) {
            nearest_ahead = s;
            ahead = i;
          } else if (s < 0.0 && s > nearest_behind) {
            nearest_behind = s;
            behind = i;
          }
        }
      }
    }
    if (ahead < situations.size()) caution.insert(ahead);
    if (behind < situations.size()) caution.insert(behind);
  }
}

/// Whether its likeliest way comes onto one of the vehicle's lanes, from outside, or passes over it.
bool comes_onto(const Situation& situation, const EgoWay& way, double reach) {
  const LaneOption* best = situation.best();
  if (best == nullptr || way.lanes.empty() || way.lanes.count(best->path.place().lane) > 0) return false;
  for (std::size_t k = 1; k < best->path.lanes().size(); ++k) {
    const double ahead = best->path.start_of(k) - best->path.place().s;
    if (ahead > reach) break;
    if (way.lanes.count(best->path.lanes()[k]) > 0) return true;
  }
  std::size_t hint = 0;
  for (double s = 0.0; s <= reach; s += 2.0 * kWayStep) {
    if (way.distance_to(best->path.at(best->path.place().s + s, hint).position, reach) < 1.5) return true;
  }
  return false;
}

bool walks_near(const Situation& situation, const EgoWay& way, const PriorityParam& param) {
  if (situation.user->type() != RoadUserType::kPedestrian || way.paths.empty()) return false;
  const Point2 soon = situation.position() + kLooksAhead * situation.filter.velocity();
  const Point2 middle = 0.5 * (situation.position() + soon);
  for (const Point2& point : {situation.position(), middle, soon}) {
    if (way.distance_to(point, param.caution_range) <= param.pedestrian_distance) return true;
  }
  return false;
}

}  // namespace

Scenario analyze_scenario(const LaneView& lanes, const EgoVehicle& ego,
                          const std::vector<LanePlace>& ego_places, const PriorityParam& param) {
  for (const JunctionArea& junction : lanes.junctions()) {
    if (!junction.controlled) continue;
    for (double s = 0.0; s <= param.junction_distance; s += 0.5) {
      if (in_junction(junction, ego.pose.to_parent({s, 0.0}), 0.0)) return Scenario::kJunction;
    }
  }
  const bool on_lane = std::any_of(ego_places.begin(), ego_places.end(), [&](const LanePlace& place) {
    return std::abs(angle_difference(place.theta, ego.pose.heading())) <= kPi / 4.0;
  });
  return on_lane ? Scenario::kCruise : Scenario::kUnknown;
}

void prioritize(std::vector<Situation>& situations, const LaneView& lanes, const EgoVehicle& ego,
                const std::vector<LanePlace>& ego_places, const PriorityParam& param) {
  const EgoWay way = ego_way(lanes, ego, ego_places, param.caution_range);
  std::set<std::size_t> caution;
  next_on(way, situations, param, caution);
  for (std::size_t i = 0; i < situations.size(); ++i) {
    Situation& situation = situations[i];
    situation.interactive = false;
    situation.priority = is_ignored(situation, lanes, ego, param) ? Priority::kIgnore : Priority::kNormal;
    const double distance = (situation.position() - ego.pose.position()).norm();
    if (distance > param.caution_distance) {
      caution.erase(i);
      continue;
    }
    const bool comes = comes_onto(situation, way, param.caution_range);
    if (comes || walks_near(situation, way, param)) caution.insert(i);
    situation.interactive = comes && situation.user->type() == RoadUserType::kVehicle;
  }
  std::vector<std::size_t> nearest(caution.begin(), caution.end());
  std::stable_sort(nearest.begin(), nearest.end(), [&](std::size_t a, std::size_t b) {
    return (situations[a].position() - ego.pose.position()).squaredNorm() <
           (situations[b].position() - ego.pose.position()).squaredNorm();
  });
  const auto most = static_cast<std::size_t>(param.max_caution);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (i < most) {
      situations[nearest[i]].priority = Priority::kCaution;
    } else {
      situations[nearest[i]].interactive = false;
    }
  }
}

}  // namespace relative_map::core
