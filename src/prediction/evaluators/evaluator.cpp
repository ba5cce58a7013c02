#include "relative_map/prediction/evaluators/evaluator.hpp"

#include <algorithm>
#include <numeric>

namespace relative_map::core {

void set_probabilities(const std::vector<double>& odds, std::vector<LaneOption>& options) {
  const double sum = std::accumulate(odds.begin(), odds.end(), 0.0);
  for (std::size_t i = 0; i < options.size(); ++i) {
    options[i].probability = sum > 0.0 ? odds[i] / sum : 1.0 / static_cast<double>(options.size());
  }
  std::stable_sort(options.begin(), options.end(),
                   [](const LaneOption& a, const LaneOption& b) { return a.probability > b.probability; });
}

}  // namespace relative_map::core
