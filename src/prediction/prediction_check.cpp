#include "relative_map/prediction/prediction_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace relative_map::core {

namespace {

using Fault = std::optional<std::string>;

constexpr double kTimeTolerance = 1e-6;  // [s]
constexpr double kFirstPoint = 1e-3;     // [m]
// Of 0.3 rad between theta and the chord around a point.
const double kCosThetaTolerance = std::cos(0.3);
constexpr double kLongestChord = 0.2;  // [m] a shorter chord has no direction to compare with
constexpr double kSumTolerance = 1e-6;
// What a car can do, with something to spare: full braking on dry asphalt, and its grip across.
constexpr double kMaxAcceleration = 8.0;  // [m/s^2]
constexpr double kMaxLateral = 10.0;      // [m/s^2] over a second
constexpr double kMaxSpeed = 85.0;        // [m/s]
constexpr double kSpeedTolerance = 0.15;  // of the speed against its points, relative, and
constexpr double kSpeedSlack = 0.5;       // [m/s] absolute
constexpr double kBackward = 0.05;        // [m] a step against theta
constexpr std::size_t kTurnSteps = 10;    // a second

template <class... Parts>
Fault fault(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

Fault check_finite(const PredictedRoadUser&, const PredictedTrajectory& trajectory) {
  if (!std::isfinite(trajectory.probability)) return fault("its probability is not finite");
  for (const TrajectoryPoint& point : trajectory.points) {
    if (!point.position.allFinite() || !std::isfinite(point.theta) || !std::isfinite(point.speed) ||
        !std::isfinite(point.acceleration) || !std::isfinite(point.time) || !(point.sigma_along >= 0.0) ||
        !(point.sigma_across >= 0.0) || !std::isfinite(point.sigma_along + point.sigma_across)) {
      return fault("the point at ", point.time, " s is not finite");
    }
  }
  return std::nullopt;
}

Fault check_times(const PredictedRoadUser&, const PredictedTrajectory& trajectory) {
  if (trajectory.points.size() != kPredictionPoints)
    return fault("it has ", trajectory.points.size(), " points");
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    const double time = kPredictionStep * static_cast<double>(i);
    if (std::abs(trajectory.points[i].time - time) > kTimeTolerance) {
      return fault("point ", i, " is at ", trajectory.points[i].time, " s");
    }
  }
  return std::nullopt;
}

Fault check_start(const PredictedRoadUser& user, const PredictedTrajectory& trajectory) {
  const double gap = (trajectory.points.front().position - user.position).norm();
  return gap <= kFirstPoint ? std::nullopt : fault("it starts ", gap, " m beside the road user");
}

Fault check_speed(const PredictedRoadUser&, const PredictedTrajectory& trajectory) {
  const auto& points = trajectory.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].speed < 0.0)
      return fault("it drives at ", points[i].speed, " m/s at ", points[i].time, " s");
    if (points[i].speed > kMaxSpeed) return fault("it drives at ", points[i].speed, " m/s");
    if (i == 0 || i + 1 == points.size()) continue;
    const double chord = (points[i + 1].position - points[i - 1].position).norm() / (2.0 * kPredictionStep);
    if (std::abs(chord - points[i].speed) > kSpeedTolerance * points[i].speed + kSpeedSlack) {
      return fault("its speed is ", points[i].speed, " m/s at ", points[i].time, " s, its points' ", chord);
    }
  }
  return std::nullopt;
}

Fault check_theta(const PredictedRoadUser&, const PredictedTrajectory& trajectory) {
  const auto& points = trajectory.points;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Point2 chord = points[i + 1].position - points[i - 1].position;
    const double length = chord.norm();
    if (length < kLongestChord) continue;
    const double ahead = chord.x() * std::cos(points[i].theta) + chord.y() * std::sin(points[i].theta);
    if (ahead >= kCosThetaTolerance * length) continue;
    const double off = angle_difference(points[i].theta, std::atan2(chord.y(), chord.x()));
    return fault("theta is ", off, " rad off its points' at ", points[i].time, " s");
  }
  return std::nullopt;
}

Fault check_acceleration(const PredictedRoadUser&, const PredictedTrajectory& trajectory) {
  for (const TrajectoryPoint& point : trajectory.points) {
    if (std::abs(point.acceleration) > kMaxAcceleration) {
      return fault("its acceleration is ", point.acceleration, " m/s^2 at ", point.time, " s");
    }
  }
  return std::nullopt;
}

