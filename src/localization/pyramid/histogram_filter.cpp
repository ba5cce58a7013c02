#include <algorithm>
#include <cmath>

#include "relative_map/localization/pyramid/pyramid_matcher.hpp"

namespace relative_map::core {

double ShiftHistogram::at(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d cells = (place - centre) / cell_size;
  const int x = static_cast<int>(std::floor(cells.x())), y = static_cast<int>(std::floor(cells.y()));
  if (x < -reach || y < -reach || x + 1 > reach || y + 1 > reach)
    return *std::min_element(p.begin(), p.end());
  const double u = cells.x() - x, v = cells.y() - y;
  return (1 - u) * (1 - v) * at(x, y) + u * (1 - v) * at(x + 1, y) + (1 - u) * v * at(x, y + 1) +
         u * v * at(x + 1, y + 1);
}

void HistogramFilter::predict(const Eigen::Vector2d& moved, double stddev) {
  if (!belief_) return;
  belief_->centre += moved;
  // A normal blur in x, then in y, and a little of everything: what was ruled out can come back.
  const int reach = belief_->reach, width = static_cast<int>(std::ceil(3.0 * stddev / belief_->cell_size));
  std::vector<double> weights;
  for (int i = -width; i <= width; ++i) {
    const double apart = i * belief_->cell_size / std::max(stddev, 1e-6);
    weights.push_back(std::exp(-0.5 * apart * apart));
  }
  for (const bool along_x : {true, false}) {
    ShiftHistogram blurred = *belief_;
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        double sum = 0.0, weight = 0.0;
        for (int i = -width; i <= width; ++i) {
          const int from_x = along_x ? x + i : x, from_y = along_x ? y : y + i;
          if (std::abs(from_x) > reach || std::abs(from_y) > reach) continue;
          sum += weights[i + width] * belief_->at(from_x, from_y);
          weight += weights[i + width];
        }
        blurred.at(x, y) = sum / weight;
      }
    }
    belief_ = blurred;
  }
  constexpr double kAnywhere = 0.01;  // [-] of the belief, over all cells
  for (double& p : belief_->p) p = (1.0 - kAnywhere) * p + kAnywhere / static_cast<double>(belief_->p.size());
}

}  // namespace relative_map::core
