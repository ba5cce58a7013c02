#include "relative_map/pipeline/estimation/which_lane.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kInLane = 0.5;          // [m] drivers keep to the middle
constexpr double kAnywhere = 0.05;       // [-] share of the belief that the vehicle is in no lane's middle
constexpr double kStray = 1e-3;          // [-] a lane's share, however far off localization puts the vehicle
constexpr double kDoubtTime = 2.0;       // [s] of paint that fits no lane, in which localization counts again
constexpr double kMisfit = 0.3;          // [-] likelihood of an image, below which it does not fit
constexpr double kRecording = 0.4;       // [m] at most, of a line from its lane's center
constexpr double kBorder = 0.2;          // [m] of paint from where the border is
constexpr double kFloor = 0.02;          // [-] of a marker's likelihood: paint is now and then something else
constexpr double kUnlined = 0.1;         // [-] that a lane without a line is beside one that has one
constexpr double kBothRate = 1.5;        // [1/s] independent images: a camera's errors last
constexpr double kOneRate = 1.0;         // [1/s] of one side
constexpr double kLongestImage = 0.2;    // [s] that one image counts for
constexpr double kNear = 0.9;            // [m] from the likeliest place: the same one
constexpr double kMostSpread = 4.0;      // [m^2] in one step: beyond, it is anywhere already
constexpr double kMostSideways = 100.0;  // [m] in one step: no vehicle
constexpr double kNothing = 1e-9;        // [-] of the belief in a cell: not worth a look
constexpr double kNarrowest = 2.2, kWidest = 5.5;  // [m] of a lane between paint

double bell(double distance, double stddev) {
  const double d = distance / stddev;
  return std::exp(-0.5 * d * d);
}

}  // namespace

WhichLane::Belief WhichLane::prior(const Road& road, double localized) const {
  Belief belief;
  for (int i = 0; i < kCells; ++i)
    belief[i] = kAnywhere * bell(offset_of(i) - localized, localization_stddev_);
  double all = 0.0;
  for (const double center : road.centers) all += bell(center - localized, localization_stddev_) + kStray;
  for (const double center : road.centers) {
    const double share = (bell(center - localized, localization_stddev_) + kStray) / all;
    for (int i = 0; i < kCells; ++i) belief[i] += share * bell(offset_of(i) - center, kInLane);
  }
  return belief / belief.sum();
}

void WhichLane::start(const Road& road, double localized) {
  if (!std::isfinite(localized)) localized = 0.0;
  origin_ = std::clamp(localized, -10.0, 10.0);
  localized_ = origin_;
  unspread_ = 0.0;
  started_ = true;
  belief_ = prior(road, localized);
}

void WhichLane::recenter() {
  const int cells = static_cast<int>(std::round(likeliest().offset - origin_) / kCell);
  if (std::abs(cells) < 20) return;
  Belief moved = Belief::Constant(1e-12);
  for (int i = 0; i < kCells; ++i) {
    if (i + cells >= 0 && i + cells < kCells) moved[i] = belief_[i + cells];
  }
  origin_ += kCell * cells;
  belief_ = moved / moved.sum();
}

void WhichLane::spread(double variance) {
  unspread_ = std::min(unspread_ + variance, kMostSpread);
  constexpr double kLeast = 0.05 * kCell * kCell, kMost = 0.5 * kCell * kCell;
  while (unspread_ > kLeast) {
    const double part = std::min(unspread_, kMost), share = 0.5 * part / (kCell * kCell);
    unspread_ -= part;
    Belief next = (1.0 - 2.0 * share) * belief_;
    next.tail<kCells - 1>() += share * belief_.head<kCells - 1>();
    next.head<kCells - 1>() += share * belief_.tail<kCells - 1>();
    belief_ = next;
  }
}

void WhichLane::move(double sideways, double stddev, double localized) {
  if (!started_ || !(std::abs(sideways) < kMostSideways) || !std::isfinite(stddev)) return;
  if (std::isfinite(localized)) localized_ = localized;
  origin_ += sideways;
  spread(stddev * stddev);
  recenter();
}

