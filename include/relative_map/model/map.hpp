#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// Numbers of the message MapStatus.
enum class StatusCode : std::uint8_t {
  kOk = 0,
  kNoLocalization = 1,
  kStaleLocalization = 2,
  kInvalidLocalization = 3,
  kNoNavigationLine = 4,
  kOffRoute = 5,
  kLineEnd = 6,
  kMarkersUnusable = 7,
  kFrameMismatch = 8,
  kNoTransform = 9,
  kContractViolation = 10,
};

struct Status {
  StatusCode code = StatusCode::kOk;
  std::string message;
};

/// Numbers of the message FusionState.
enum class Source : std::uint8_t { kNone = 0, kFused = 1, kNavigationLine = 2, kLaneMarkers = 3 };

/// A number with its standard deviation; -1: not estimated.
struct Estimate {
  double value = 0.0;
  double stddev = -1.0;
};

/// The offset between line and lane that was applied to the current lane.
struct FusionState {
  Source source = Source::kNone;
  std::string method;
  Estimate lateral_offset;       ///< [m] of the lane from the line at the vehicle, left positive
  Estimate longitudinal_offset;  ///< [m]
  Estimate heading_offset;       ///< [rad]
  Estimate left_half_width;      ///< [m]
  Estimate right_half_width;     ///< [m]
  double marker_range = 0.0;     ///< [m] how far ahead of the vehicle markers back the map
  double marker_age = -1.0;      ///< [s] -1: no markers
};

struct WidthSample {
  double s = 0.0;      ///< [m] along the centerline
  double width = 0.0;  ///< [m] to the nearest point of the border
};

/// Paint from s [m] along the boundary on.
struct PaintSpan {
  double s = 0.0;
  BoundaryType type = BoundaryType::kUnknown;
};

struct LaneBoundary {
  Polyline points;
  double length = 0.0;  ///< [m]
  bool is_virtual = false;
  std::vector<PaintSpan> paint;
};

/// A lane in the body frame; `path` is its centerline.
struct Lane {
  std::string id;
  std::string name;            ///< of the line, or of the source
  std::uint32_t priority = 0;  ///< 0 is the best of this map
  PathPoints path;
  double length = 0.0;              ///< [m] the last s
  double remaining_distance = 0.0;  ///< [m] from the vehicle to the line's end; a lap on a closed line
  double speed_limit = 0.0;         ///< [m/s]
  LaneBoundary left_boundary, right_boundary;
  std::vector<WidthSample> left_samples, right_samples;
  std::vector<WidthSample> left_road_samples, right_road_samples;
  std::string left_neighbor_id, right_neighbor_id;  ///< empty: none
};

struct Road {
  std::string id;
  std::vector<std::string> lane_ids;  ///< left to right
  Polyline left_edge, right_edge;
};

/// What is published: lanes left to right, or nothing and the reason.
struct RelativeMap {
  Time stamp{};          ///< the time that the geometry holds for
  std::string frame_id;  ///< the body frame
  std::uint32_t sequence_num = 0;
  Status status;
  std::vector<Lane> lanes;
  std::vector<Road> roads;  ///< one; none in an empty map
  std::string current_lane_id;
  FusionState fusion;
};

}  // namespace relative_map::core
