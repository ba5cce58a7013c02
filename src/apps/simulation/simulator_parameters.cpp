#include "simulator_parameters.hpp"

#include <ros/param.h>

#include <algorithm>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/navigation_line_file.hpp"
#include "relative_map/model/check_range.hpp"

namespace relative_map {

namespace {

constexpr int kAutomatic = -1;  // of a parameter that is a number from 0 on: choose by the lines

/// Reads parameters of a namespace by name, and keeps account of what is wrong with them.
class Reader {
 public:
  explicit Reader(const ros::NodeHandle& nh) : nh_(nh) {}

  /// Leaves `value` alone if the parameter is not there, or not of its type.
  template <class T>
  void read(const std::string& name, T& value) {
    known_.insert(nh_.resolveName(name));
    if (nh_.hasParam(name) && !nh_.getParam(name, value))
      faults.push_back(name + " must be " + type_name(value));
  }

  void read(const std::string& name, double& value, double low, double high) {
    read(name, value);
    core::check_range(name, value, low, high, faults);
  }

  int read(const std::string& name, int fallback, int low, int high) {
    int value = fallback;
    read(name, value);
    core::check_range(name, value, low, high, faults);
    return value;
  }

  /// A list of texts, or one text with spaces between them.
  std::vector<std::string> read_list(const std::string& name) {
    known_.insert(nh_.resolveName(name));
    std::vector<std::string> list;
    std::string text;
    if (nh_.getParam(name, text)) {
      std::istringstream words(text);
      for (std::string word; words >> word;) list.push_back(word);
    } else if (nh_.hasParam(name) && !nh_.getParam(name, list)) {
      faults.push_back(name + " must be a list of file paths");
      return list;
    }
    if (list.empty()) faults.push_back(name + " names no files");
    return list;
  }

  void note_unknown() {
    std::vector<std::string> names;
    ros::param::getParamNames(names);
    const std::string prefix = nh_.getNamespace() + "/";
    for (const std::string& name : names) {
      if (name.compare(0, prefix.size(), prefix) == 0 && known_.count(name) == 0) {
        faults.push_back(name.substr(prefix.size()) + " is not a parameter of this node");
      }
    }
  }

  std::vector<std::string> faults;

 private:
  static const char* type_name(double) { return "a number"; }
  static const char* type_name(int) { return "an integer"; }
  static const char* type_name(bool) { return "true or false"; }
  static const char* type_name(const std::string&) { return "text"; }

