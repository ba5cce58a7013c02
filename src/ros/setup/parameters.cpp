#include "relative_map/ros/setup/parameters.hpp"

#include <XmlRpcValue.h>
#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/text.hpp"
#include "relative_map/ros/setup/footprint.hpp"

namespace relative_map {

namespace {

/// Keys that libraries and tools read from a node's namespace, or leave there: they are none of this node's.
const std::set<std::string> kForeignKeys = {kReconfigureNamespace,
                                            kLinesParameter,
                                            kLineFolderParameter,
                                            "robot_description",
                                            "robot_description_semantic",
                                            "diagnostic_period",
                                            "diagnostic_updater",
                                            "tf_prefix",
                                            "use_sim_time",
                                            "enable_statistics",
                                            "bond_disable_heartbeat_timeout",
                                            "num_worker_threads"};

void flatten_into(ParameterSet& set, const std::string& path, XmlRpc::XmlRpcValue value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeStruct:
      for (auto& [key, child] : value) {
        if (path.empty() && kForeignKeys.count(key) > 0) continue;
        flatten_into(set, path.empty() ? key : path + "/" + key, child);
      }
      break;
    case XmlRpc::XmlRpcValue::TypeBoolean:
      set[path] = static_cast<bool>(value);
      break;
    case XmlRpc::XmlRpcValue::TypeInt:
      set[path] = static_cast<int>(value);
      break;
    case XmlRpc::XmlRpcValue::TypeDouble:
      set[path] = static_cast<double>(value);
      break;
    default:
      set[path] = value.getType() == XmlRpc::XmlRpcValue::TypeString ? static_cast<std::string>(value)
                                                                     : value.toXml();
  }
}

Parameter scalar_of(const YAML::Node& node) {
  // "!" is a quoted scalar: text, whatever it looks like.
  if (node.Tag() != "!") {
    int integer;
    double number;
    bool truth;
    if (YAML::convert<int>::decode(node, integer)) return integer;
    if (YAML::convert<double>::decode(node, number)) return number;
    if (YAML::convert<bool>::decode(node, truth)) return truth;
  }
  return node.Scalar();
}

void flatten_into(ParameterSet& set, const std::string& path, const YAML::Node& node) {
  if (node.IsMap()) {
    for (const auto& entry : node) {
      const std::string key = entry.first.as<std::string>();
      if (path.empty() && kForeignKeys.count(key) > 0) continue;
      flatten_into(set, path.empty() ? key : path + "/" + key, entry.second);
    }
  } else if (node.IsScalar()) {
    set[path] = scalar_of(node);
  } else {
    set[path] = YAML::Dump(node);
  }
}

/// Hands parameters out by name, and keeps account of what was asked for and what was wrong.
class Reader {
 public:
  explicit Reader(const ParameterSet& parameters) : parameters_(parameters) {}

  /// True if the parameter is there and of its type; `value` is left alone otherwise.
  template <class T>
  bool read(const std::string& name, T& value) {
    known_.insert(name);
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) return false;
    if (const T* typed = std::get_if<T>(&found->second)) {
      value = *typed;
      return true;
    }
    if constexpr (std::is_same_v<T, double>) {
      if (const int* integer = std::get_if<int>(&found->second)) {
        value = *integer;
        return true;
      }
    }
    faults.push_back(name + " is " + text_of(found->second) + ", but must be " + type_name<T>());
    return false;
  }

  /// One of a few words.
  template <class Enum>
  void read(const std::string& name, Enum& value, const std::map<std::string, Enum>& words) {
    std::string word;
    if (!read(name, word)) return;
    if (const auto found = words.find(word); found != words.end()) {
      value = found->second;
      return;
    }
    std::string choice;
    for (const auto& [key, unused] : words) choice += (choice.empty() ? "" : " or ") + key;
    faults.push_back(name + " is '" + word + "', but must be " + choice);
  }