Fault check_turn(const PredictedRoadUser&, const PredictedTrajectory& trajectory) {
  const auto& points = trajectory.points;
  for (std::size_t i = 0; i + kTurnSteps < points.size(); ++i) {
    const TrajectoryPoint &a = points[i], &b = points[i + kTurnSteps];
    const double rate =
        angle_difference(b.theta, a.theta) / (kPredictionStep * static_cast<double>(kTurnSteps));
    const double lateral = std::abs(rate) * 0.5 * (a.speed + b.speed);
    if (lateral > kMaxLateral) return fault("it turns with ", lateral, " m/s^2 at ", a.time, " s");
    // A U-turn takes its time and its way.
    if (std::abs(rate) > 2.0 && (b.position - a.position).norm() < 2.0) {
      return fault("it turns by ", rate, " rad within a second on the spot at ", a.time, " s");
    }
  }
  return std::nullopt;
}

Fault check_forward(const PredictedRoadUser&, const PredictedTrajectory& trajectory) {
  const auto& points = trajectory.points;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Point2 step = points[i + 1].position - points[i].position;
    if (step.squaredNorm() < kBackward * kBackward) continue;
    const double ahead = step.x() * std::cos(points[i].theta) + step.y() * std::sin(points[i].theta);
    if (ahead < -kBackward) return fault("it drives backwards by ", -ahead, " m at ", points[i].time, " s");
  }
  return std::nullopt;
}

struct Row {
  const char* name;
  Fault (*check)(const PredictedRoadUser&, const PredictedTrajectory&);
};

// The later ones look at points that the first two vouch for.
constexpr Row kRows[] = {{"finite", check_finite}, {"times", check_times},
                         {"start", check_start},   {"speed", check_speed},
                         {"theta", check_theta},   {"acceleration", check_acceleration},
                         {"turn", check_turn},     {"forward", check_forward}};

constexpr const char* kProbabilities = "probabilities";
constexpr const char* kEveryRoadUser = "every road user";

void note(std::vector<PredictionFault>& faults, const PredictedRoadUser& user, const char* row,
          const std::string& what) {
  const bool known = std::any_of(faults.begin(), faults.end(), [&](const auto& f) { return f.row == row; });
  if (!known) faults.push_back({row, "road user " + std::to_string(user.seen.id) + ": " + what});
}

}  // namespace

std::vector<std::string> prediction_check_rows() {
  std::vector<std::string> rows;
  for (const Row& row : kRows) rows.emplace_back(row.name);
  rows.emplace_back(kProbabilities);
  rows.emplace_back(kEveryRoadUser);
  return rows;
}

std::vector<PredictionFault> check_trajectory(const PredictedRoadUser& user,
                                              const PredictedTrajectory& trajectory) {
  std::vector<PredictionFault> faults;
  for (const Row& row : kRows) {
    const Fault found = row.check(user, trajectory);
    if (!found) continue;
    note(faults, user, row.name, *found);
    if (row.check == check_finite || row.check == check_times) break;
  }
  return faults;
}

std::vector<PredictionFault> check_prediction(const Prediction& prediction) {
  std::vector<PredictionFault> faults;
  for (const PredictedRoadUser& user : prediction.users) {
    if (user.trajectories.empty()) note(faults, user, kEveryRoadUser, "it has no trajectory");
    double sum = 0.0;
    for (const PredictedTrajectory& trajectory : user.trajectories) {
      for (const PredictionFault& found : check_trajectory(user, trajectory)) {
        const bool known =
            std::any_of(faults.begin(), faults.end(), [&](const auto& f) { return f.row == found.row; });
        if (!known) faults.push_back(found);
      }
      if (trajectory.probability < 0.0 || trajectory.probability > 1.0 + kSumTolerance) {
        note(faults, user, kProbabilities, "one is " + std::to_string(trajectory.probability));
      }
      sum += trajectory.probability;
    }
    if (!user.trajectories.empty() && !(std::abs(sum - 1.0) <= kSumTolerance)) {
      note(faults, user, kProbabilities, "they sum to " + std::to_string(sum));
    }
  }
  return faults;
}

}  // namespace relative_map::core
