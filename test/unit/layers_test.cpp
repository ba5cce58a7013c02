// A layer may use only those above it in the table: what a file includes shows it.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace relative_map::core {
namespace {

namespace fs = std::filesystem;

/// What each layer may use of the package, itself included.
const std::map<std::string, std::set<std::string>> kMayUse = {
    {"geometry", {"geometry"}},
    {"model", {"geometry", "model"}},
    {"pipeline", {"geometry", "model", "pipeline"}},
    {"localization", {"geometry", "model", "localization"}},
    {"route", {"geometry", "model", "route"}},
    {"prediction", {"geometry", "model", "prediction"}},
    {"io", {"geometry", "model", "io"}},
    {"simulation", {"geometry", "model", "pipeline", "prediction", "io", "simulation"}},
    {"tools", {"geometry", "model", "pipeline", "prediction", "io", "simulation", "tools"}},
    {"ros", {"geometry", "model", "pipeline", "localization", "route", "prediction", "io", "ros"}},
    {"doctor",
     {"geometry", "model", "pipeline", "localization", "route", "prediction", "io", "ros", "doctor"}},
    {"apps",
     {"geometry", "model", "pipeline", "localization", "route", "prediction", "io", "simulation", "tools",
      "ros", "doctor", "apps"}},
};
/// The rooms of the tick, in the order in which each may use those before it.
const std::vector<std::string> kRooms = {"motion",     "lines",        "paint",   "lanes",
                                         "estimation", "fixed_weight", "contract"};
/// What a room may not use though it comes before: neither method is made of the other, and the check must
/// not share what it checks by.
const std::map<std::string, std::set<std::string>> kMustNotUse = {
    {"fixed_weight", {"estimation"}},
    {"contract", {"motion", "lines", "paint", "lanes", "estimation", "fixed_weight"}},
};
const std::set<std::string> kMayUseRos = {"ros", "doctor", "apps"};

/// The headers that a file includes, in either kind of brackets.
std::vector<std::string> includes_of(const fs::path& file) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  std::ifstream stream(file);
  std::vector<std::string> headers;
  std::smatch match;
  for (std::string line; std::getline(stream, line);) {
    if (std::regex_search(line, match, kInclude)) headers.push_back(match[1]);
  }
  return headers;
}

bool is_ros(const std::string& header) {
  static const std::regex kRos(
      R"re(^(ros|tf2|tf2_ros|nodelet|pluginlib|rosbag|urdf|diagnostic_updater|dynamic_reconfigure|[a-z_0-9]+_(msgs|srvs))/)re");
  static const std::regex kMessage(R"re(^relative_map/[A-Z]\w*\.h$)re");
  return std::regex_search(header, kRos) || std::regex_search(header, kMessage);
}

/// The fault in what one file of a layer includes; empty: none.
std::string fault_of(const std::string& layer, const std::string& header) {
  if (kMayUseRos.count(layer) == 0 && is_ros(header)) return "a ROS header";
  static const std::regex kOwn(R"re(^relative_map/([a-z]+)/)re");
  std::smatch match;
  if (!std::regex_search(header, match, kOwn)) return "";
  return kMayUse.at(layer).count(match[1]) > 0 ? "" : "a layer that is not above it";
}

/// The fault in what one file of a room of the pipeline includes; empty: none.
std::string fault_of_room(const std::string& room, const std::string& header) {
  static const std::regex kPipeline(R"re(^relative_map/pipeline/(?:([a-z_]+)/)?)re");
  std::smatch match;
  if (!std::regex_search(header, match, kPipeline)) return "";
  const auto place = [](const std::string& name) { return std::find(kRooms.begin(), kRooms.end(), name); };
  const auto banned = kMustNotUse.find(room);
  if (banned != kMustNotUse.end() && banned->second.count(match[1]) > 0) return "a room that it must not use";
  return place(match[1]) <= place(room) && place(match[1]) != kRooms.end() ? ""
                                                                           : "a room that is not before it";
}

TEST(Layers, UseOnlyThoseAboveThem) {
  const fs::path root = RELATIVE_MAP_SOURCE_DIR;
  for (const auto& [layer, unused] : kMayUse) {
    std::size_t files = 0;
    for (const fs::path& folder : {root / "include/relative_map" / layer, root / "src" / layer}) {
      if (!fs::exists(folder)) continue;  // apps have no public headers
      for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder)) {
        if (!file.is_regular_file()) continue;
        ++files;
        for (const std::string& header : includes_of(file.path())) {
          EXPECT_EQ(fault_of(layer, header), "") << file.path() << " includes " << header;
        }
      }
    }
    EXPECT_GT(files, 1u) << "the folders of " << layer;
  }
}

