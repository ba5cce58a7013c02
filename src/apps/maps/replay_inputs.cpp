#include "replay_inputs.hpp"

#include <algorithm>
#include <stdexcept>

#include "bag_input.hpp"
#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

const std::vector<std::string> kInputs = {"navigation", "localization", "chassis", "perception/lane_markers"};

/// Relative names go into the namespace; absolute ones, like /tf, do not.
std::string resolve(const std::string& name_space, const std::string& name) {
  if (!name.empty() && name.front() == '/') return name;
  std::string space = name_space;
  while (!space.empty() && space.back() == '/') space.pop_back();
  if (!space.empty() && space.front() != '/') space = "/" + space;
  return space + "/" + name;
}

}  // namespace

InputTopics::InputTopics(const std::string& name_space, const std::vector<std::string>& remappings) {
  for (const std::string& name : kInputs) names_[name] = resolve(name_space, name);
  for (const std::string name : {"relative_map", "/tf", "/tf_static"})
    names_[name] = resolve(name_space, name);
  for (const std::string& word : remappings) {
    const std::size_t middle = word.find(":=");
    const std::string from = word.substr(0, middle), to = word.substr(middle + 2);
    const auto named = std::find_if(names_.begin(), names_.end(), [&](const auto& entry) {
      return entry.first == from || entry.second == from || "/" + entry.first == from;
    });
    if (named == names_.end() || to.empty()) {
      throw std::runtime_error(word + " remaps nothing: the topics are " + listed() +
                               ", relative_map, /tf and " + "/tf_static");
    }
    named->second = resolve(name_space, to);
  }
}

bool InputTopics::reads(const std::string& topic) const {
  return std::any_of(kInputs.begin(), kInputs.end(), [&](const std::string& name) {
    return frame_name(names_.at(name)) == frame_name(topic);
  });
}

bool InputTopics::is_tf(const std::string& topic) const {
  return frame_name(topic) == frame_name(names_.at("/tf"));
}

bool InputTopics::is_static_tf(const std::string& topic) const {
  return frame_name(topic) == frame_name(names_.at("/tf_static"));
}

std::string InputTopics::listed() const {
  std::string list;
  for (const std::string& name : kInputs) list += (list.empty() ? "" : ", ") + names_.at(name);
  return list;
}

ReplayBags::ReplayBags(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    bags_.push_back(std::make_unique<rosbag::Bag>());
    open_bag(path, *bags_.back());
  }
}

void ReplayBags::query(const std::function<bool(const std::string& topic)>& wanted,
                       rosbag::View& view) const {
  for (const auto& bag : bags_) {
    view.addQuery(*bag,
                  [wanted](const rosbag::ConnectionInfo* connection) { return wanted(connection->topic); });
  }
}

}  // namespace relative_map
