#include "relative_map/simulation/transmission.hpp"

#include <algorithm>

#include "relative_map/simulation/random_process.hpp"

namespace relative_map::core {

namespace {

constexpr Duration kAgain = std::chrono::milliseconds(5);  // from a message to its repetition

}  // namespace

Transmission::Transmission(const TransmissionParam& param, std::uint64_t seed, std::uint32_t stream)
    : param_(param), engine_(random_engine(seed, stream)) {}

std::vector<Time> Transmission::arrivals(Time stamp) {
  std::uniform_real_distribution<double> share(0.0, 1.0), latency(param_.min_latency, param_.max_latency);
  // All are drawn for every message: one fault does not move another.
  const bool lost = share(engine_) < param_.lost, repeated = share(engine_) < param_.repeated,
             late = share(engine_) < param_.late;
  const double late_by = param_.late_by * share(engine_);
  const Time arrival = std::max(last_, stamp + from_seconds(latency(engine_)));
  if (lost) return {};
  if (late) return {arrival + from_seconds(late_by)};
  last_ = arrival;
  if (repeated) return {arrival, arrival + kAgain};
  return {arrival};
}

}  // namespace relative_map::core
