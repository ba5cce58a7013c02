#include "relative_map/simulation/drive_path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "relative_map/pipeline/lines/navigation_lines.hpp"

namespace relative_map::core {

double DrivePath::hold(double s) const {
  if (ends == Ends::kOpen) return std::clamp(s, 0.0, length());
  const double rest = std::fmod(s, length());
  return rest < 0.0 ? rest + length() : rest;
}

DrivePath make_drive_path(const RecordedLine& recorded) {
  NavigationInfo info;
  info.lines.push_back(recorded);
  const auto prepared = prepare_navigation_lines(info, IntakeParam());
  if (prepared->lines.empty()) throw std::invalid_argument(prepared->faults.front());
  const NavigationLine& line = prepared->lines.front();

  DrivePath path;
  path.origin = line.origin;
  path.points = line.points;
  path.ends = line.ends;
  if (line.closed()) {
    path.points.push_back(line.points.front());
    path.points.back().s = line.length;
  }
  return path;
}

}  // namespace relative_map::core
