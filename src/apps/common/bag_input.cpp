#include "bag_input.hpp"

#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

std::map<std::string, std::string> topics_of(const rosbag::Bag& bag) {
  std::map<std::string, std::string> topics;
  for (const rosbag::ConnectionInfo* connection : rosbag::View(bag).getConnections()) {
    topics[connection->topic] = connection->datatype;
  }
  return topics;
}

std::string listed(const std::map<std::string, std::string>& topics) {
  std::string list;
  for (const auto& [topic, type] : topics) list += (list.empty() ? "" : ", ") + topic + " (" + type + ")";
  return list.empty() ? "nothing" : list;
}

}  // namespace

void open_bag(const std::string& path, rosbag::Bag& bag) {
  const auto refuse = [&path](const std::string& why) {
    throw std::runtime_error(path + ": not a readable bag: " + why);
  };
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) refuse("it is a folder");
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    refuse("it is a pipe or a device, and no file");  // opening one could wait for ever
  }
  if (access(path.c_str(), R_OK) != 0) refuse(std::strerror(errno));
  if (std::filesystem::file_size(path, error) == 0 && !error) refuse("it is empty");
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    refuse("it was cut off, and has no index; rosbag reindex may save it");
  } catch (const rosbag::BagException& fault) {
    refuse(std::string("it was cut off, or is no bag: ") + fault.what());
  }
}

std::string find_topic(const rosbag::Bag& bag, const std::string& path, const std::string& topic,
                       const std::vector<std::string>& types) {
  const std::map<std::string, std::string> all = topics_of(bag);
  std::map<std::string, std::string> fitting;
  for (const auto& [name, type] : all) {
    if (std::find(types.begin(), types.end(), type) != types.end()) fitting[name] = type;
  }
  if (!topic.empty()) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& entry) {
      return frame_name(entry.first) == frame_name(topic);
    });
    if (found == all.end())
      throw std::runtime_error(path + ": has no topic " + topic + "; it has " + listed(all));
    if (fitting.count(found->first) == 0) {
      throw std::runtime_error(path + ": " + found->first + " is of type " + found->second +
                               ", which is not one of " + "those that are read here");
    }
    return found->first;
  }
  if (fitting.empty()) {
    std::string wanted;
    for (const std::string& type : types) wanted += (wanted.empty() ? "" : ", ") + type;
    throw std::runtime_error(path + ": has no topic of " + wanted + "; it has " + listed(all));
  }
  if (fitting.size() > 1)
    throw std::runtime_error(path + ": name one of its topics by --topic: " + listed(fitting));
  return fitting.begin()->first;
}

void load_static_transforms(const rosbag::Bag& bag, tf2::BufferCore& transforms) {
  for (const rosbag::MessageInstance& instance :
       rosbag::View(bag, rosbag::TopicQuery(std::vector<std::string>{"/tf_static", "tf_static"}))) {
    const auto message = instance.instantiate<tf2_msgs::TFMessage>();
    if (!message) continue;
    for (const auto& transform : message->transforms) transforms.setTransform(transform, "bag", true);
  }
}

}  // namespace relative_map