  /// All numbers below a name, by what follows it.
  void read_group(const std::string& name, std::map<std::string, double>& values) {
    const std::string prefix = name + "/";
    for (auto entry = parameters_.lower_bound(prefix);
         entry != parameters_.end() && entry->first.compare(0, prefix.size(), prefix) == 0; ++entry) {
      double value = 0.0;
      if (read(entry->first, value)) values[entry->first.substr(prefix.size())] = value;
    }
  }

  void note_unknown() {
    for (const auto& [name, value] : parameters_) {
      if (known_.count(name) == 0) faults.push_back(name + " is not a parameter of this node");
    }
  }

  std::vector<std::string> faults;

 private:
  template <class T>
  static const char* type_name() {
    if (std::is_same_v<T, double>) return "a number";
    if (std::is_same_v<T, bool>) return "true or false";
    return std::is_same_v<T, int> ? "an integer" : "text";
  }

  static std::string text_of(const Parameter& parameter) {
    std::ostringstream text;
    text << std::boolalpha;
    std::visit([&](const auto& value) { text << "'" << value << "'"; }, parameter);
    return text.str();
  }

  const ParameterSet& parameters_;
  std::set<std::string> known_;
};

void read_pipeline(Reader& reader, core::PipelineConfig& config) {
  if (reader.read("base_frame", config.base_frame)) config.base_frame = frame_name(config.base_frame);
  reader.read("predict_to_tick", config.predict_to_tick);
  reader.read("enable_cyclic_rerouting", config.enable_cyclic_rerouting);
  reader.read("generate_left_boundary", config.generate_left_boundary);

  reader.read("map_param/default_left_width", config.map_param.default_left_width);
  reader.read("map_param/default_right_width", config.map_param.default_right_width);
  reader.read("map_param/default_speed_limit", config.map_param.default_speed_limit);

  core::NavigationLaneParam& lane = config.navigation_lane;
  const std::string group = "navigation_lane/";
  reader.read(group + "lane_source", lane.lane_source,
              {{"OFFLINE_GENERATED", core::LaneSource::kOfflineGenerated},
               {"PERCEPTION", core::LaneSource::kPerception}});
  reader.read(group + "max_len_from_navigation_line", lane.max_len_from_navigation_line);
  reader.read(group + "min_len_for_navigation_lane", lane.min_len_for_navigation_lane);
  reader.read(group + "max_len_for_navigation_lane", lane.max_len_for_navigation_lane);
  reader.read(group + "ratio_navigation_lane_len_to_speed", lane.ratio_navigation_lane_len_to_speed);
  reader.read(group + "max_distance_to_navigation_line", lane.max_distance_to_navigation_line);
  reader.read(group + "min_view_range_to_use_lane_marker", lane.min_view_range_to_use_lane_marker);
  reader.read(group + "min_lane_marker_quality", lane.min_lane_marker_quality);
  reader.read(group + "min_lane_half_width", lane.min_lane_half_width);
  reader.read(group + "max_lane_half_width", lane.max_lane_half_width);
  reader.read(group + "lane_marker_weight", lane.lane_marker_weight);

  reader.read("lane_fusion/method", config.lane_fusion.method);
  reader.read("lane_fusion/max_offset", config.lane_fusion.max_offset);
  reader.read("lane_fusion/decay_time", config.lane_fusion.decay_time);
  reader.read("lane_fusion/hold_time", config.lane_fusion.hold_time);
  reader.read("lane_fusion/fade_length", config.lane_fusion.fade_length);

  reader.read("max_age/localization", config.max_age.localization);
  reader.read("max_age/chassis", config.max_age.chassis);
  reader.read("max_age/lane_markers", config.max_age.lane_markers);
}

