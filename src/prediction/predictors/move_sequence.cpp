#include "relative_map/prediction/predictors/move_sequence.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/prediction/predictors/drawing.hpp"
#include "relative_map/prediction/predictors/free_move.hpp"
#include "relative_map/prediction/speed_model.hpp"

namespace relative_map::core {

namespace {

constexpr double kKeepTime = 20.0;          // [s] drivers hold their place beside the centerline of a map
constexpr double kKeptOffset = 0.9;         // [m] a car of 1.8 m in a lane of 3.5 m holds less
constexpr double kFullChange = 5.0;         // [s] for a change of lanes (Toledo and Zohar 2007: 4 to 6 s)
constexpr double kLaneSpacing = 3.5;        // [m]
constexpr double kShortestChange = 2.0;     // [s]
constexpr std::size_t kJudged = 50;         // moods are told apart by where they are after 5 s
constexpr double kMoodTime = 3.0;           // [s] in which a mood fades
constexpr double kSame = 0.5;               // [m] two ways that stay so near to each other are one
constexpr std::size_t kChoice = 30;         // after 3 s a lane has been chosen
constexpr std::size_t kLastBranch = 50;     // branches that part later than after 5 s are not told apart
constexpr double kStartProbability = 0.07;  // see free_move.cpp
constexpr double kStart = 1.0;              // [m/s^2]

/// A mood: so many standard deviations of the way along, and how often it is the nearest of all.
struct Mood {
  double deviations, probability;
};

/// The deviations are those that leave a normal distribution nearest to the likeliest; the probabilities are
/// its mass nearest to each.
std::vector<Mood> moods(std::size_t count) {
  switch (count) {
    case 0:
      return {};
    case 1:
      return {{0.0, 1.0}};
    case 2:
      return {{0.0, 0.6}, {-1.2, 0.4}};
    case 3:
      return {{0.0, 0.42}, {-1.1, 0.29}, {1.1, 0.29}};
    case 4:
      return {{0.0, 0.35}, {-0.9, 0.225}, {0.9, 0.325}, {-2.0, 0.10}};
    case 5:
      return {{0.0, 0.31}, {-0.8, 0.23}, {0.8, 0.23}, {-1.6, 0.115}, {1.6, 0.115}};
    default:
      return {{0.0, 0.28}, {-0.7, 0.22}, {0.7, 0.22}, {-1.4, 0.14}, {1.4, 0.10}, {-2.2, 0.04}};
  }
}

/// [m] of way that an urge of 1 m/s^2 makes until moods are told apart
double way_of_urge() {
  const double t = kPredictionStep * kJudged;
  return kMoodTime * t - kMoodTime * kMoodTime * (1.0 - std::exp(-t / kMoodTime));
}

/// A way, and the lane that it is on once lanes have been chosen.
struct Way {
  LaneOption option;
  std::string lane_id;
};

/// Where a way leads to by then, if it is driven as the likeliest one.
Point2 place_on(const LaneOption& option, const SpeedProfile& profile, std::size_t step) {
  const LaneSample sample = option.path.at(option.path.place().s + profile.s[step]);
  // Beside the centerline as far as the lane is kept: two ways are one if they lead to the same place.
  return sample.position;
}

/// The likeliest ways that differ, with the probability of those that do not; it sums to one.
std::vector<Way> distinct_ways(const Situation& situation, const LaneChoiceParam& param) {
  const auto gap = [&](const LaneOption& a, const LaneOption& b, std::size_t step) {
    return (place_on(a, situation.profile, step) - place_on(b, situation.profile, step)).norm();
  };
  std::vector<Way> ways;
  for (const LaneOption& option : situation.options) {
    if (option.probability < param.min_probability && !ways.empty()) break;
    const auto same = std::find_if(ways.begin(), ways.end(), [&](const Way& way) {
      return gap(way.option, option, kChoice) < kSame && gap(way.option, option, kLastBranch) < kSame;
    });
    if (same != ways.end()) {
      same->option.probability += option.probability;
      continue;
    }
    ways.push_back({option, lane_after_choice(option, situation.profile)});
    // What has not parted by then is one lane still, whatever the map calls its branches.
    for (const Way& way : ways) {
      if (gap(way.option, option, kChoice) < kSame) {
        ways.back().lane_id = way.lane_id;
        break;
      }
    }
  }
  std::stable_sort(ways.begin(), ways.end(),
                   [](const Way& a, const Way& b) { return a.option.probability > b.option.probability; });
  const std::size_t most = std::min<std::size_t>(3, static_cast<std::size_t>(param.max_modes));
  if (ways.size() > most) ways.erase(ways.begin() + static_cast<std::ptrdiff_t>(most), ways.end());
  double sum = 0.0;
  for (const Way& way : ways) sum += way.option.probability;
  for (Way& way : ways) way.option.probability /= sum;
  return ways;
}

/// How many moods each way gets, of `total`: the likelier, the more.
std::vector<std::size_t> shares(std::size_t ways, std::size_t total) {
  switch (ways) {
    case 1:
      return {total};
    case 2:
      return {total - total / 3, total / 3};
    default:
      return {total - total / 3 - total / 6, total / 3, total / 6};
  }
}

}  // namespace

LateralMove lateral_move(const LaneOption& option) {
  // Near its lane's border and on the way in: it is in the midst of a change.
  const bool comes_in = std::abs(option.l) > kKeptOffset && option.l * option.lateral_speed < 0.0;
  if (option.inside() && !comes_in) return LateralMove::keep(option.l, option.lateral_speed, kKeepTime);
  const double time =
      std::clamp(kFullChange * std::abs(option.l) / kLaneSpacing, kShortestChange, kFullChange);
  return LateralMove::change(option.l, option.lateral_speed, time);
}

std::vector<PredictedTrajectory> MoveSequencePredictor::predict(const PredictionContext& context,
                                                                const Situation& situation) const {
  const PredictionConfig& config = context.config;
  const std::vector<Way> ways = distinct_ways(situation, config.lane);
  if (ways.empty()) return {};
  const Spread spread = spread_of(situation, config.spread);
  const double urge_of_deviation = spread.along[kJudged] / way_of_urge();
  const auto total = static_cast<std::size_t>(config.lane.max_modes);
  const std::vector<std::size_t> counts = shares(ways.size(), total);
  std::vector<PredictedTrajectory> trajectories;
  for (std::size_t w = 0; w < ways.size(); ++w) {
    const LaneOption& way = ways[w].option;
    const double reach = std::max(20.0, 8.0 * situation.speed + 30.0);
    const CurveLimits curves(way.path, way.path.place().s, reach, config.lane.lateral_acceleration,
                             config.speed.comfortable_braking);
    LeadingVehicle leader;
    if (way.leader) {
      leader.gap = way.leader->gap;
      leader.profile = way.leader->index < context.situations.size()
                           ? &context.situations[way.leader->index].profile
                           : &context.ego_profile;
    }
    const auto draw = [&](double urge, double probability) {
      const Driver driver{situation.speed, situation.acceleration, urge, 0.0};
      const SpeedProfile profile = drive(driver, way.leader ? &leader : nullptr,
                                         situation.drives_like_a_car() ? &curves : nullptr, config.speed);
      trajectories.push_back(draw_on_way(situation, way, profile, lateral_move(way), spread));
      trajectories.back().probability = probability;
      trajectories.back().lane_id = ways[w].lane_id;
    };
    if (situation.still()) {
      draw(0.0, way.probability * (1.0 - kStartProbability));
      draw(kStart, way.probability * kStartProbability);
      continue;
    }
    for (const Mood& mood : moods(counts[w])) {
      draw(mood.deviations * urge_of_deviation, way.probability * mood.probability);
    }
  }
  std::stable_sort(trajectories.begin(), trajectories.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return trajectories;
}

}  // namespace relative_map::core
