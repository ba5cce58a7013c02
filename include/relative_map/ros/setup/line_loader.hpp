#pragma once

#include <string>
#include <vector>

#include "relative_map/model/inputs.hpp"
#include "relative_map/pipeline/lines/navigation_lines.hpp"

namespace XmlRpc {
class XmlRpcValue;
}

namespace relative_map {

// Navigation lines from files, for the parameter and the service of the node. All of these throw
// std::runtime_error, one sentence, for what can't be driven on.

/// The files that the parameter names: a list of texts, or one text.
std::vector<std::string> line_files(const XmlRpc::XmlRpcValue& parameter);
/// The same from a YAML file of parameters; none if it does not name any.
std::vector<std::string> line_files(const std::string& yaml_file);

/// That these are absolute paths, and lie in the folder `root` (empty: anywhere) when all links are followed:
/// what a service is asked for by anybody must not tell of other files.
void expect_allowed(const std::vector<std::string>& files, const std::string& root);

/// Reads files of any format (as .smoothed where the extension does not tell), with priorities in their
/// order. They must be of one frame and projection, as far as they say; without a frame in any of them it is
/// `frame_id`, or "map" if that is empty.
/// What the readers left out or found odd goes to `notes`, a sentence with the file each.
core::NavigationInfo load_lines(const std::vector<std::string>& files, const std::string& frame_id,
                                std::vector<std::string>& notes);

/// That lines in `frame` are of use: `localization_frame` is the same, or not known yet (empty).
void expect_frame(const std::string& frame, const std::string& localization_frame);

/// That no line was left out on intake.
void expect_all_loaded(const core::NavigationLines& lines, std::size_t count);

/// A sentence about each line.
std::vector<std::string> described(const core::NavigationLines& lines);

}  // namespace relative_map
