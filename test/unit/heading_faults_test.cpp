#include <gmock/gmock.h>

#include "support/motion_drive.hpp"
#include "support/scene.hpp"

// Directions that are set up wrongly, through the whole pipeline.
namespace relative_map::core {
namespace {

using test::kNaN;
using test::MotionDrive;
using test::Scene;
using testing::HasSubstr;

constexpr double kDegree = kPi / 180.0;

/// A country road that begins in some direction, and the way along it.
MotionDrive country_drive(double heading) {
  MotionDrive drive;
  drive.heading = heading;
  drive.rate = 50.0;
  drive.speed = [](double t) { return std::min(14.0, 2.0 * t); };
  drive.curvature = [](double t) { return t < 8.0 ? 0.0 : 0.012 * std::sin(2.0 * kPi * (t - 8.0) / 12.0); };
  return drive;
}

struct Outcome {
  int maps = 0, ok = 0, turned = 0;  ///< turned: OK, and by 20 degrees or more, after 3 s of driving
  double worst_turn = 0.0;           ///< [rad] of maps that are OK, in the second half
  std::string told, remarks;
};

template <class Fault>
Outcome map_drive(const MotionDrive& drive, double seconds, bool with_chassis, Fault fault) {
  const std::vector<MotionDrive::Moment> moments = drive.drive(seconds);
  RecordedLine line;
  line.name = "road";
  Pose2 end;
  const auto add = [&](const Point2& point) {
    LinePoint vertex;
    vertex.x = point.x();
    vertex.y = point.y();
    vertex.theta = vertex.kappa = vertex.dkappa = vertex.s = kNaN;
    line.points.push_back(vertex);
  };
  for (const auto& moment : moments) {
    const Point2 place = moment.truth.position();
    if (line.points.empty()) add(place - 20.0 * moment.truth.forward());
    if ((place - Point2(line.points.back().x, line.points.back().y)).norm() > 1.0) add(place);
    end = moment.truth;
  }
  for (int i = 1; i < 300; ++i) add(end.position() + i * end.forward());
  Scene scene({line});
  Outcome outcome;
  double driven = 0.0;
  int since_tick = 0;
  for (auto moment : moments) {
    scene.wait(1.0 / drive.rate);
    moment.localization.stamp = scene.now();
    if (with_chassis) scene.pipeline().set_chassis({scene.now(), moment.speed}, scene.now());
    fault(moment.localization);
    scene.pipeline().set_localization(moment.localization, std::nullopt, scene.now());
    if (moment.speed > 0.5) driven += 1.0 / drive.rate;
    if (++since_tick < 5) continue;
    since_tick = 0;
    const RelativeMap map = scene.tick();
    ++outcome.maps;
    for (const std::string& remark : scene.pipeline().remarks()) outcome.remarks += remark + "\n";
    if (map.status.code != StatusCode::kOk) {
      outcome.told = map.status.message;
      continue;
    }
    ++outcome.ok;
    const PathPoints& path = map.lanes.at(0).path;
    const auto beside =
        std::min_element(path.begin(), path.end(), [](const PathPoint& a, const PathPoint& b) {
          return a.position.squaredNorm() < b.position.squaredNorm();
        });
    const double turn = std::abs(beside->theta);
    if (driven > 3.0 && turn >= 20.0 * kDegree) ++outcome.turned;
    if (moment.t > 0.5 * seconds) outcome.worst_turn = std::max(outcome.worst_turn, turn);
  }
  return outcome;
}

void turn_both(Localization& message, double angle) {
  message.heading = normalize_angle(message.heading + angle);
  message.map_from_body = message.map_from_body * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
}

struct Planted {
  const char* name;
  std::function<void(Localization&)> fault;
  const char* told;
};
const std::vector<Planted>& planted_headings() {
  static const std::vector<Planted> all = {
      {"compass", [](Localization& m) { m.heading = normalize_angle(kPi / 2.0 - m.heading); },
       "compass heading"},
      {"degrees", [](Localization& m) { m.heading /= kDegree; }, "degrees"},
      {"quarter", [](Localization& m) { m.heading = normalize_angle(m.heading - kPi / 2.0); }, "90 degrees"},
      {"half", [](Localization& m) { m.heading = normalize_angle(m.heading + kPi); }, "the other way round"},
  };
  return all;
}

TEST(HeadingFault, WithoutAnOrientationLeadsToNoMapThatIsTurned) {
  for (const Planted& planted : planted_headings()) {
    for (const double heading : {0.1, 1.2, 2.6, -2.0, -0.9}) {
      for (const bool with_chassis : {true, false}) {
        if (!with_chassis && planted.name == std::string("half"))
          continue;  // as in reverse, until it is fast
        const Outcome outcome = map_drive(country_drive(heading), 30.0, with_chassis, [&](Localization& m) {
          planted.fault(m);
          m.map_from_body.coeffs().setZero();
        });
        EXPECT_EQ(outcome.turned, 0) << planted.name << " " << heading << " " << with_chassis;
        EXPECT_LT(outcome.ok, outcome.maps / 3) << planted.name << " " << heading;
        EXPECT_THAT(outcome.told, HasSubstr(planted.told)) << heading << " " << with_chassis;
      }
    }
  }
}

TEST(HeadingFault, BesideARightOrientationIsFoundOutAndTold) {
  for (const Planted& planted : planted_headings()) {
    for (const double heading : {0.1, 1.2, 2.6, -2.0, -0.9}) {
      const Outcome outcome = map_drive(country_drive(heading), 30.0, true, planted.fault);
      EXPECT_EQ(outcome.turned, 0) << planted.name << " " << heading;
      EXPECT_GT(outcome.ok, outcome.maps * 8 / 10) << planted.name << " " << heading << ": " << outcome.told;
      EXPECT_LT(outcome.worst_turn, 3.0 * kDegree) << planted.name << " " << heading;
    }
  }
}

TEST(HeadingFault, AnIdentityThatWasNeverFilledGivesNoMap) {
  for (const double heading : {0.0, 1.2, -2.0}) {
    const Outcome outcome = map_drive(country_drive(heading), 20.0, true, [](Localization& m) {
      m.heading = kNaN;
      m.map_from_body.setIdentity();
    });
    EXPECT_EQ(outcome.ok, 0) << heading;
    EXPECT_THAT(outcome.told, HasSubstr("never filled"));
  }
}

TEST(HeadingFault, AHeadingThatIsNeverFilledBesideAnIdentityIsFoundOut) {
  for (const double heading : {0.0, 0.3, 1.2, -2.0}) {
    const Outcome outcome = map_drive(country_drive(heading), 40.0, true, [](Localization& m) {
      m.heading = 0.0;
      m.map_from_body.setIdentity();
    });
    EXPECT_EQ(outcome.turned, 0) << heading;
  }
}

TEST(HeadingFault, ASteadyOffsetIsCorrectedAndTold) {
  for (const double offset : {-4.0, 3.0}) {  // [deg]
    for (const bool with_chassis : {true, false}) {
      const Outcome outcome = map_drive(country_drive(0.7), 60.0, with_chassis,
                                        [&](Localization& m) { turn_both(m, offset * kDegree); });
      EXPECT_EQ(outcome.ok, outcome.maps) << outcome.told;
      EXPECT_LT(outcome.worst_turn, 1.2 * kDegree) << offset;
      EXPECT_THAT(outcome.remarks, HasSubstr("of where the vehicle drives: corrected by that"));
    }
  }
}

TEST(HeadingFault, AHealthyDriveIsNotTouched) {
  const Outcome outcome = map_drive(country_drive(2.0), 60.0, true, [](Localization&) {});
  EXPECT_EQ(outcome.ok, outcome.maps) << outcome.told;
  EXPECT_THAT(outcome.remarks, testing::Not(HasSubstr("of where the vehicle drives")));
}

TEST(LocalizationStatus, OfAnErrorIsInvalidLocalization) {
  Scene scene(test::three_straight_lines());
  const Pose2 pose(Point2(100.0, 0.0), 0.0);
  EXPECT_EQ(scene.at(pose).status.code, StatusCode::kOk);
  scene.wait(0.1);
  Localization failed = test::localization_at(pose, scene.now());
  failed.failure = "no satellites";
  scene.pipeline().set_localization(failed);
  const RelativeMap map = scene.tick();
  EXPECT_EQ(map.status.code, StatusCode::kInvalidLocalization);
  EXPECT_THAT(map.status.message, HasSubstr("status ERROR): no satellites"));
  EXPECT_EQ(scene.at(pose).status.code, StatusCode::kOk) << "it is back";
}

}  // namespace
}  // namespace relative_map::core
