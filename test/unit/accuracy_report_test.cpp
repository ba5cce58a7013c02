#include "relative_map/simulation/accuracy_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace relative_map::core {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::ptrdiff_t columns_of(const std::string& line) {
  return std::count(line.begin(), line.end(), ',') + 1;
}

/// One map: 0.25 m off at 10 m, and the rest not known.
MeasuredMap one_map() {
  MeasuredMap map;
  map.time = 3.5;
  map.errors.center[2] = 0.25;
  map.errors.usable = true;
  map.cost = 42e-6;
  return map;
}

BenchmarkResult one_row() {
  BenchmarkResult result;
  AccuracyRow row;
  row.scene = "a-scene-of-a-length";
  row.method = "line";
  row.add(one_map());
  result.rows = result.totals = {row};
  return result;
}

TEST(AccuracyReport, TheTablesColumnsAreAligned) {
  std::ostringstream out;
  print_table(one_row(), out);
  const std::vector<std::string> lines = lines_of(out.str());
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[3], "");
  for (const std::size_t i : {1u, 2u, 4u}) {
    EXPECT_EQ(lines[i].size(), lines[0].size());
    for (std::size_t k = 0; k < lines[0].size(); ++k) {
      EXPECT_EQ(lines[0][k] == '|', lines[i][k] == '|') << "line " << i << ", column " << k;
    }
  }
  EXPECT_EQ(lines[2], lines[4]);
  EXPECT_NE(lines[2].find("      -      -  0.250      -"), std::string::npos) << lines[2];
  EXPECT_NE(lines[2].find(" 100.00      0     42"), std::string::npos) << lines[2];
}

TEST(AccuracyReport, TheTablesFileHasAColumnForEachFigure) {
  std::ostringstream out;
  write_table(one_row(), out);
  const std::vector<std::string> lines = lines_of(out.str());
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(columns_of(lines[0]), columns_of(lines[1]));
  EXPECT_EQ(lines[0].find("scene,method,center_rms_at_0_m,"), 0u);
  EXPECT_EQ(lines[1].find("a-scene-of-a-length,line,,,0.25,,,,,,0.25,"), 0u) << lines[1];
}

TEST(AccuracyReport, TheMapsFileHasALineForEachMap) {
  std::ostringstream out;
  write_maps_header(out);
  AccuracyScene scene;
  scene.name = "scene";
  write_maps(scene, 7, {"line", "fixed_weight", false}, {one_map(), one_map()}, out);
  const std::vector<std::string> lines = lines_of(out.str());
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(columns_of(lines[0]), columns_of(lines[1]));
  EXPECT_EQ(lines[1], "scene,7,line,3.5,,,0.25,,,,,,,,,,,1,0,,,0");
}

}  // namespace
}  // namespace relative_map::core