  const ros::NodeHandle& nh_;
  std::set<std::string> known_;
};

void read_episode(Reader& reader, const std::string& name, core::EpisodeParam& episode) {
  reader.read(name + "_interval", episode.interval);
  reader.read(name + "_min_duration", episode.min_duration);
  reader.read(name + "_max_duration", episode.max_duration);
}

void read_errors(Reader& reader, core::ErrorParam& errors) {
  reader.read("errors/localization_bias", errors.localization.bias);
  reader.read("errors/localization_bias_time", errors.localization.bias_time);
  reader.read("errors/heading_bias", errors.localization.heading_bias);
  reader.read("errors/heading_bias_time", errors.localization.heading_bias_time);
  reader.read("errors/drift", errors.localization.drift);
  reader.read("errors/drift_time", errors.localization.drift_time);
  reader.read("errors/yaw_rate_bias", errors.localization.yaw_rate_bias);
  reader.read("errors/speed_scale", errors.chassis.speed_scale);
  reader.read("errors/recording_offset", errors.recording.offset);
  reader.read("errors/recording_wander", errors.recording.wander);
  reader.read("errors/recording_wander_length", errors.recording.wander_length);
  reader.read("errors/marker_correlated_share", errors.markers.correlated_share);
  reader.read("errors/marker_correlation_time", errors.markers.correlation_time);
  reader.read("errors/marker_common_share", errors.markers.common_share);
  reader.read("errors/view_range_change", errors.markers.view_range_change);
  reader.read("errors/view_range_time", errors.markers.view_range_time);
  reader.read("errors/min_view_range", errors.markers.min_view_range);
  reader.read("errors/max_view_range", errors.markers.max_view_range);
  read_episode(reader, "errors/dropout", errors.markers.dropout);
  read_episode(reader, "errors/outlier", errors.markers.outlier);
  reader.read("errors/min_jump", errors.markers.min_jump);
  reader.read("errors/max_jump", errors.markers.max_jump);
  reader.read("errors/min_latency", errors.markers.min_latency);
  reader.read("errors/max_latency", errors.markers.max_latency);
}

void read_simulation(Reader& reader, core::VehicleSimulationConfig& config) {
  config.seed = static_cast<std::uint64_t>(reader.read("seed", 1, 0, std::numeric_limits<int>::max()));
  reader.read("start_s", config.start_s);
  reader.read("wander", config.wander);
  reader.read("wander_wavelength", config.wander_wavelength);
  reader.read("max_speed", config.speed.max_speed);
  reader.read("max_lateral_acceleration", config.speed.max_lateral_acceleration);
  reader.read("max_acceleration", config.speed.max_acceleration);
  reader.read("max_deceleration", config.speed.max_deceleration);
  double standing = 0.0;
  reader.read("standing", standing, 0.0, 1000.0);
  if (standing > 0.0) config.speed_changes = {{0.0, 0.0}, {standing, config.speed.max_speed}};
  reader.read("lane_half_width", config.paint.lane_half_width);
  reader.read("view_range", config.paint.view_range);
  reader.read("marker_quality", config.paint.quality);
  reader.read("max_turn", config.paint.max_turn);
  reader.read("max_residual", config.paint.max_residual);
  reader.read("noise/localization_position", config.noise.localization_position);
  reader.read("noise/localization_heading", config.noise.localization_heading);
  reader.read("noise/chassis_speed", config.noise.chassis_speed);
  reader.read("noise/marker_c0", config.noise.marker_c0);
  reader.read("noise/marker_c1", config.noise.marker_c1);
  reader.read("noise/marker_c2", config.noise.marker_c2);
  reader.read("noise/marker_c3", config.noise.marker_c3);
  reader.read("noise/yaw_rate", config.noise.yaw_rate);
  read_errors(reader, config.errors);
  const std::vector<std::string> faults = config.validate();
  reader.faults.insert(reader.faults.end(), faults.begin(), faults.end());
}

/// Solid white at the road's edges, dotted white between its lanes, unless a parameter says otherwise.
core::BoundaryType read_paint(Reader& reader, const std::string& name, bool at_edge) {
  const int number = reader.read(name, kAutomatic, kAutomatic, static_cast<int>(core::BoundaryType::kCurb));
  if (number != kAutomatic) return static_cast<core::BoundaryType>(number);
  return at_edge ? core::BoundaryType::kSolidWhite : core::BoundaryType::kDottedWhite;
}

void read_lines(Reader& reader, SimulatorParameters& parameters) {
  const std::vector<std::string> files = reader.read_list("navigation_lines");
  for (const std::string& file : files) {
    try {
      parameters.lines.push_back(core::read_navigation_line(file));
      parameters.lines.back().priority = static_cast<std::uint32_t>(parameters.lines.size() - 1);
    } catch (const std::runtime_error& fault) {
      reader.faults.push_back(fault.what());
    }
  }
  // By the number of files, not of those that could be read: one fault is not to cause others.
  const int last = std::max(static_cast<int>(files.size()) - 1, 0);
  const int drive_line = reader.read("drive_line", kAutomatic, kAutomatic, last);
  parameters.drive_line = static_cast<std::size_t>(drive_line == kAutomatic ? last / 2 : drive_line);
  core::PaintParam& paint = parameters.simulation.paint;
  paint.left_type = read_paint(reader, "left_marker_type", parameters.drive_line == 0);
  paint.right_type = read_paint(reader, "right_marker_type", parameters.drive_line + 1 == files.size());
}

void read_frame(Reader& reader, const std::string& name, std::string& frame) {
  reader.read(name, frame);
  if (frame.empty() || frame.front() == '/') {
    reader.faults.push_back(name + " is '" + frame + "', but must be a name without a leading slash");
  }
}

}  // namespace

SimulatorParameters read_simulator_parameters(const ros::NodeHandle& private_nh) {
  SimulatorParameters parameters;
  Reader reader(private_nh);
  read_simulation(reader, parameters.simulation);
  read_lines(reader, parameters);
  read_frame(reader, "map_frame", parameters.map_frame);
  read_frame(reader, "base_frame", parameters.base_frame);
  reader.read("localization_rate", parameters.localization_rate, 1.0, 1000.0);
  reader.read("chassis_rate", parameters.chassis_rate, 1.0, 1000.0);
  reader.read("lane_marker_rate", parameters.lane_marker_rate, 1.0, 1000.0);
  reader.read("publish_navigation", parameters.publish_navigation);
  reader.read("publish_tf", parameters.publish_tf);
  reader.read("repeat", parameters.repeat);
  reader.read("exit_at_end", parameters.exit_at_end);
  if (parameters.repeat && parameters.exit_at_end) {
    reader.faults.push_back("repeat and exit_at_end are both true, but exclude each other");
  }
  reader.note_unknown();
  if (reader.faults.empty()) return parameters;
  std::string text = "the vehicle simulator cannot start:";
  for (const std::string& fault : reader.faults) text += "\n  " + fault;
  throw std::runtime_error(text);
}

}  // namespace relative_map
