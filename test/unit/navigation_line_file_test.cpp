#include "relative_map/io/navigation_line_file.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

namespace relative_map::core {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, gone afterwards.
class NavigationLineFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "navigation_line_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string file(const std::string& content) const {
    std::ofstream(path("line.smoothed")) << content;
    return path("line.smoothed");
  }

  /// What reading `content` complains of, without the file's path; empty: nothing.
  std::string fault(const std::string& content) const {
    const std::string name = file(content);
    try {
      read_navigation_line(name);
    } catch (const std::runtime_error& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.find(name), 0u) << text;
      return text.substr(name.size());
    }
    return "";
  }

  std::size_t files_in_folder() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_;
};

TEST_F(NavigationLineFile, ReadsApollosFormat) {
  const RecordedLine line = read_navigation_line(file(
      R"({"kappa": -0.000214, "s": 0.000000, "theta": 1.532189, "x":691188.668784, "y":3118142.638383, "dkappa":-0.000001}
{"kappa": -0.000215, "s": 0.400661, "theta": 1.532103, "x":691188.684266, "y":3118143.038745, "dkappa":-0.000002}
)"));
  EXPECT_EQ(line.name, "line");
  EXPECT_EQ(line.priority, 0u);
  ASSERT_EQ(line.points.size(), 2u);
  EXPECT_EQ(line.points[0].x, 691188.668784);
  EXPECT_EQ(line.points[0].y, 3118142.638383);
  EXPECT_TRUE(std::isnan(line.points[0].z));
  EXPECT_EQ(line.points[1].s, 0.400661);
  EXPECT_EQ(line.points[1].theta, 1.532103);
  EXPECT_EQ(line.points[1].kappa, -0.000215);
  EXPECT_EQ(line.points[1].dkappa, -0.000002);
}

TEST_F(NavigationLineFile, WhatIsNotGivenIsNan) {
  const RecordedLine line = read_navigation_line(file(R"({"x": 1, "y": -2, "theta": null})"));
  ASSERT_EQ(line.points.size(), 1u);
  const LinePoint& point = line.points[0];
  EXPECT_EQ(point.x, 1.0);
  EXPECT_EQ(point.y, -2.0);
  for (double value : {point.z, point.s, point.theta, point.kappa, point.dkappa})
    EXPECT_TRUE(std::isnan(value));
}

TEST_F(NavigationLineFile, SkipsBlankLinesAndAHeader) {
  const RecordedLine line = read_navigation_line(
      file("\n{\"frame\": \"map\", \"zone\": 50}\r\n  \r\n{\"x\": 1, \"y\": 2, \"z\": 3}\r\n\n"));
  ASSERT_EQ(line.points.size(), 1u);
  EXPECT_EQ(line.points[0].z, 3.0);
}

TEST_F(NavigationLineFile, NamesTheLineAndTheFault) {
  const std::string good = "{\"x\": 1, \"y\": 2}\n";
  EXPECT_EQ(fault(good), "");
  EXPECT_EQ(fault(""), ": has no points");
  EXPECT_EQ(fault("\n \n"), ": has no points");
  EXPECT_EQ(fault("{\"zone\": 50}\n"), ": has no points");
  EXPECT_EQ(fault(good + "{\"x\": 1, \"y\": 2"), ", line 2: not valid JSON near column 16");
  EXPECT_EQ(fault(good + "{\"x\": NaN, \"y\": 2}"), ", line 2: not valid JSON near column 7");
  EXPECT_EQ(fault("{\"x\": 1e999, \"y\": 2}"), ", line 1: not valid JSON: a number is out of range");
  EXPECT_EQ(fault("[1, 2]"), ", line 1: not a JSON object");
  EXPECT_EQ(fault("\n{\"x\": 1}\n"), ", line 2: y is missing");
  EXPECT_EQ(fault("{\"y\": 1, \"x\": null}\n"), ", line 1: x is missing");
  EXPECT_EQ(fault(good + "{\"zone\": 50}\n"), ", line 2: x is missing");
  EXPECT_EQ(fault("{\"x\": 1, \"y\": \"2\"}\n"), ", line 1: y is not a number");
  EXPECT_EQ(fault("{\"x\": 1, \"y\": 2, \"kappa\": true}\n"), ", line 1: kappa is not a number");
}

TEST_F(NavigationLineFile, AMissingFileAndAFolderAreFaults) {
  EXPECT_THROW(read_navigation_line(path("absent.smoothed")), std::runtime_error);
  EXPECT_THROW(read_navigation_line(folder_.string()), std::runtime_error);
}

TEST_F(NavigationLineFile, ComesBackAsWritten) {
  RecordedLine line;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  line.points.push_back({691188.668784, 3118142.638383, nan, -3.141592654, 0.016666667, -1e-9, 0.0});
  line.points.push_back({-0.000001, 0.0, 12.5, nan, nan, nan, nan});
  write_navigation_line(path("again.smoothed"), line);
  const RecordedLine back = read_navigation_line(path("again.smoothed"));
  ASSERT_EQ(back.points.size(), line.points.size());
  EXPECT_EQ(back.name, "again");
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    for (double LinePoint::*field : {&LinePoint::x, &LinePoint::y, &LinePoint::z, &LinePoint::theta,
                                     &LinePoint::kappa, &LinePoint::dkappa, &LinePoint::s}) {
      const double expected = line.points[i].*field, actual = back.points[i].*field;
      EXPECT_TRUE(actual == expected || (std::isnan(actual) && std::isnan(expected)))
          << expected << " came back as " << actual;
    }
  }
}

TEST_F(NavigationLineFile, ReplacesTheFileWholeAndLeavesNothingElse) {
  const std::string name = file("old");
  RecordedLine line;
  line.points.push_back({1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  write_navigation_line(name, line);
  EXPECT_EQ(read_navigation_line(name).points.size(), 1u);
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(NavigationLineFile, AFailedWriteLeavesWhatWasThere) {
  const std::string name = file("{\"x\": 1, \"y\": 2}\n");
  RecordedLine line;
  line.points.push_back({1.0, std::numeric_limits<double>::infinity(), 0.0, 0.0, 0.0, 0.0, 0.0});
  EXPECT_THROW(write_navigation_line(name, line), std::runtime_error);
  EXPECT_EQ(read_navigation_line(name).points.size(), 1u);

  line.points[0].y = 0.0;
  fs::create_directory(path("folder"));
  EXPECT_THROW(write_navigation_line(path("folder"), line), std::runtime_error);
  EXPECT_THROW(write_navigation_line(path("absent/line.smoothed"), line), std::runtime_error);
  EXPECT_EQ(files_in_folder(), 2u);
}

}  // namespace
}  // namespace relative_map::core
