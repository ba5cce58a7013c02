#pragma once

#include <string>

#include "registration.hpp"

namespace relative_map {

/// One JSON object and a line end; keys as in the help of register_clouds.
std::string json_of(const Registration& found, const RegistrationRequest& request);
/// For people.
std::string text_of(const Registration& found, const RegistrationRequest& request);

}  // namespace relative_map
