#pragma once

#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

namespace relative_map::core {

/// Adds a sentence to `faults` if a parameter does not lie in [low, high]; NaN never does.
template <class T>
void check_range(const std::string& name, T value, std::common_type_t<T> low, std::common_type_t<T> high,
                 std::vector<std::string>& faults) {
  if (value >= low && value <= high) return;
  std::ostringstream fault;
  fault << name << " is " << value << ", but must lie in [" << low << ", " << high << "]";
  faults.push_back(fault.str());
}

}  // namespace relative_map::core
