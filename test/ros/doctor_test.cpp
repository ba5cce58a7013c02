#include "relative_map/doctor/doctor.hpp"

#include <gmock/gmock.h>

#include <set>

#include "doctor_system.hpp"

namespace relative_map::doctor {
namespace {

using relative_map::test::kNaN;
using relative_map::test::quaternion;
using relative_map::test::yaw;
using test::change;
using test::Fault;
using test::healthy_system;
using testing::AllOf;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<Finding> findings_of(const Observations& seen, Severity severity) {
  std::vector<Finding> found;
  for (Finding& finding : diagnose(seen)) {
    if (finding.severity == severity) found.push_back(std::move(finding));
  }
  return found;
}

std::set<std::string> rules_of(const std::vector<Finding>& findings) {
  std::set<std::string> rules;
  for (const Finding& finding : findings) rules.insert(finding.rule);
  return rules;
}

std::string lines_of(const std::vector<Finding>& findings) {
  std::string lines;
  for (const Finding& finding : findings) lines += to_line(finding) + "\n";
  return lines;
}

std::vector<Fault> all_faults() {
  std::vector<Fault> faults;
  for (const auto& some : {test::node_faults(), test::topic_faults(), test::time_faults(),
                           test::frame_faults(), test::pose_faults(), test::motion_faults(),
                           test::line_faults(), test::marker_faults(), test::map_faults()}) {
    faults.insert(faults.end(), some.begin(), some.end());
  }
  return faults;
}

class DoctorFault : public testing::TestWithParam<Fault> {};

TEST_P(DoctorFault, IsFoundByItsRuleAndNoOther) {
  const Fault& fault = GetParam();
  Observations seen = healthy_system();
  fault.spoil(seen);
  const std::vector<Finding> found = findings_of(seen, Severity::kWrong);
  std::set<std::string> expected(fault.also.begin(), fault.also.end());
  expected.insert(fault.rule);
  EXPECT_EQ(rules_of(found), expected) << lines_of(found);
  EXPECT_THAT(found,
              Contains(AllOf(Field(&Finding::rule, fault.rule), Field(&Finding::what, HasSubstr(fault.what)),
                             Field(&Finding::mend, HasSubstr(fault.mend)))))
      << lines_of(found);
}

INSTANTIATE_TEST_SUITE_P(Doctor, DoctorFault, testing::ValuesIn(all_faults()),
                         [](const testing::TestParamInfo<Fault>& info) {
                           return std::string(info.param.name);
                         });

/// A vehicle may be without it: the speed is then localization's.
TEST(Doctor, NotesThatThereIsNoChassis) {
  Observations seen = healthy_system();
  seen.chassis.topic.publishers.clear();
  seen.chassis.messages.clear();
  seen.chassis.topic.elsewhere = {"/can/chassis"};
  EXPECT_THAT(findings_of(seen, Severity::kWrong), IsEmpty()) << lines_of(diagnose(seen));
  EXPECT_THAT(findings_of(seen, Severity::kNote),
              Contains(AllOf(Field(&Finding::what, HasSubstr("nobody publishes /chassis")),
                             Field(&Finding::mend, HasSubstr("remap chassis:=/can/chassis")))));
}

TEST(Doctor, KnowsLinesThatCameFromFiles) {
  for (const bool somebody_could : {false, true}) {
    Observations seen = healthy_system();
    if (!somebody_could) seen.navigation.topic.publishers.clear();
    seen.navigation.messages.clear();
    seen.lines_in_use = 2;
    EXPECT_THAT(findings_of(seen, Severity::kWrong), IsEmpty()) << lines_of(diagnose(seen));
    seen.lines_in_use = 0;
    EXPECT_THAT(rules_of(findings_of(seen, Severity::kWrong)), testing::Not(IsEmpty()));
  }
}

TEST(Doctor, TellsCurvaturesThatAreRight) {
  Observations seen = healthy_system();
  change(seen.lane_markers, [](LaneMarkers& markers) {
    markers.left_lane_marker.c2_curvature = markers.right_lane_marker.c2_curvature = 0.005;
  });
  EXPECT_THAT(findings_of(seen, Severity::kWrong), IsEmpty()) << lines_of(diagnose(seen));
  EXPECT_THAT(lines_of(diagnose(seen)), HasSubstr("curvatures are those of the vehicle's way"));
}

TEST(Doctor, SaysNothingInAThousandCharacters) {
  Observations seen = healthy_system();
  NavigationInfo info = *seen.navigation.messages[0].message;
  for (int i = 0; i < 60; ++i) {
    info.navigation_path.push_back(
        relative_map::test::navigation_path({{1e9, 1e9}}, "bad_" + std::to_string(i), 1));
  }
  seen.navigation.messages[0].message = relative_map::test::shared(info);
  seen.config_fault = std::string(3000, 'x');
  for (const Finding& finding : diagnose(seen)) EXPECT_LE(to_line(finding).size(), 600u) << to_line(finding);
}

TEST(Doctor, FindsNothingWrongWithAHealthySystem) {
  const Observations seen = healthy_system();
  EXPECT_THAT(findings_of(seen, Severity::kWrong), IsEmpty()) << lines_of(diagnose(seen));
  EXPECT_THAT(findings_of(seen, Severity::kNote), IsEmpty()) << lines_of(diagnose(seen));
  EXPECT_GT(findings_of(seen, Severity::kOk).size(), 15u);
}

TEST(Doctor, EveryRuleHasAFaultThatItFinds) {
  std::set<std::string> tested;
  for (const Fault& fault : all_faults()) tested.insert(fault.rule);
  const std::vector<std::string> names = rule_names();
  EXPECT_EQ(tested, std::set<std::string>(names.begin(), names.end()));
}

TEST(Doctor, SaysOfNothingAtAllThatNobodyPublishes) {
  Observations seen;
  seen.transforms = test::transforms_of({});
  EXPECT_EQ(rules_of(findings_of(seen, Severity::kWrong)), std::set<std::string>{"topics_have_publishers"});
}

TEST(Doctor, TakesACarWithoutACameraForWhole) {
  Observations seen = healthy_system();
  seen.lane_markers =
      Input<LaneMarkers>{{"/perception/lane_markers", "relative_map/LaneMarkers", {}, {}, {}, {}}, {}};
  seen.lane_markers.topic.subscribers = {"/relative_map_manager"};
  EXPECT_THAT(findings_of(seen, Severity::kWrong), IsEmpty());
  EXPECT_EQ(rules_of(findings_of(seen, Severity::kNote)), std::set<std::string>{"topics_have_publishers"});
}

TEST(Doctor, TakesAStandingCarForWhole) {
  Observations seen = healthy_system();
  test::stop(seen);
  EXPECT_THAT(findings_of(seen, Severity::kWrong), IsEmpty()) << lines_of(diagnose(seen));
}

TEST(Doctor, TakesFieldsThatAreNotGivenForWhole) {
  Observations seen = healthy_system();
  change(seen.localization, [](LocalizationEstimate& message) {
    message.pose.heading = message.pose.angular_velocity_vrf.z = message.pose.linear_velocity.x = kNaN;
  });
  EXPECT_THAT(findings_of(seen, Severity::kWrong), IsEmpty()) << lines_of(diagnose(seen));
}

TEST(Doctor, TakesALaneWithoutPaintForWhole) {
  Observations seen = healthy_system();
  change(seen.lane_markers, [](LaneMarkers& markers) {
    markers.left_lane_marker.quality = markers.right_lane_marker.quality = 0.0;
  });
  EXPECT_THAT(findings_of(seen, Severity::kWrong), IsEmpty()) << lines_of(diagnose(seen));
  EXPECT_EQ(rules_of(findings_of(seen, Severity::kNote)), std::set<std::string>{"markers_make_a_lane"});
}

TEST(Doctor, TakesACarThatDrivesBackwardsInReverseForWhole) {
  Observations seen = healthy_system();
  auto& messages = seen.localization.messages;
  for (std::size_t i = 0, k = messages.size() - 1; i < k; ++i, --k) {
    std::swap(messages[i].message, messages[k].message);
  }
  std::size_t i = 0;
  change(seen.localization, [&](LocalizationEstimate& message) {
    message.header.stamp = messages[i++].at - ros::Duration(0.01);
    message.pose.linear_velocity.x *= -1.0;
    message.pose.linear_velocity.y *= -1.0;
    message.pose.angular_velocity_vrf.z *= -1.0;
  });
  change(seen.chassis, [](Chassis& chassis) { chassis.gear_location = Chassis::GEAR_REVERSE; });
  EXPECT_THAT(findings_of(seen, Severity::kWrong), IsEmpty()) << lines_of(diagnose(seen));
}

// Without a heading to compare with, the motion tells the convention.
TEST(Doctor, KnowsAnRfuOrientationByTheMotion) {
  Observations seen = healthy_system();
  change(seen.localization, [](LocalizationEstimate& message) {
    message.pose.orientation = quaternion(yaw(message.pose.heading - core::kPi / 2.0));
    message.pose.heading = kNaN;
  });
  EXPECT_THAT(
      findings_of(seen, Severity::kWrong),
      Contains(AllOf(Field(&Finding::rule, "heading_fits_motion"),
                     Field(&Finding::mend, HasSubstr("/relative_map/orientation_convention to rfu")))));
}

TEST(Doctor, ReadsRfuWhereThatIsSet) {
  Observations seen = healthy_system();
  seen.config.orientation_convention = OrientationConvention::kRfu;
  change(seen.localization, [](LocalizationEstimate& message) {
    message.pose.orientation = quaternion(yaw(message.pose.heading - core::kPi / 2.0));
  });
  EXPECT_THAT(findings_of(seen, Severity::kWrong), IsEmpty()) << lines_of(diagnose(seen));
}

TEST(Doctor, PrintsALineForEachFinding) {
  EXPECT_EQ(to_line({Severity::kOk, "a", "", ""}), "ok: a");
  EXPECT_EQ(to_line({Severity::kNote, "a", "b", ""}), "note: a -> b");
  EXPECT_EQ(to_line({Severity::kWrong, "a\nb", "c", ""}), "WRONG: a b -> mend: c");
}

}  // namespace
}  // namespace relative_map::doctor
