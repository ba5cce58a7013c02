#include "relative_map/simulation/marker_errors.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr std::size_t kLeft = 0, kRight = 1, kNextLeft = 2, kNextRight = 3, kImage = 4, kRoles = 5;
constexpr double kNeighborNoise = 2.0;  // of paint a lane farther away, times as large

double size_of(std::size_t role, double common_share) {
  if (role == kImage) return std::sqrt(common_share);
  return (role == kNextLeft || role == kNextRight ? kNeighborNoise : 1.0) * std::sqrt(1.0 - common_share);
}

}  // namespace

MarkerErrors::MarkerErrors(const MarkerErrorParam& param, const CubicNoise& noise, std::uint64_t seed)
    : param_(param),
      view_range_change_(param.view_range_change, param.view_range_time, NoiseSource(seed, 30)),
      dropouts_(param.dropout, seed, 31),
      outliers_(param.outlier, seed, 32),
      blind_(param.blind, seed, 34),
      latency_(random_engine(seed, 33)) {
  std::uint32_t stream = 40;
  for (std::size_t role = 0; role < kRoles; ++role) {
    for (const double coefficient : {noise.c0, noise.c1, noise.c2, noise.c3}) {
      const double size = size_of(role, param.common_share) * coefficient;
      const double lasting = size * std::sqrt(param.correlated_share);
      noises_.push_back({NoiseSource(seed, stream),
                         OrnsteinUhlenbeck(lasting, param.correlation_time, NoiseSource(seed, stream + 1)),
                         size * std::sqrt(1.0 - param.correlated_share)});
      stream += 2;
    }
  }
}

double MarkerErrors::view_range(double view_range, double time) {
  const double changed = view_range + view_range_change_.at(time);
  if (param_.view_range_change == 0.0) return view_range;
  return std::clamp(changed, param_.min_view_range, param_.max_view_range);
}

Cubic MarkerErrors::draw_noise(std::size_t role, double time) {
  std::array<double, 4> errors{};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    Noise& noise = noises_[4 * role + i];
    errors[i] = noise.white.draw(noise.white_size) + noise.lasting.at(time);
  }
  return {errors[0], errors[1], errors[2], errors[3]};
}

void MarkerErrors::spoil(LaneMarkers& markers, double time) {
  const Cubic common = draw_noise(kImage, time);
  LaneMarker unseen;  // noise is drawn for it, too: what is seen later does not depend on it
  const auto add_noise = [&](LaneMarker& marker, std::size_t role) {
    const Cubic own = draw_noise(role, time);
    marker.cubic.c0 += common.c0 + own.c0;
    marker.cubic.c1 += common.c1 + own.c1;
    marker.cubic.c2 += common.c2 + own.c2;
    marker.cubic.c3 += common.c3 + own.c3;
  };
  add_noise(markers.left, kLeft);
  add_noise(markers.right, kRight);
  add_noise(markers.next_left.empty() ? unseen : markers.next_left.front(), kNextLeft);
  add_noise(markers.next_right.empty() ? unseen : markers.next_right.front(), kNextRight);
  if (const Episode* outlier = outliers_.at(time)) {
    const double jump = std::copysign(
        param_.min_jump + std::abs(outlier->size) * (param_.max_jump - param_.min_jump), outlier->size);
    if (outlier->left) markers.left.cubic.c0 += jump;
    if (outlier->right) markers.right.cubic.c0 += jump;
  }
  if (const Episode* dropout = dropouts_.at(time)) {
    if (dropout->left) markers.left = {};
    if (dropout->right) markers.right = {};
    if (dropout->left) markers.next_left.clear();
    if (dropout->right) markers.next_right.clear();
  }
  if (blind_.at(time) != nullptr) {
    markers.left = markers.right = {};
    markers.next_left.clear();
    markers.next_right.clear();
  }
  // Noise is not paint.
  if (markers.left.quality == 0.0) markers.left = {};
  if (markers.right.quality == 0.0) markers.right = {};
  for (std::vector<LaneMarker>* next : {&markers.next_left, &markers.next_right}) {
    if (!next->empty() && next->front().quality == 0.0) next->clear();
  }
}

double MarkerErrors::draw_latency() {
  return std::uniform_real_distribution<double>(param_.min_latency, param_.max_latency)(latency_);
}

}  // namespace relative_map::core
