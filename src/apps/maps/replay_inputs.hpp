#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace relative_map {

/// Where the inputs of a map node are in a recording: by its namespace and its remappings, as for the node
/// itself.
class InputTopics {
 public:
  /// `name_space` may be empty; `remappings` are words like "localization:=/odom/pose". Throws
  /// std::runtime_error for a word that remaps nothing that is read or written here.
  InputTopics(const std::string& name_space, const std::vector<std::string>& remappings);

  /// Whether a bag's topic, with or without a leading slash, is one of the four inputs.
  bool reads(const std::string& topic) const;
  /// Whether it is /tf, or /tf_static, or what they are remapped to.
  bool is_tf(const std::string& topic) const;
  bool is_static_tf(const std::string& topic) const;
  /// Resolved, with a leading slash, e.g. of "relative_map".
  const std::string& resolved(const std::string& name) const { return names_.at(name); }
  /// The four inputs, for a sentence.
  std::string listed() const;

 private:
  std::map<std::string, std::string> names_;  ///< by their name in the node
};

/// Several bags as one: the parts of a split recording in any order.
class ReplayBags {
 public:
  /// Throws std::runtime_error that names the bag which can't be read.
  explicit ReplayBags(const std::vector<std::string>& paths);

  /// All messages whose topic is wanted, by the time at which they were recorded.
  void query(const std::function<bool(const std::string& topic)>& wanted, rosbag::View& view) const;

 private:
  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
};

}  // namespace relative_map
