#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/simulation/drive_mapping.hpp"

namespace relative_map::core {

/// The plain textbook filter that the estimator has to beat: where the lane is beside a curve that tells its
/// shape, in four numbers that walk at random. Offset d [m] and heading phi [rad] of the lane against the
/// curve at the vehicle, left positive, and the half widths wl and wr [m]. One setting, no hypotheses.
class ReferenceFilter {
 public:
  ReferenceFilter() { restart(); }

  void restart();
  /// Nothing has fitted for a while: the state stays, but is not believed.
  void doubt();
  /// Widths are another lane's.
  void forget_widths();
  /// `dt` [s] have passed.
  void predict(double dt);

  struct Sample {
    double x = 0.0;        ///< [m] ahead
    double y = 0.0;        ///< [m] of the paint, to the left of the curve there
    double stretch = 1.0;  ///< [-] of a width, as seen along y: 1 / cos of the curve's direction
  };
  /// Paint of one side; false: it is too far from where it is expected, and left out.
  bool update(bool left, const std::vector<Sample>& samples);
  /// The curve has changed by so much: by a new shape of it, or because it was moved.
  void shift(double offset, double heading);

  double offset() const { return state_[0]; }
  double heading() const { return state_[1]; }
  double half_width(bool left) const { return state_[left ? 2 : 3]; }
  double offset_stddev() const { return std::sqrt(covariance_(0, 0)); }

 private:
  void correct(const Eigen::RowVector4d& h, double measured, double variance);

  Eigen::Vector4d state_;
  Eigen::Matrix4d covariance_;
};

/// Maps of that filter: of the nearest recorded line, or if there is none of the markers' own shape.
class ReferenceMapMaker : public MapMaker {
 public:
  explicit ReferenceMapMaker(const NavigationInfo& navigation);

  void deliver(const Delivery& delivery) override;
  RelativeMap tick(Time now) override;

 private:
  struct StampedPose {
    Time stamp{};
    Pose2 pose;
  };
  struct Line {
    RecordedLine recorded;
    Polyline points;      ///< [m] map frame; a lap's start is repeated at its end
    double length = 0.0;  ///< [m]
  };
  /// What is near of a line or of the markers' shape, in a body frame.
  struct Curve {
    Polyline points;
    std::size_t beside = 0;  ///< the segment beside the vehicle
    double lateral = 0.0;    ///< [m] of the curve at the vehicle, left positive
    double remaining = 0.0;  ///< [m]
  };
  std::optional<Pose2> pose_at(Time stamp) const;
  std::optional<Curve> cut(const Line& line, const Pose2& pose) const;
  std::optional<Curve> nearest_line(const Pose2& pose);
  void see(const LaneMarkers& markers);
  bool update(const LaneMarker& marker, bool left, const Curve& curve);
  bool follow_line(const LaneMarkers& markers, const Pose2& pose);
  bool follow_paint(const LaneMarkers& markers, const Pose2& pose);
  Lane make_lane(const Curve& curve) const;

  std::vector<Line> lines_;
  std::vector<StampedPose> poses_;
  ReferenceFilter filter_;
  std::string current_;        ///< name of the line that is followed
  std::optional<Line> shape_;  ///< of the markers, where there are no lines
  Time last_image_{}, last_used_{};
  std::uint32_t sequence_num_ = 0;
};

}  // namespace relative_map::core
