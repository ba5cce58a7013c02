#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/ros/messages/conversions.hpp"

namespace XmlRpc {
class XmlRpcValue;
}
namespace ros {
class NodeHandle;
}

namespace relative_map {

/// Parameters by their path below the node's private namespace, e.g. "map_param/default_left_width".
using Parameter = std::variant<bool, int, double, std::string>;
using ParameterSet = std::map<std::string, Parameter>;

/// How often an input should come [Hz]; below it /diagnostics warns.
struct MinRateParam {
  double localization = 10.0;
  double chassis = 10.0;
  double lane_markers = 5.0;
};

/// All that the node can be told. Defaults as in config/relative_map.yaml.
struct NodeConfig {
  core::PipelineConfig pipeline;
  double rate = 10.0;  ///< [Hz] of the map
  bool use_navigation_mode = true;
  std::string map_frame = "map";  ///< that lines of files are in which name none
  MinRateParam min_rate;
  std::map<std::string, double>
      speed_limits;  ///< [m/s] of lanes by the name of their line; others: the default
  OrientationConvention orientation_convention = OrientationConvention::kFlu;
};

/// Parameters as the parameter server has them; the namespace of dynamic_reconfigure, the list of files and
/// their folder, and what other libraries keep in a node's namespace (e.g. robot_description) are left out.
/// What is no scalar is kept as its text, for `make_node_config` to name.
ParameterSet flatten(const XmlRpc::XmlRpcValue& tree);
/// Those of a node, from its private handle.
ParameterSet parameters_of(const ros::NodeHandle& private_nh);
/// Reads a YAML file; throws std::runtime_error naming file and fault.
ParameterSet read_yaml(const std::string& file);

/// The configuration, or std::runtime_error whose text lists every unknown key, wrong type and bad value.
/// The footprint comes from `footprint/...`, what that leaves open from `urdf` (may be empty).
NodeConfig make_node_config(const ParameterSet& parameters, const std::string& urdf);

/// Where dynamic_reconfigure keeps its own copies of the parameters, below the private namespace.
constexpr const char* kReconfigureNamespace = "reconfigure";
/// A list of files, which is the node's business and no part of its configuration: see line_loader.hpp.
constexpr const char* kLinesParameter = "navigation_lines";
/// The folder that the service may load lines from, likewise; empty: any.
constexpr const char* kLineFolderParameter = "navigation_lines_folder";

}  // namespace relative_map
