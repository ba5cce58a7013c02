// Apollo's own unit-test messages of its RTK localization: what a fix and an inertial sample at one time
// make.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>

#include "reference_data.hpp"
#include "relative_map/localization/rtk/rtk_method.hpp"

namespace relative_map::core {
namespace {

/// The numbers of a text protobuf by their path, e.g. "pose.position.x".
std::map<std::string, double> read_protobuf(const std::filesystem::path& path) {
  static const std::regex kOpen(R"(^\s*(\w+)\s*\{\s*$)"), kField(R"(^\s*(\w+):\s*([-+0-9.eE]+)\s*$)");
  std::ifstream stream(path);
  std::map<std::string, double> fields;
  std::vector<std::string> folders;
  std::smatch match;
  for (std::string line; std::getline(stream, line);) {
    if (std::regex_match(line, match, kOpen)) {
      folders.push_back(match[1].str() + ".");
    } else if (line.find('}') != std::string::npos) {
      folders.pop_back();
    } else if (std::regex_match(line, match, kField)) {
      std::string name;
      for (const std::string& folder : folders) name += folder;
      fields[name + match[1].str()] = std::stod(match[2].str());
    }
  }
  return fields;
}

Eigen::Vector3d vector_of(const std::map<std::string, double>& fields, const std::string& name) {
  return {fields.at(name + ".x"), fields.at(name + ".y"), fields.at(name + ".z")};
}

Eigen::Quaterniond quaternion_of(const std::map<std::string, double>& fields, const std::string& name) {
  return {fields.at(name + ".qw"), fields.at(name + ".qx"), fields.at(name + ".qy"), fields.at(name + ".qz")};
}

TEST(ApolloRtk, OneFixAndOneSampleMakeItsMessage) {
  REQUIRE_REFERENCE_DATA();
  const std::filesystem::path folder = *test::reference_folder() + "/localization/apollo_rtk";
  const auto fix = read_protobuf(folder / "3_gps_1.pb.txt"), imu = read_protobuf(folder / "3_imu_1.pb.txt");
  const auto expected = read_protobuf(folder / "3_localization_result_2.pb.txt");
  // Apollo's body is right, forward, up.
  const Eigen::Quaterniond rfu_from_flu(Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitZ()));
  RtkReading reading;
  reading.antenna = vector_of(fix, "localization.position");
  reading.antenna_velocity = vector_of(fix, "localization.linear_velocity");
  reading.attitude = quaternion_of(fix, "localization.orientation") * rfu_from_flu;
  reading.rate = rfu_from_flu.inverse() * vector_of(imu, "imu.angular_velocity");
  reading.acceleration = rfu_from_flu.inverse() * vector_of(imu, "imu.linear_acceleration");
  const PoseEstimate made = compose_rtk(reading, Eigen::Vector3d::Zero());
  EXPECT_LT((made.position - vector_of(expected, "pose.position")).norm(), 1e-12);
  EXPECT_LT((made.velocity - vector_of(expected, "pose.linear_velocity")).norm(), 1e-12);
  EXPECT_NEAR(made.heading, expected.at("pose.heading"), 1e-12);
  EXPECT_LT(
      (made.map_from_body * made.acceleration_body - vector_of(expected, "pose.linear_acceleration")).norm(),
      1e-12);
  EXPECT_LT((made.map_from_body * made.rate_body - vector_of(expected, "pose.angular_velocity")).norm(),
            1e-12);
  EXPECT_LT(
      (rfu_from_flu * made.acceleration_body - vector_of(expected, "pose.linear_acceleration_vrf")).norm(),
      1e-12);
  EXPECT_LT((rfu_from_flu * made.rate_body - vector_of(expected, "pose.angular_velocity_vrf")).norm(), 1e-12);
}

}  // namespace
}  // namespace relative_map::core