void WhichLane::see(const std::optional<Seen>& left, const std::optional<Seen>& right, double seconds,
                    const Road& road) {
  if (!started_ || (!left && !right)) return;
  const double width = left && right ? left->offset - right->offset : 0.0;
  const bool both = width > kNarrowest && width < kWidest;
  const double half_width = both ? 0.5 * width : road.half_width;
  // Where lanes are, and how likely there is one.
  struct Lane {
    double center, share;
  };
  std::vector<Lane> lanes;
  for (const double center : road.centers) lanes.push_back({center, 1.0});
  for (const double center : road.centers) {
    for (const double beside : {center - 2.0 * half_width, center + 2.0 * half_width}) {
      const bool known = std::any_of(road.centers.begin(), road.centers.end(),
                                     [&](double other) { return std::abs(other - beside) < half_width; });
      if (!known) lanes.push_back({beside, kUnlined});
    }
  }
  const double weight = std::min(seconds, kLongestImage) * (both ? kBothRate : kOneRate);
  // A recording's error is the same in every image: what lies within it is no evidence either way.
  const auto fit = [&](double off, double stddev, double share) {
    return share * bell(std::max(0.0, std::abs(off) - kRecording), stddev);
  };
  double expected = 0.0;  // likelihood of the image
  for (int i = 0; i < kCells; ++i) {
    if (belief_[i] < kNothing) {
      belief_[i] *= std::pow(kFloor, weight);
      continue;
    }
    const double u = offset_of(i);
    double likelihood = 0.0;
    for (const Lane& lane : lanes) {
      if (std::abs(u - lane.center) > half_width + 0.5) continue;  // it drives in another one
      double here = 1.0;
      if (both) {
        const double stddev = std::hypot(kBorder, 0.5 * std::hypot(left->stddev, right->stddev));
        here = fit(u + 0.5 * (left->offset + right->offset) - lane.center, stddev, lane.share);
      } else {
        const double width = road.half_width_stddev;
        if (left) {
          here *= kFloor + fit(u + left->offset - (lane.center + half_width),
                               std::sqrt(left->stddev * left->stddev + kBorder * kBorder + width * width),
                               lane.share);
        }
        if (right) {
          here *= kFloor + fit(u + right->offset - (lane.center - half_width),
                               std::sqrt(right->stddev * right->stddev + kBorder * kBorder + width * width),
                               lane.share);
        }
      }
      likelihood = std::max(likelihood, here);
    }
    expected += belief_[i] * likelihood;
    belief_[i] *= std::pow(kFloor + likelihood, weight);
  }
  belief_ /= belief_.sum();
  // Lanes look alike: what fits is no reason to doubt where the vehicle has come from. What does not, is.
  const double doubt =
      std::max(0.0, 1.0 - expected / kMisfit) * std::min(seconds, kLongestImage) / kDoubtTime;
  if (doubt > 0.0) belief_ = (1.0 - doubt) * belief_ + doubt * prior(road, localized_);
}

WhichLane::Place WhichLane::likeliest() const {
  int best = 0;
  belief_.maxCoeff(&best);
  const int reach = static_cast<int>(kNear / kCell);
  double share = 0.0, mean = 0.0, square = 0.0;
  for (int i = std::max(0, best - reach); i <= std::min(kCells - 1, best + reach); ++i) {
    const double off = kCell * (i - best);
    share += belief_[i];
    mean += belief_[i] * off;
    square += belief_[i] * off * off;
  }
  if (!(share > 0.0)) return {};
  mean /= share;
  return {offset_of(best) + mean, std::sqrt(std::max(0.0, square / share - mean * mean)),
          share / belief_.sum()};
}

double WhichLane::share_near(double offset) const {
  double share = 0.0;
  for (int i = 0; i < kCells; ++i) {
    if (std::abs(offset_of(i) - offset) <= kNear) share += belief_[i];
  }
  return share / belief_.sum();
}

double WhichLane::share_alike(const Place& place, const Road& road) const {
  const auto nearer = [&](double a, double b) {
    return std::abs(place.offset - a) < std::abs(place.offset - b);
  };
  const double center = *std::min_element(road.centers.begin(), road.centers.end(), nearer);
  if (std::abs(place.offset - center) > road.half_width) return place.share;  // in a lane without a line
  double share = 0.0;
  for (const double other : road.centers) {
    if (std::abs(other - center) > road.half_width || other == center) {
      share += share_near(other + place.offset - center);
    }
  }
  return share;
}

}  // namespace relative_map::core