void read_footprint(Reader& reader, const std::string& urdf, core::PipelineConfig& config) {
  core::Footprint own;
  const bool half_width = reader.read("footprint/half_width", own.half_width);
  const bool front = reader.read("footprint/front_overhang", own.front_overhang);
  const bool rear = reader.read("footprint/rear_overhang", own.rear_overhang);
  const bool complete = half_width && front && rear;
  if (!urdf.empty() && !complete) {
    try {
      config.footprint = footprint_from_urdf(urdf, config.base_frame);
    } catch (const std::runtime_error& fault) {
      reader.faults.push_back(fault.what());
    }
  }
  if (half_width) config.footprint.half_width = own.half_width;
  if (front) config.footprint.front_overhang = own.front_overhang;
  if (rear) config.footprint.rear_overhang = own.rear_overhang;
}

}  // namespace

ParameterSet flatten(const XmlRpc::XmlRpcValue& tree) {
  ParameterSet set;
  if (tree.valid()) flatten_into(set, "", tree);
  return set;
}

ParameterSet parameters_of(const ros::NodeHandle& private_nh) {
  XmlRpc::XmlRpcValue tree;
  private_nh.getParam(private_nh.getNamespace(), tree);
  return flatten(tree);
}

ParameterSet read_yaml(const std::string& file) {
  ParameterSet set;
  try {
    const YAML::Node tree = YAML::Load(core::read_text(file));
    if (tree.IsMap()) {
      flatten_into(set, "", tree);
    } else if (tree.IsDefined() && !tree.IsNull()) {
      throw std::runtime_error(file + ": is no map of parameters");
    }
  } catch (const YAML::Exception& fault) {
    throw std::runtime_error(file + ": " + fault.what());
  }
  return set;
}

NodeConfig make_node_config(const ParameterSet& parameters, const std::string& urdf) {
  NodeConfig config;
  Reader reader(parameters);
  reader.read("rate", config.rate);
  reader.read("use_navigation_mode", config.use_navigation_mode);
  reader.read("orientation_convention", config.orientation_convention,
              {{"flu", OrientationConvention::kFlu}, {"rfu", OrientationConvention::kRfu}});
  if (reader.read("map_frame", config.map_frame)) config.map_frame = frame_name(config.map_frame);
  reader.read_group("map_param/speed_limits", config.speed_limits);
  reader.read("min_rate/localization", config.min_rate.localization);
  reader.read("min_rate/chassis", config.min_rate.chassis);
  reader.read("min_rate/lane_markers", config.min_rate.lane_markers);
  read_pipeline(reader, config.pipeline);
  read_footprint(reader, urdf, config.pipeline);
  reader.note_unknown();

  std::vector<std::string>& faults = reader.faults;
  if (!(config.rate > 0.0 && config.rate <= 1000.0)) {
    faults.push_back("rate is " + std::to_string(config.rate) + " Hz, but must be above 0 and at most 1000");
  }
  for (const auto& [name, rate] : {std::pair("localization", config.min_rate.localization),
                                   std::pair("chassis", config.min_rate.chassis),
                                   std::pair("lane_markers", config.min_rate.lane_markers)}) {
    if (rate >= 0.0 && rate <= 1000.0) continue;
    faults.push_back("min_rate/" + std::string(name) + " is " + std::to_string(rate) +
                     " Hz, but must lie in [0, 1000]");
  }
  for (const auto& [line, limit] : config.speed_limits) {
    if (limit >= 0.1 && limit <= 100.0) continue;
    faults.push_back("map_param/speed_limits/" + line + " is " + std::to_string(limit) +
                     " m/s, but must lie in [0.1, 100]");
  }
  if (config.map_frame.empty()) faults.push_back("map_frame is empty, but must name a frame");
  if (!config.use_navigation_mode) {
    faults.push_back(
        "use_navigation_mode is false, but this node is the navigation mode: do not start it, or set it to "
        "true");
  }
  const std::vector<std::string> pipeline_faults = config.pipeline.validate();
  faults.insert(faults.end(), pipeline_faults.begin(), pipeline_faults.end());
  if (faults.empty()) return config;
  std::string text = "the configuration is refused:";
  for (const std::string& fault : faults) text += "\n  - " + fault;
  throw std::runtime_error(text);
}

}  // namespace relative_map
