#include "relative_map/pipeline/motion/heading_witness.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "relative_map/pipeline/motion/input_check.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"
#include "support/motion_drive.hpp"

namespace relative_map::core {
namespace {

using test::MotionDrive;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = kPi / 180.0;

using Fault = std::function<void(Localization&)>;

void turn_orientation(Localization& message, double angle) {
  message.map_from_body = message.map_from_body * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
}

struct Outcome {
  int poses = 0;
  int refused = 0;               ///< of them
  int turned = 0;                ///< by 20 degrees or more, and believed, after the deadline
  double worst_error = 0.0;      ///< [rad] of those that are believed, after 20 s
  double last_offset = 0.0;      ///< [rad] corrected
  std::string refusal, remarks;  ///< the last ones
};

/// What is believed of a drive, pose by pose.
Outcome judge(
    const MotionDrive& drive, double seconds, const Fault& fault = [](Localization&) {}, int direction = 2,
    bool with_speed = true, double deadline = 3.0) {
  HeadingWitness witness;
  Outcome outcome;
  double driven = 0.0;
  for (MotionDrive::Moment moment : drive.drive(seconds)) {
    fault(moment.localization);
    Checked<Localization> checked = check_numbers(moment.localization);
    KnownMotion motion;
    motion.speed = with_speed ? moment.speed : kNaN;
    motion.direction = direction == 2 ? (moment.speed < 0.0 ? -1 : 1) : direction;
    motion.yaw_rate = moment.localization.angular_velocity_body.z();
    const bool in_range = std::isnan(moment.localization.heading) == std::isnan(checked.input.heading);
    witness.add(checked.input, std::nullopt, motion, in_range);
    settle_direction(witness.evidence(), checked);
    ++outcome.poses;
    if (std::abs(moment.speed) > 0.5) driven += 1.0 / drive.rate;
    for (const std::string& remark : checked.remarks) outcome.remarks = remark;
    if (checked.refusal) {
      ++outcome.refused;
      outcome.refusal = checked.refusal->message;
      continue;
    }
    const auto state = make_vehicle_state(checked.input, std::nullopt);
    const double error = std::abs(
        angle_difference(std::get<VehicleState>(state).map_from_base.heading(), moment.truth.heading()));
    if (driven > deadline && error >= 20.0 * kDegree) ++outcome.turned;
    if (moment.t > 20.0) outcome.worst_error = std::max(outcome.worst_error, error);
  }
  return outcome;
}

/// A road with bends both ways, and straights between them.
double winding(double t) {
  return std::fmod(t, 16.0) < 6.0 ? 0.0 : 0.03 * std::sin(2.0 * kPi * std::fmod(t, 16.0) / 10.0);
}

std::vector<std::pair<std::string, MotionDrive>> healthy_drives() {
  std::vector<std::pair<std::string, MotionDrive>> drives;
  const auto add = [&](const std::string& name, auto change) {
    MotionDrive drive;
    drive.curvature = winding;
    change(drive);
    drives.emplace_back(name, drive);
  };
  add("plain", [](MotionDrive&) {});
  for (const double rate : {5.0, 10.0, 100.0}) {
    for (const double noise : {0.1, 0.3, 1.0}) {
      add("noise " + std::to_string(noise) + " at " + std::to_string(rate), [&](MotionDrive& drive) {
        drive.rate = rate;
        drive.position_noise = noise;
        drive.heading_noise = 0.01;
      });
    }
  }
  add("drift", [](MotionDrive& drive) { drive.drift = Point2(0.1, -0.15); });
  add("jumps", [](MotionDrive& drive) {
    drive.rate = 10.0;
    drive.position_noise = 0.1;
    drive.jumps = {{4.0, {0.0, 4.0}},  {9.0, {0.5, 0.0}},  {13.0, {-1.0, -1.0}}, {17.0, {0.0, -2.5}},
                   {23.0, {3.0, 0.0}}, {24.5, {0.0, 2.0}}, {31.0, {-2.0, 3.0}}};
  });
  add("slow", [](MotionDrive& drive) {
    drive.speed = [](double) { return 1.2; };
    drive.curvature = [](double t) { return 0.15 * std::sin(0.4 * t); };
    drive.position_noise = 0.05;
    drive.drift = Point2(0.03, 0.03);
  });
  add("slow and rough", [](MotionDrive& drive) {
    drive.speed = [](double) { return 1.5; };
    drive.position_noise = 0.4;
    drive.rate = 10.0;
    drive.jumps = {{5.0, {0.0, 1.5}}, {25.0, {1.5, 0.0}}, {26.0, {0.0, -1.5}}};
  });
  add("reversing", [](MotionDrive& drive) { drive.speed = [](double) { return -2.5; }; });
  add("stop and go", [](MotionDrive& drive) {
    drive.speed = [](double t) { return std::max(0.0, 5.0 * std::sin(0.5 * t)); };
    drive.position_noise = 0.2;
    drive.drift = Point2(0.05, 0.0);
  });
  add("parking", [](MotionDrive& drive) {
    drive.speed = [](double t) { return 1.5 * std::sin(0.7 * t); };
    drive.curvature = [](double t) { return std::sin(0.7 * t) > 0.0 ? 0.19 : -0.19; };
    drive.position_noise = 0.05;
  });
  add("skids", [](MotionDrive& drive) {
    drive.curvature = [](double) { return 0.0; };
    drive.slip = [](double t) {
      const double phase = std::fmod(t, 15.0);
      return phase > 10.0 && phase < 12.0 ? 0.6 * std::sin(kPi * (phase - 10.0) / 2.0) : 0.0;
    };
  });
  add("roundabout", [](MotionDrive& drive) {
    drive.speed = [](double) { return 7.0; };
    drive.curvature = [](double) { return 0.08; };
    drive.slip = [](double) { return 0.03; };
  });
  return drives;
}

TEST(HeadingWitness, NeverRefusesAHealthyDrive) {
  for (auto& [name, drive] : healthy_drives()) {
    for (const bool with_speed : {true, false}) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        drive.seed = seed;
        drive.heading = 0.9 * static_cast<double>(seed);
        const Outcome outcome = judge(
            drive, 60.0, [](Localization&) {}, 2, with_speed);
        EXPECT_EQ(outcome.refused, 0) << name << ": " << outcome.refusal;
        EXPECT_LT(outcome.worst_error, (drive.position_noise > 0.2 ? 7.0 : 5.0) * kDegree)
            << name << " " << with_speed;
      }
    }
  }
}