TEST(Layers, WhatJudgesTheEstimatorDoesNotKnowIt) {
  // A world that shared a constant with the estimator would flatter it: neither sees the other's headers, but
  // for the pipeline's entrance, the intake of lines, and the contract's check.
  static const std::regex kEstimator(
      R"re(^relative_map/pipeline/(?!relative_map_pipeline|lines/|contract/))re");
  const fs::path root = RELATIVE_MAP_SOURCE_DIR;
  for (const fs::path& folder : {root / "include/relative_map/simulation", root / "src/simulation"}) {
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder)) {
      if (!file.is_regular_file()) continue;
      for (const std::string& header : includes_of(file.path())) {
        EXPECT_FALSE(std::regex_search(header, kEstimator)) << file.path() << " includes " << header;
      }
    }
  }
  EXPECT_TRUE(std::regex_search("relative_map/pipeline/estimation/noise.hpp", kEstimator));
  EXPECT_FALSE(std::regex_search("relative_map/pipeline/contract/map_check.hpp", kEstimator));
}

TEST(Layers, RoomsOfTheTickUseOnlyThoseBeforeThem) {
  const fs::path root = RELATIVE_MAP_SOURCE_DIR;
  for (const char* part : {"include/relative_map/pipeline", "src/pipeline"}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(root / part)) {
      if (!entry.is_directory()) continue;
      const std::string room = entry.path().filename();
      EXPECT_NE(std::find(kRooms.begin(), kRooms.end(), room), kRooms.end()) << room << " has no place";
      std::size_t files = 0;
      for (const fs::directory_entry& file : fs::directory_iterator(entry)) {
        ++files;
        for (const std::string& header : includes_of(file.path())) {
          EXPECT_EQ(fault_of_room(room, header), "") << file.path() << " includes " << header;
        }
      }
      EXPECT_GT(files, 0u) << room;
    }
  }
}

TEST(Layers, AWrongIncludeInARoomIsFound) {
  EXPECT_EQ(fault_of_room("lines", "relative_map/pipeline/lanes/lane_path.hpp"),
            "a room that is not before it");
  EXPECT_EQ(fault_of_room("lanes", "relative_map/pipeline/relative_map_pipeline.hpp"),
            "a room that is not before it");
  EXPECT_EQ(fault_of_room("contract", "relative_map/pipeline/lanes/lane_path.hpp"),
            "a room that it must not use");
  EXPECT_EQ(fault_of_room("fixed_weight", "relative_map/pipeline/estimation/estimator.hpp"),
            "a room that it must not use");
  EXPECT_EQ(fault_of_room("estimation", "relative_map/pipeline/paint/image_queue.hpp"), "");
  EXPECT_EQ(fault_of_room("contract", "relative_map/model/map.hpp"), "");
}

TEST(Layers, AWrongIncludeIsFound) {
  EXPECT_EQ(fault_of("pipeline", "ros/time.h"), "a ROS header");
  EXPECT_EQ(fault_of("io", "relative_map/MapMsg.h"), "a ROS header");
  EXPECT_EQ(fault_of("simulation", "geometry_msgs/Point.h"), "a ROS header");
  EXPECT_EQ(fault_of("geometry", "relative_map/model/inputs.hpp"), "a layer that is not above it");
  EXPECT_EQ(fault_of("ros", "relative_map/simulation/road.hpp"), "a layer that is not above it");
  EXPECT_EQ(fault_of("ros", "relative_map/tools/line_smoother.hpp"), "a layer that is not above it");
  EXPECT_EQ(fault_of("tools", "nav_msgs/Path.h"), "a ROS header");
  EXPECT_EQ(fault_of("ros", "relative_map/doctor/doctor.hpp"), "a layer that is not above it");
  EXPECT_EQ(fault_of("prediction", "relative_map/pipeline/motion/pose_buffer.hpp"),
            "a layer that is not above it");
  EXPECT_EQ(fault_of("prediction", "ros/time.h"), "a ROS header");
  EXPECT_EQ(fault_of("ros", "ros/time.h"), "");
  EXPECT_EQ(fault_of("pipeline", "relative_map/model/map.hpp"), "");
}

}  // namespace
}  // namespace relative_map::core
