#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/map.hpp"
#include "relative_map/simulation/recorded_drive.hpp"

namespace relative_map::core {

/// [m] ahead of the vehicle along the true lane center, where centerlines are compared.
constexpr std::array<double, 6> kErrorDistances = {0.0, 5.0, 10.0, 20.0, 30.0, 50.0};
constexpr double kMaxError =
    2.0;  ///< [m] errors count no more than that, and a missing lane counts that much

/// What one map is wrong by. Not there: it can't be told, as past the end of the road.
struct MapErrors {
  std::array<std::optional<double>, kErrorDistances.size()>
      center;                                               ///< [m] centerline, left of the truth positive
  std::optional<double> left_boundary, right_boundary;      ///< [m] at 10 m, likewise
  std::optional<double> left_half_width, right_half_width;  ///< [m] at 10 m, wider than the truth positive
  std::optional<double> heading;                            ///< [rad] at 10 m
  std::optional<double> jitter_10, jitter_30;  ///< [m] change from the map before, at points of the road
  std::optional<bool> usable;                  ///< covers the next 30 m, and is less than 1.5 m off at 10 m
  std::optional<double> beside;                ///< [m] as center at 0 m, but as large as it is
  std::optional<bool> consistent;  ///< that is within three of the standard deviations that the map claims
};

/// Measures the maps of one drive, in their order.
class AccuracyMeter {
 public:
  /// `drive` must outlive the meter.
  explicit AccuracyMeter(const RecordedDrive& drive) : drive_(drive) {}

  MapErrors measure(const RelativeMap& map);

 private:
  struct Published {
    Lane lane;
    Pose2 path_from_base;
    std::size_t true_lane;
  };
  MapErrors measure_lane(const Lane* lane, std::size_t true_lane, const TruePose& truth) const;
  void measure_jitter(const Published& now, const TruePose& truth, MapErrors& errors) const;

  const RecordedDrive& drive_;
  std::optional<Published> last_;
};

/// The offset [m] of a polyline from `point`, positive to the left as seen along `direction`. A little past
/// its ends it counts as straight; farther out there is none.
std::optional<double> lateral_offset(const Polyline& polyline, const Point2& point, const Point2& direction);

}  // namespace relative_map::core