TEST(HeadingWitness, ALinkThatIsMountedAnyHowIsHealthy) {
  Eigen::Isometry3d base_from_link = Eigen::Isometry3d::Identity();
  base_from_link.translate(Eigen::Vector3d(2.4, -0.7, 0.9));
  base_from_link.rotate(Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()));
  MotionDrive drive;
  drive.speed = [](double) { return 5.0; };
  drive.curvature = [](double t) { return 0.1 * std::sin(0.3 * t); };
  HeadingWitness witness;
  for (const MotionDrive::Moment& moment : drive.drive(60.0)) {
    Localization link = moment.localization;
    Eigen::Isometry3d map_from_base = Eigen::Isometry3d::Identity();
    map_from_base.translate(link.position);
    map_from_base.rotate(link.map_from_body);
    const Eigen::Isometry3d map_from_link = map_from_base * base_from_link;
    link.position = map_from_link.translation();
    link.map_from_body = Eigen::Quaterniond(map_from_link.rotation());
    link.heading = kNaN;
    witness.add(link, base_from_link.inverse(), {moment.speed, 1, kNaN, 0.0});
  }
  EXPECT_EQ(witness.evidence().orientation.verdict, CourseCheck::Verdict::kBorneOut);
  EXPECT_NEAR(witness.evidence().orientation.steady_offset, 0.0, 0.3 * kDegree);
}

TEST(HeadingWitness, ReversingWithAGearThatIsNotKnownIsHealthy) {
  MotionDrive drive;
  drive.speed = [](double t) { return t < 10.0 ? 5.0 : -3.0; };
  drive.curvature = winding;
  EXPECT_EQ(judge(
                drive, 60.0, [](Localization&) {}, 0, false)
                .refused,
            0);
}

struct PlantedFault {
  const char* name;
  Fault fault;
  const char* told;
};

std::vector<PlantedFault> faults() {
  return {
      {"compass", [](Localization& m) { m.heading = normalize_angle(0.5 * kPi - m.heading); },
       "compass heading"},
      {"compass up to 360",
       [](Localization& m) { m.heading = kPi + normalize_angle(-0.5 * kPi - m.heading); }, "compass heading"},
      {"degrees", [](Localization& m) { m.heading /= kDegree; }, "degrees"},
      {"quarter turn", [](Localization& m) { m.heading = normalize_angle(m.heading - 0.5 * kPi); },
       "90 degrees"},
      {"half turn", [](Localization& m) { m.heading = normalize_angle(m.heading + kPi); },
       "the other way round"},
      {"never filled", [](Localization& m) { m.heading = 0.0; }, "never"},
      {"off by 30 degrees", [](Localization& m) { m.heading = normalize_angle(m.heading + 0.52); },
       "turned against the vehicle"},
  };
}

