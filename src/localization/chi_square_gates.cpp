#include <boost/math/distributions/chi_squared.hpp>

#include "relative_map/localization/source_health.hpp"

namespace relative_map::core {

std::array<double, 4> chi_square_gates(double probability) {
  std::array<double, 4> gates{};
  for (int freedom = 1; freedom <= 3; ++freedom) {
    gates[freedom] =
        boost::math::quantile(boost::math::complement(boost::math::chi_squared(freedom), probability));
  }
  return gates;
}

}  // namespace relative_map::core
