#include "relative_map/prediction/speed_model.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kCurveStep = 2.0;      // [m]
constexpr double kStraight = 0.004;     // [1/m] a curve of 250 m bothers nobody
constexpr double kNoLimit = 100.0;      // [m/s]
constexpr double kSlowestCurve = 2.5;   // [m/s] nobody stops for a curve
constexpr double kCurveResponse = 0.5;  // [s] in which speed is brought down to what a curve allows
constexpr double kHardBraking = 4.0;    // [m/s^2] until then a leader may still make way
constexpr double kBumper = 0.2;         // [m] nearer nobody stops
constexpr double kTouch = 1.0;          // [m] who is nearer already drives beside its leader, not into it
constexpr double kUrgeTime = 3.0;       // [s] in which a mood fades

double curve_speed(double kappa, double lateral_acceleration) {
  if (std::abs(kappa) < kStraight) return kNoLimit;
  return std::max(kSlowestCurve, std::sqrt(lateral_acceleration / std::abs(kappa)));
}

/// [m/s^2] that bring it to the speed of a leader which goes on as fast as it does
double braking_behind(double speed, double leader_speed, double gap) {
  const double closing = std::max(0.0, speed - leader_speed);
  return 0.5 * closing * closing / std::max(gap, 0.05);
}

bool bends(const LaneSequence& path) {
  return std::any_of(path.lanes().begin(), path.lanes().end(),
                     [&](std::size_t lane) { return path.view().lanes()[lane].sharpest >= kStraight; });
}

}  // namespace

CurveLimits::CurveLimits(const LaneSequence& path, double s, double reach, double lateral_acceleration,
                         double braking) {
  if (!bends(path)) return;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(reach / kCurveStep))) + 1;
  limits_.resize(count);
  std::size_t hint = 0;
  for (std::size_t i = 0; i < count; ++i) {
    limits_[i] =
        curve_speed(path.at(s + kCurveStep * static_cast<double>(i), hint).kappa, lateral_acceleration);
  }
  for (std::size_t i = count - 1; i-- > 0;) {
    limits_[i] =
        std::min(limits_[i], std::sqrt(limits_[i + 1] * limits_[i + 1] + 2.0 * braking * kCurveStep));
  }
}

double CurveLimits::at(double progress) const {
  if (limits_.empty()) return kNoLimit;
  const double place = std::clamp(progress / kCurveStep, 0.0, static_cast<double>(limits_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(place), limits_.size() - 1);
  const std::size_t next = std::min(i + 1, limits_.size() - 1);
  return limits_[i] + (place - static_cast<double>(i)) * (limits_[next] - limits_[i]);
}

double braking_for_curves(const LaneSequence& path, double s, double speed, double reach,
                          double lateral_acceleration) {
  if (!bends(path)) return 0.0;
  double braking = 0.0;
  std::size_t hint = 0;
  for (double ahead = kCurveStep; ahead < reach; ahead += kCurveStep) {
    const double limit = curve_speed(path.at(s + ahead, hint).kappa, lateral_acceleration);
    braking = std::max(braking, (speed * speed - limit * limit) / (2.0 * ahead));
  }
  return braking;
}

SpeedProfile drive(const Driver& driver, const LeadingVehicle* leader, const CurveLimits* curves,
                   const SpeedParam& param) {
  SpeedProfile profile;
  double s = 0.0, v = driver.speed;
  const double headway = leader == nullptr
                             ? 0.0
                             : std::clamp((leader->gap - param.standstill_gap) / std::max(v, 0.1),
                                          param.min_headway, param.max_headway);
  const bool follows = leader != nullptr && leader->gap < param.follow_horizon;
  const double fade = std::exp(-kPredictionStep / (follows ? param.follow_time : param.acceleration_time));
  const double urge_fade = std::exp(-kPredictionStep / kUrgeTime);
  const double start = std::clamp(driver.acceleration, -param.max_braking, param.max_acceleration);
  double own = 1.0, urge = driver.urge;  // what is left of what it does now
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    double a = own * start, needed = 0.0;
    if (follows) {
      const double gap = std::max(0.0, leader->gap + leader->profile->s[i] - s);
      // Nobody goes faster than it does now only because the road ahead is free, unless it is held up now.
      const double free_speed = std::max(driver.speed, leader->profile->v[i]);
      const double wanted = std::clamp((gap - param.standstill_gap) / headway, 0.0, free_speed);
      const double following =
          param.follow_gain * (wanted - v) +
          param.follow_difference_gain * (leader->profile->v[i] - v) *
              std::clamp(2.0 - gap / std::max(10.0, 2.0 * param.max_headway * v), 0.0, 1.0);
      a += (1.0 - own) * following;
      const double braking = braking_behind(v, leader->profile->v[i], gap - kBumper);
      if (leader->gap > kTouch && (braking > kHardBraking || gap < kTouch)) needed = braking;
    }
    a += urge;
    // Nobody runs into the one ahead, in whatever mood.
    if (needed > 0.0) a = std::min(a, -needed);
    if (curves != nullptr) a = std::min(a, (curves->at(s) - v) / kCurveResponse);
    a = std::clamp(a, -param.max_braking, param.max_acceleration);
    if (v <= 0.0) a = std::max(a, 0.0);
    profile.s[i] = s;
    profile.v[i] = v;
    profile.a[i] = a;
    const double next = std::max(0.0, v + a * kPredictionStep);
    s += 0.5 * (v + next) * kPredictionStep;
    v = next;
    own *= fade;
    urge *= urge_fade;
  }
  return profile;
}

