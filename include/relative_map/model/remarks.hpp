#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace relative_map::core {

/// What a tick notices about its inputs without giving up on the map: sentences, each of them told once.
inline void add_new(std::vector<std::string>& remarks, const std::vector<std::string>& more) {
  for (const std::string& remark : more) {
    if (std::find(remarks.begin(), remarks.end(), remark) == remarks.end()) remarks.push_back(remark);
  }
}

}  // namespace relative_map::core
