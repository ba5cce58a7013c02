#include "relative_map/ros/setup/footprint.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "relative_map/ros/setup/parameters.hpp"

namespace relative_map {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kExact = 1e-6;  // [m] what is left of the decimals of rpy

std::string collision(const std::string& geometry, const std::string& xyz, const std::string& rpy = "0 0 0") {
  return "<collision><origin xyz='" + xyz + "' rpy='" + rpy + "'/><geometry>" + geometry +
         "</geometry></collision>";
}

std::string link(const std::string& name, const std::string& content = "") {
  return "<link name='" + name + "'>" + content + "</link>";
}

std::string joint(const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& xyz, const std::string& rpy = "0 0 0") {
  return "<joint name='" + parent + "_" + child + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + xyz + "' rpy='" + rpy +
         "'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>";
}

std::string robot(const std::string& content) {
  return "<robot name='car'>" + content + "</robot>";
}

const std::string kBox = "<box size='4.0 2.0 1.0'/>";
const std::string kMesh = "<mesh filename='package://car/body.stl'/>";

std::string refusal_of(const std::string& urdf, const std::string& base_frame = "base_link") {
  try {
    footprint_from_urdf(urdf, base_frame);
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "accepted";
}

void expect_footprint(const core::Footprint& footprint, double front, double rear, double half_width) {
  EXPECT_NEAR(footprint.front_overhang, front, kExact);
  EXPECT_NEAR(footprint.rear_overhang, rear, kExact);
  EXPECT_NEAR(footprint.half_width, half_width, kExact);
}

void expect_footprint_of(const std::string& links, double front, double rear, double half_width) {
  expect_footprint(footprint_from_urdf(robot(links), "base_link"), front, rear, half_width);
}

std::string sample_car() {
  std::stringstream text;
  text << std::ifstream(RELATIVE_MAP_SOURCE_DIR "/urdf/sample_car.urdf").rdbuf();
  return text.str();
}

TEST(Footprint, OfTheSampleCarIsThatOfItsBox) {
  expect_footprint(footprint_from_urdf(sample_car(), "base_link"), 3.80, 1.00, 0.95);
}

TEST(Footprint, OfAnOffsetBox) {
  expect_footprint_of(link("base_link", collision(kBox, "1.5 0.25 0.5")), 3.5, 0.5, 1.25);
}

TEST(Footprint, OfABoxOnTheOtherSideIsAsWide) {
  expect_footprint_of(link("base_link", collision(kBox, "1.5 -0.25 0.5")), 3.5, 0.5, 1.25);
}

TEST(Footprint, OfATurnedBox) {
  const double c = std::cos(0.5), s = std::sin(0.5);
  expect_footprint_of(link("base_link", collision(kBox, "0 0 0", "0 0 0.5")), 2.0 * c + 1.0 * s,
                      2.0 * c + 1.0 * s, 2.0 * s + 1.0 * c);
}

TEST(Footprint, OfAllPrimitivesTogether) {
  const std::string shapes = collision("<sphere radius='0.5'/>", "4.0 0 0") +
                             collision("<cylinder radius='0.3' length='1'/>", "-1 0 0") +
                             collision("<box size='0.1 0.1 0.1'/>", "0 1.2 0") + collision(kMesh, "90 0 0");
  expect_footprint_of(link("base_link", shapes), 4.5, 1.3, 1.25);
}

TEST(Footprint, OfAWheelOnItsAxle) {
  const std::string wheel =
      collision("<cylinder radius='0.4' length='0.2'/>", "0 0.8 0.4", "1.5707963267948966 0 0");
  expect_footprint_of(link("base_link", wheel), 0.4, 0.4, 0.9);
}

TEST(Footprint, OfRoundShapesIsTheSameHoweverTheyAreTurned) {
  expect_footprint_of(link("base_link", collision("<sphere radius='0.5'/>", "1 0 0", "0.4 0.5 0.7")), 1.5,
                      0.0, 0.5);
  expect_footprint_of(
      link("base_link", collision("<cylinder radius='0.5' length='2'/>", "1 0 0", "0 0 0.7853981634")), 1.5,
      0.0, 0.5);
}

TEST(Footprint, OfALeaningCylinder) {
  // Its axis points 0.3 rad from z to x.
  const double reach = 1.0 * std::sin(0.3) + 0.5 * std::cos(0.3);
  expect_footprint_of(link("base_link", collision("<cylinder radius='0.5' length='2'/>", "0 0 0", "0 0.3 0")),
                      reach, reach, 0.5);
}

TEST(Footprint, FollowsFixedJoints) {
  // The bumper's box is turned by 90 degrees at its joint: 4 m along y.
  expect_footprint_of(link("base_link") + link("frame") + link("bumper", collision(kBox, "0.5 0 0")) +
                          joint("fixed", "base_link", "frame", "1 0 0") +
                          joint("fixed", "frame", "bumper", "2 0 0", "0 0 1.5707963267948966"),
                      4.0, 0.0, 2.5);
}

TEST(Footprint, LeavesOutWhatMoves) {
  for (const char* type : {"continuous", "revolute", "prismatic", "floating"}) {
    SCOPED_TRACE(type);
    expect_footprint_of(
        link("base_link", collision(kBox, "0 0 0")) + link("trailer", collision(kBox, "0 0 0")) +
            link("light", collision(kBox, "0 0 0")) + joint(type, "base_link", "trailer", "-9 0 0") +
            joint("fixed", "trailer", "light", "-9 0 0"),
        2.0, 2.0, 1.0);
  }
}

TEST(Footprint, IsThatOfTheWholeVehicleWhereBaseLinkIsNotTheRoot) {
  // The rear axle lies 1.5 m behind the body's middle.
  expect_footprint_of(link("body", collision(kBox, "0 0 0")) + link("base_link") +
                          joint("fixed", "body", "base_link", "-1.5 0 0"),
                      3.5, 0.5, 1.0);
}

TEST(Footprint, StaysInTheFixedPartOfTheTree) {
  expect_footprint_of(link("world", collision("<box size='90 90 1'/>", "0 0 0")) +
                          link("body", collision(kBox, "0 0 0")) + link("base_link") +
                          joint("floating", "world", "body", "0 0 0") +
                          joint("fixed", "body", "base_link", "-1.5 0 0"),
                      3.5, 0.5, 1.0);
}

TEST(Footprint, IsSeenFromTheBaseFrame) {
  const core::Footprint footprint =
      footprint_from_urdf(robot(link("base_link", collision(kBox, "0 0 0")) + link("rear_axle") +
                                joint("fixed", "base_link", "rear_axle", "-1 0 0", "0 0 1.5707963267948966")),
                          "rear_axle");
  // Turned to the left: the box's 4 m lie along y, from -3 m to 1 m.
  expect_footprint(footprint, 1.0, 1.0, 3.0);
}

TEST(Footprint, RefusesWhatIsNoUrdf) {
  EXPECT_EQ(refusal_of("this is no XML"), "robot_description is no valid URDF");
  EXPECT_EQ(refusal_of("<robot name='car'>"), "robot_description is no valid URDF");
  EXPECT_EQ(refusal_of("<sdf/>"), "robot_description is no valid URDF");
  EXPECT_EQ(refusal_of(robot("")), "robot_description is no valid URDF");
}

TEST(Footprint, RefusesSizesThatAreNoNumbers) {
  EXPECT_NE(refusal_of(robot(link("base_link", collision("<box size='4 wide 1'/>", "0 0 0")))), "accepted");
  EXPECT_NE(refusal_of(robot(link("base_link", collision(kBox, "0 here 0")))), "accepted");
}

TEST(Footprint, RefusesAVehicleWithoutTheBaseFrame) {
  EXPECT_EQ(refusal_of(sample_car(), "rear_axle"), "robot_description has no link 'rear_axle'");
}

TEST(Footprint, RefusesAVehicleOfMeshesAlone) {
  EXPECT_THAT(refusal_of(robot(link("base_link", collision(kMesh, "0 0 0")))),
              HasSubstr("no collision box, cylinder or sphere fixed to 'base_link'"));
}

TEST(Footprint, IgnoresVisuals) {
  const std::string visual = "<visual><geometry>" + kBox + "</geometry></visual>";
  EXPECT_THAT(refusal_of(robot(link("base_link", visual))), HasSubstr("no collision box"));
}

TEST(Footprint, OfTheUrdfGoesIntoTheConfiguration) {
  const std::string urdf = robot(link("base_link", collision(kBox, "1.5 0 0")));
  expect_footprint(make_node_config({}, urdf).pipeline.footprint, 3.5, 0.5, 1.0);
}

TEST(Footprint, ATfPrefixNeedNotBeInTheDescription) {
  const std::string urdf = robot(link("base_link", collision(kBox, "1.5 0 0")));
  expect_footprint(footprint_from_urdf(urdf, "car1/base_link"), 3.5, 0.5, 1.0);
  expect_footprint(footprint_from_urdf(urdf, "fleet/car1/base_link"), 3.5, 0.5, 1.0);
  EXPECT_THAT(refusal_of(urdf, "car1/rear_axle"), HasSubstr("no link 'car1/rear_axle'"));
  const std::string prefixed = robot(link("car1/base_link", collision(kBox, "1.0 0 0")));
  expect_footprint(footprint_from_urdf(prefixed, "car1/base_link"), 3.0, 1.0, 1.0);
}

TEST(Footprint, ParametersTakeTheUrdfsPlaceOneByOne) {
  const std::string urdf = robot(link("base_link", collision(kBox, "1.5 0 0")));
  const NodeConfig config = make_node_config({{"footprint/half_width", 1.25}}, urdf);
  expect_footprint(config.pipeline.footprint, 3.5, 0.5, 1.25);
}

TEST(Footprint, GivenWholeByParametersNeedsNoUrdf) {
  const ParameterSet whole = {
      {"footprint/half_width", 1.1}, {"footprint/front_overhang", 4.0}, {"footprint/rear_overhang", 0.9}};
  expect_footprint(make_node_config(whole, "this is no XML").pipeline.footprint, 4.0, 0.9, 1.1);
}

TEST(Footprint, ABadUrdfIsAFaultAmongTheOthers) {
  try {
    make_node_config({{"rate", 0.0}, {"footprint/half_width", 1.1}}, "this is no XML");
    FAIL() << "accepted";
  } catch (const std::runtime_error& fault) {
    EXPECT_THAT(fault.what(), AllOf(HasSubstr("robot_description is no valid URDF"), HasSubstr("rate is 0")));
  }
}

}  // namespace
}  // namespace relative_map
