#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/geometry/segment_index.hpp"
#include "relative_map/model/config.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// A recorded line, ready to be driven on.
struct NavigationLine {
  std::string id;    ///< unique among the lines of a message, and the same when it is sent again
  std::string name;  ///< as recorded
  std::uint32_t priority = 0;
  Point2 origin = Point2::Zero();  ///< map coordinates of the line's own origin
  PathPoints points;               ///< relative to `origin`; two or more, distinct, finite
  SegmentIndex index;
  Eigen::AlignedBox2d bounds;  ///< around all points
  Ends ends = Ends::kOpen;
  double length = 0.0;             ///< [m] a closed line's stitch included
  bool thinned = false;            ///< spacing varies, as resampling by curvature leaves it
  std::vector<std::size_t> kinks;  ///< vertices at which it turns back, rising: no lane leads past one

  bool closed() const { return ends == Ends::kClosed; }
  bool is_kink(std::size_t vertex) const { return std::binary_search(kinks.begin(), kinks.end(), vertex); }
};

/// All lines of one navigation message; immutable, and shared between threads as such.
struct NavigationLines {
  std::string frame_id;
  std::vector<NavigationLine> lines;
  std::vector<std::string> faults;  ///< what was refused or repaired, a sentence each
};

struct IntakeParam {
  bool stitch_closed_lines = true;
  double lane_half_width = 1.75;  ///< [m] ends that are farther apart do not meet

  /// As the map is configured. Of two different half widths the smaller one counts: a lap that is not closed
  /// ends, one that is closed over to another lane leads there.
  static IntakeParam of(const PipelineConfig& config);
};

/// Checks, cleans, indexes and stitches recorded lines. A pure function: run it on any thread.
/// A line with a coordinate that is not finite or not on Earth, or without two distinct points, is left out,
/// with a fault.
/// s comes from the positions; a line's own theta, kappa and dkappa are kept where they agree with them.
std::shared_ptr<const NavigationLines> prepare_navigation_lines(const NavigationInfo& info,
                                                                const IntakeParam& param);

}  // namespace relative_map::core
