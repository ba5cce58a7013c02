#pragma once

#include <string>

#include "relative_map/io/line_formats.hpp"

namespace relative_map {

/// A line as the last nav_msgs/Path of a topic, with its header as a std_msgs/String on TOPIC_header. Both
/// throw std::runtime_error, one sentence; a bag is written whole or not at all.
core::LineFile read_path_bag(const std::string& path, const std::string& topic);
/// Before the work: throws what write_path_bag() would for the path.
void expect_path_bag_writable(const std::string& path, const std::string& topic);
void write_path_bag(const std::string& path, const std::string& topic, const core::LineFile& file);

}  // namespace relative_map
