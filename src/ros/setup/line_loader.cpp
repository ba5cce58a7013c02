#include "relative_map/ros/setup/line_loader.hpp"

#include <XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/line_formats.hpp"
#include "relative_map/io/text.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/ros/setup/parameters.hpp"

namespace relative_map {

std::vector<std::string> line_files(const XmlRpc::XmlRpcValue& parameter) {
  XmlRpc::XmlRpcValue value = parameter;  // reading one is not const
  std::vector<std::string> files;
  const auto add = [&](XmlRpc::XmlRpcValue& file) {
    if (file.getType() != XmlRpc::XmlRpcValue::TypeString) {
      throw std::runtime_error(std::string(kLinesParameter) + " must be a list of files, but holds " +
                               file.toXml());
    }
    files.push_back(static_cast<std::string>(file));
  };
  if (value.getType() != XmlRpc::XmlRpcValue::TypeArray) {
    add(value);
  } else {
    for (int i = 0; i < value.size(); ++i) add(value[i]);
  }
  return files;
}

std::vector<std::string> line_files(const std::string& yaml_file) {
  std::vector<std::string> files;
  try {
    const YAML::Node tree = YAML::Load(core::read_text(yaml_file));
    const YAML::Node value = tree.IsMap() ? tree[kLinesParameter] : YAML::Node();
    if (!value || value.IsNull()) return files;
    if (value.IsScalar()) return {value.Scalar()};
    for (const YAML::Node& file : value) {
      if (!value.IsSequence() || !file.IsScalar()) {
        throw std::runtime_error(yaml_file + ": " + kLinesParameter + " must be a list of files");
      }
      files.push_back(file.Scalar());
    }
  } catch (const YAML::Exception& fault) {
    throw std::runtime_error(yaml_file + ": " + fault.what());
  }
  return files;
}

void expect_allowed(const std::vector<std::string>& files, const std::string& root) {
  namespace fs = std::filesystem;
  for (const std::string& file : files) {
    const fs::path path(file);
    if (!path.is_absolute()) {
      throw std::runtime_error("'" + file + "' must be an absolute path: the node has a folder of its own");
    }
    if (root.empty()) continue;
    // Links and ".." are followed first: they must not lead out. Nothing is said of what lies elsewhere.
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(root, error), place = fs::weakly_canonical(path, error);
    const auto [end, unused] = std::mismatch(folder.begin(), folder.end(), place.begin(), place.end());
    if (error || end != folder.end()) {
      throw std::runtime_error("'" + file + "' does not lie in " + root + ", where lines are loaded from (~" +
                               kLineFolderParameter + ")");
    }
  }
}

core::NavigationInfo load_lines(const std::vector<std::string>& files, const std::string& frame_id,
                                std::vector<std::string>& notes) {
  if (files.empty()) throw std::runtime_error("no files are named");
  core::LineHeader header;
  core::NavigationInfo info;
  for (const std::string& path : files) {
    const core::LineFormat format = core::format_of(path).value_or(core::LineFormat::kSmoothed);
    core::LineFile file = core::read_line(path, format);
    if (const std::string why = core::merge(header, file.header); !why.empty()) {
      throw std::runtime_error(path + ": does not fit to the files before it: " + why);
    }
    for (const std::string& note : file.notes) notes.push_back(path + ": " + note);
    for (const core::BridgedGap& gap : file.header.bridged) {
      std::ostringstream note;
      note << std::fixed << std::setprecision(1) << path << ": from (" << gap.from_x << ", " << gap.from_y
           << ") to (" << gap.to_x << ", " << gap.to_y << ") nothing was recorded, and the line is a guess";
      notes.push_back(note.str());
    }
    file.line.priority = static_cast<std::uint32_t>(info.lines.size());
    info.lines.push_back(std::move(file.line));
  }
  if (header.frame_id.empty()) header.frame_id = frame_id.empty() ? "map" : frame_id;
  info.frame_id = frame_name(header.frame_id);
  return info;
}

void expect_frame(const std::string& frame, const std::string& localization_frame) {
  if (localization_frame.empty() || localization_frame == frame) return;
  throw std::runtime_error("the lines are in frame '" + frame + "', but localization is in '" +
                           localization_frame + "'");
}

void expect_all_loaded(const core::NavigationLines& lines, std::size_t count) {
  if (lines.lines.size() == count) return;
  throw std::runtime_error(lines.faults.empty() ? "a line was left out" : lines.faults.front());
}

std::vector<std::string> described(const core::NavigationLines& lines) {
  std::vector<std::string> sentences;
  for (const core::NavigationLine& line : lines.lines) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << line.id << ": priority " << line.priority << ", "
         << line.points.size() << " points, " << line.length << " m" << (line.closed() ? ", closed" : "");
    sentences.push_back(text.str());
  }
  return sentences;
}

}  // namespace relative_map