TEST(HeadingWitness, FindsOutAWrongHeading) {
  for (PlantedFault planted : faults()) {
    for (const double speed : {15.0, 6.0, -3.0}) {
      for (const double noise : {0.02, 0.3}) {
        for (std::uint64_t seed = 1; seed <= 8; ++seed) {
          MotionDrive drive;
          drive.seed = seed;
          drive.heading = 0.85 * static_cast<double>(seed) + 0.25;
          drive.curvature = winding;
          drive.speed = [&](double t) { return speed * std::min(1.0, 0.4 + 0.3 * t); };
          drive.position_noise = noise;
          drive.rate = seed % 2 ? 50.0 : 10.0;
          const auto alone = [&](Localization& message) {
            planted.fault(message);
            message.map_from_body.coeffs().setZero();
          };
          // Noise of 0.3 m takes its time at a walking pace.
          const double deadline = noise > 0.1 && speed < 10.0 ? 6.0 : 3.0;
          const Outcome outcome = judge(drive, 60.0, alone, 2, true, deadline);
          // A heading of 0 on a road to the east is off by 20 degrees for a moment only: noise hides that.
          EXPECT_LE(outcome.turned, noise > 0.1 ? 30 : 0)
              << planted.name << " at " << speed << " m/s, " << noise << " m, " << seed;
          if (noise > 0.1) continue;
          EXPECT_GT(outcome.refused, outcome.poses * 3 / 4) << planted.name << " at " << speed << " " << seed;
          EXPECT_THAT(outcome.refusal, HasSubstr(planted.told))
              << planted.name << " at " << speed << " " << seed;
        }
      }
    }
  }
}

TEST(HeadingWitness, TakesTheOrientationThatIsRightBesideAWrongHeading) {
  for (const PlantedFault& planted : faults()) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      MotionDrive drive;
      drive.seed = seed;
      drive.heading = 0.85 * static_cast<double>(seed) + 0.25;
      drive.curvature = winding;
      const Outcome outcome = judge(drive, 60.0, planted.fault);
      EXPECT_EQ(outcome.turned, 0) << planted.name << " " << seed;
      EXPECT_LT(outcome.refused, 3 * 50) << planted.name << " " << seed << ": " << outcome.refusal;
      EXPECT_LT(outcome.worst_error, 2.0 * kDegree) << planted.name << " " << seed;
    }
  }
}

TEST(HeadingWitness, TakesTheHeadingThatIsRightBesideAWrongOrientation) {
  for (const double turn : {0.5 * kPi, -0.5 * kPi, kPi, 0.6}) {
    MotionDrive drive;
    drive.curvature = winding;
    const Outcome outcome = judge(drive, 60.0, [&](Localization& m) { turn_orientation(m, turn); });
    EXPECT_EQ(outcome.turned, 0) << turn;
    EXPECT_LT(outcome.refused, 3 * 50) << turn << ": " << outcome.refusal;
    EXPECT_LT(outcome.worst_error, 2.0 * kDegree) << turn;
  }
}

TEST(HeadingWitness, AnOrientationOfTheOtherConventionIsFoundOut) {
  MotionDrive drive;
  drive.curvature = winding;
  const Outcome outcome = judge(drive, 30.0, [](Localization& m) {
    m.heading = kNaN;
    turn_orientation(m, -0.5 * kPi);
  });
  EXPECT_EQ(outcome.turned, 0);
  EXPECT_THAT(outcome.refusal, HasSubstr("orientation_convention"));
}

TEST(HeadingWitness, ASteadyOffsetIsEstimatedUsedAndTold) {
  for (const double offset : {-5.0, -3.0, -1.5, 2.0, 3.0, 5.0, 10.0}) {  // [deg]
    MotionDrive drive;
    drive.curvature = winding;
    drive.position_noise = 0.05;
    const Outcome outcome = judge(drive, 60.0, [&](Localization& m) {
      m.heading = normalize_angle(m.heading + offset * kDegree);
      turn_orientation(m, offset * kDegree);
    });
    EXPECT_EQ(outcome.refused, 0) << offset;
    EXPECT_LT(outcome.worst_error, 0.9 * kDegree)
        << offset;  // of white noise of 0.17 degrees, three times, too
    EXPECT_THAT(outcome.remarks, HasSubstr(offset > 0.0 ? "to the left of where the vehicle drives"
                                                        : "to the right of where the vehicle drives"));
  }
}

TEST(HeadingWitness, AHeadingThatBecomesRightIsTakenAgain) {
  MotionDrive drive;
  const auto converging = [](Localization& m) {
    if (m.stamp < at_seconds(1010.0)) m.heading = normalize_angle(m.heading + 1.2);
    m.map_from_body.coeffs().setZero();
  };
  const Outcome outcome = judge(drive, 60.0, converging);
  EXPECT_GT(outcome.refused, 7 * 50);
  EXPECT_LT(outcome.refused, 17 * 50);
  EXPECT_EQ(outcome.turned, 0);
}

TEST(PositionNoise, IsMeasured) {
  for (const double noise : {0.02, 0.3, 1.0}) {
    for (const double rate : {5.0, 20.0, 100.0}) {
      MotionDrive drive;
      drive.position_noise = noise;
      drive.rate = rate;
      drive.jumps = {{3.0, {0.0, 4.0}}};
      PositionNoise measured;
      for (const auto& moment : drive.drive(12.0)) {
        measured.add(moment.localization.stamp, moment.localization.position.head<2>());
      }
      EXPECT_NEAR(measured.stddev(), noise, 0.4 * noise + 0.01) << rate;
    }
  }
}

}  // namespace
}  // namespace relative_map::core