namespace {

class TrafficFlow {
 public:
  TrafficFlow(std::vector<Situation>& situations, const SpeedProfile& ego, double lateral_acceleration,
              const SpeedParam& param)
      : situations_(situations),
        ego_(ego),
        lateral_acceleration_(lateral_acceleration),
        param_(param),
        state_(situations.size(), State::kOpen) {}

  /// Its leader first. In a circle of followers the one that closes it is taken as it drives now.
  void drive_one(std::size_t index) {
    if (state_[index] != State::kOpen) return;
    state_[index] = State::kBegun;
    Situation& situation = situations_[index];
    Driver driver{situation.speed, situation.acceleration, 0.0, 0.0};
    const LaneOption* best = situation.best();
    if (best == nullptr) {
      situation.profile = drive(driver, nullptr, nullptr, param_);
      state_[index] = State::kDone;
      return;
    }
    const double s = best->path.place().s;
    if (!situation.drives_like_a_car()) {
      situation.profile = drive(driver, nullptr, nullptr, param_);
      state_[index] = State::kDone;
      return;
    }
    const CurveLimits curves(best->path, s, std::max(20.0, 8.0 * situation.speed + 30.0),
                             lateral_acceleration_, param_.comfortable_braking);
    LeadingVehicle leader;
    SpeedProfile steady;
    if (best->leader) {
      leader.gap = best->leader->gap;
      leader.profile = profile_of(*best->leader, steady);
    }
    situation.profile = drive(driver, best->leader ? &leader : nullptr, &curves, param_);
    state_[index] = State::kDone;
  }

 private:
  enum class State { kOpen, kBegun, kDone };

  const SpeedProfile* profile_of(const Leader& leader, SpeedProfile& steady) {
    if (leader.index >= situations_.size()) return &ego_;
    drive_one(leader.index);
    if (state_[leader.index] == State::kDone) return &situations_[leader.index].profile;
    steady = drive({situations_[leader.index].speed, 0.0, 0.0, 0.0}, nullptr, nullptr, param_);
    return &steady;
  }

  std::vector<Situation>& situations_;
  const SpeedProfile& ego_;
  double lateral_acceleration_;
  const SpeedParam& param_;
  std::vector<State> state_;
};

}  // namespace

void drive_all(std::vector<Situation>& situations, const SpeedProfile& ego, double lateral_acceleration,
               const SpeedParam& param) {
  TrafficFlow flow(situations, ego, lateral_acceleration, param);
  for (std::size_t i = 0; i < situations.size(); ++i) flow.drive_one(i);
}

}  // namespace relative_map::core
