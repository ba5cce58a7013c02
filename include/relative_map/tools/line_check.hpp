#pragma once

#include <string>
#include <vector>

#include "relative_map/io/line_header.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

struct LineCheckParam {
  double max_gap = 5.0;         ///< [m] between points
  double max_curvature = 0.25;  ///< [1/m] that the vehicle can drive
  /// [1/(m s)] that its steering can change the curvature by: a car's wheels, by 50 degrees a second
  double max_curvature_rate = 0.3;
};

/// Something that makes a line unfit to be driven on, or says that it is not what it seems.
struct LineFault {
  std::string kind;             ///< e.g. "gap"; see line_fault_kinds()
  std::size_t point = 0;        ///< of the file, from 0: the worst one of those in a row
  double s = 0.0;               ///< [m] there, along the points
  std::size_t count = 1;        ///< how many points in a row
  std::string what;             ///< a sentence about the worst of them
  double from = 0.0, to = 0.0;  ///< [m] where the first and the last of them are, along the points
};

/// Every kind, in the order of the faults.
std::vector<std::string> line_fault_kinds();

/// The faults of a line as it was read, among them what the map node would refuse or repair; faults of one
/// kind at points in a row are one.
std::vector<LineFault> check_line(const RecordedLine& line, const LineHeader& header,
                                  const LineCheckParam& param);

}  // namespace relative_map::core
