#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/time.hpp"

namespace relative_map::core {

/// What else is known of how the vehicle moves; NaN: not given.
struct KnownMotion {
  double speed = 0.0;           ///< [m/s]
  int direction = 0;            ///< 1: forwards, -1: in reverse, 0: not known
  double yaw_rate = 0.0;        ///< [rad/s] measured, not made of headings
  double position_noise = 0.0;  ///< [m] of one coordinate, white from pose to pose
};

/// A direction that localization gives, held against the course that its positions show. The vehicle goes
/// where it points (in reverse: where it does not), but for the slip of a few degrees that tyres have.
///
/// The way is cut into legs. Of each, the steps between its poses are turned into the body frame that the
/// direction claims, and added: their sum must lie along x, in curves as well. Noise of positions falls with
/// the length of a leg, so that a leg is as long as the noise asks for; a jump of localization spoils one
/// leg, and a verdict takes three.
class CourseCheck {
 public:
  enum class Verdict { kUnknown, kBorneOut, kContradicted };
  /// What most likely is wrong with a direction that is contradicted.
  enum class Cause { kNone, kNeverFilled, kFixed, kCompass, kDegrees, kQuarterTurn, kHalfTurn, kOffset };

  /// A pose of base_link by the direction in question, by rising stamps.
  void add(Time stamp, const Pose2& base, const KnownMotion& motion);
  /// The direction is known to be wrong by another witness: it counts as contradicted until motion bears it
  /// out.
  void doubt(Cause cause);
  void reset() { *this = CourseCheck(); }

  Verdict verdict() const { return verdict_; }
  /// None, unless it is contradicted.
  Cause cause() const { return cause_; }
  /// [rad] by which the direction is turned to the left of the course, in the last legs; NaN: there are none.
  double latest_offset() const;
  /// [rad] the same in the long run, as far as it is certain; 0: nothing is.
  double steady_offset() const;

 private:
  struct Leg {
    double seconds = 0.0;
    Point2 moved = Point2::Zero();  ///< [m] in the body frame that the direction claims
    double course = 0.0;            ///< [rad] from east, of the vehicle's front
    double heading = 0.0;           ///< [rad] as claimed, in the middle
    double turned = 0.0;            ///< [rad] as claimed
    double yaw = 0.0;               ///< [rad] turned by the yaw rate; NaN: not known
    double noise = 0.0;             ///< [rad] of the course, by that of positions
    bool joined = false;            ///< it begins where the one before ended
    double offset() const;          ///< [rad] heading less course
  };
  /// What the last legs tell, as many of them as it takes.
  struct Finding {
    bool contradicts = false, bears_out = false;
    double turned = 0.0;         ///< [rad]
    bool turned_unlike = false;  ///< the direction has not turned as the yaw rate says
  };
  void restart(Time stamp, const Pose2& base, int direction, bool joined);
  /// A direction that is right by chance, as that of a compass is on a road to the north-east, is found out
  /// as soon as the road turns, unless it has turned with a road before.
  void look_at_turn(const Pose2& base, double noise);
  void close_leg(const Pose2& base, double noise);
  Finding look_back() const;
  void judge(const Leg& leg);
  void contradict(Cause cause);
  void learn_offset(const Leg& leg);
  Cause likely_cause() const;
  /// Whether a direction with the fault that was found would show this leg, too.
  bool explained(const Leg& leg) const;

  // The leg that is driven now.
  std::optional<Time> begin_, last_stamp_;
  Pose2 begin_pose_, last_pose_;
  KnownMotion last_motion_;
  int direction_ = 0;
  bool joined_ = false;
  Point2 moved_ = Point2::Zero();
  double yaw_ = 0.0;

  std::deque<Leg> legs_;  ///< the last ones
  Verdict verdict_ = Verdict::kUnknown;
  Cause cause_ = Cause::kNone;
  bool proven_ = false;       ///< it has turned with the course
  bool doubted_ = false;      ///< by another witness, not by legs
  double aside_ = 0.0;        ///< [s] of the last legs that are all aside
  double unexplained_ = 0.0;  ///< [s] of those along, that the fault does not explain
  double borne_out_ = 0.0;    ///< [s] of legs along since the verdict
  // The steady offset.
  Point2 steady_ = Point2::Zero();  ///< [m] moved in straight legs, old ones fade
  double steady_noise_ = 0.0;       ///< [rad] of such a leg's course
  int steady_legs_ = 0, outliers_ = 0;
};

}  // namespace relative_map::core
