#pragma once

#include <rosbag/bag.h>
#include <tf2/buffer_core.h>

#include <string>
#include <vector>

namespace relative_map {

/// Opens a bag for reading; std::runtime_error, one sentence, if it is absent, cut off or no bag.
void open_bag(const std::string& path, rosbag::Bag& bag);

/// The topic of a bag that has one of these types, which must be there once if none is named. Throws a
/// sentence that lists what there is.
std::string find_topic(const rosbag::Bag& bag, const std::string& path, const std::string& topic,
                       const std::vector<std::string>& types);

/// All of /tf_static, which holds from the beginning on, whenever it was recorded.
void load_static_transforms(const rosbag::Bag& bag, tf2::BufferCore& transforms);

}  // namespace relative_map
