#include "doctor_master.hpp"

#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpc.h>

#include <stdexcept>

namespace relative_map {

namespace {

constexpr double kPatience = 2.0;  // [s] with a node that is asked for its publications

/// One of the master's functions; its answer, or none.
std::optional<XmlRpc::XmlRpcValue> ask_master(const std::string& function, const std::string& argument = "") {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  if (!argument.empty()) request[1] = argument;
  if (!ros::master::execute(function, request, response, payload, false)) return std::nullopt;
  return payload;
}

/// [[topic, [node, ...]], ...] as the master lists publishers and subscribers.
std::map<std::string, std::vector<std::string>> nodes_by_topic(XmlRpc::XmlRpcValue& listing) {
  std::map<std::string, std::vector<std::string>> result;
  for (int i = 0; i < listing.size(); ++i) {
    std::vector<std::string>& nodes = result[listing[i][0]];
    for (int k = 0; k < listing[i][1].size(); ++k) {
      const std::string node = listing[i][1][k];
      if (node != ros::this_node::getName()) nodes.push_back(node);
    }
  }
  return result;
}

/// What a node says that it publishes: [[topic, type], ...]; none if it does not answer in time.
/// The client's own execute() would wait forever for a node that is stopped.
std::optional<XmlRpc::XmlRpcValue> ask_for_publications(const std::string& uri) {
  std::string host;
  uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) return std::nullopt;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue request, response;
  request[0] = ros::this_node::getName();
  std::optional<XmlRpc::XmlRpcValue> publications;
  if (client.executeNonBlock("getPublications", request)) {
    XmlRpc::XmlRpcDispatch dispatch;
    dispatch.addSource(&client, XmlRpc::XmlRpcDispatch::WritableEvent | XmlRpc::XmlRpcDispatch::Exception);
    dispatch.work(kPatience);
    dispatch.removeSource(&client);
    const bool answered = client.executeCheckDone(response) && !client.isFault();
    if (answered && response.getType() == XmlRpc::XmlRpcValue::TypeArray && response.size() == 3) {
      publications = response[2];
    }
  }
  client.close();
  return publications;
}

}  // namespace

MasterSurvey::MasterSurvey() {
  std::optional<XmlRpc::XmlRpcValue> state = ask_master("getSystemState");
  if (!state) throw std::runtime_error("the master at " + ros::master::getURI() + " does not answer");
  publishers_ = nodes_by_topic((*state)[0]);
  subscribers_ = nodes_by_topic((*state)[1]);
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  for (const ros::master::TopicInfo& topic : topics) types_[topic.name] = topic.datatype;
}

doctor::Topic MasterSurvey::topic(const std::string& name, const std::string& type) {
  doctor::Topic topic;
  topic.name = name;
  topic.type = type;
  if (const auto found = publishers_.find(name); found != publishers_.end()) {
    for (const std::string& node : found->second) topic.publishers.push_back(publisher(node, name));
  }
  if (const auto found = subscribers_.find(name); found != subscribers_.end()) {
    topic.subscribers = found->second;
  }
  for (const auto& [other, other_type] : types_) {
    if (other != name && other_type == type) topic.elsewhere.push_back(other);
  }
  return topic;
}

const MasterSurvey::Node& MasterSurvey::ask(const std::string& name) {
  const auto [entry, is_new] = nodes_.try_emplace(name);
  Node& node = entry->second;
  if (!is_new) return node;
  if (auto uri = ask_master("lookupNode", name)) node.uri = static_cast<std::string>(*uri);
  auto publications = ask_for_publications(node.uri);
  node.answers = publications.has_value();
  for (int i = 0; publications && i < publications->size(); ++i) {
    node.types[(*publications)[i][0]] = static_cast<std::string>((*publications)[i][1]);
  }
  return node;
}

doctor::Publisher MasterSurvey::publisher(const std::string& name, const std::string& topic) {
  const Node& node = ask(name);
  // The master keeps one type for all publishers of a topic: better than none.
  const std::map<std::string, std::string>& types = node.types.count(topic) > 0 ? node.types : types_;
  const auto type = types.find(topic);
  return {name, node.uri, type == types.end() ? "" : type->second, node.answers, ""};
}

}  // namespace relative_map
