#pragma once

#include <string>

#include "relative_map/model/route.hpp"

namespace relative_map::core {

/// A name for the way that a route leads: the same for routes that lead the same way (same_way()), and in all
/// likelihood another for any other. Passage ids are the places in a route: they mean something only
/// together with this name. 16 hexadecimal digits, the FNV-1a hash of the route's content.
std::string route_identity(const Route& route);

}  // namespace relative_map::core
