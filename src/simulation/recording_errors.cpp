#include "relative_map/simulation/recording_errors.hpp"

#include <cmath>
#include <limits>

#include "relative_map/simulation/drive_path.hpp"
#include "relative_map/simulation/random_process.hpp"

namespace relative_map::core {

RecordedLine record_line(const RecordedLine& truth, const RecordingErrorParam& param, std::uint64_t seed) {
  if (param.offset == 0.0 && param.wander == 0.0) return truth;
  const DrivePath path = make_drive_path(truth);
  const double period = path.ends == Ends::kClosed ? path.length() : 0.0;
  const double offset = NoiseSource(seed, 20).draw(param.offset);
  const SmoothRandom wander(param.wander, param.wander_length, period, seed, 21);
  const double not_given = std::numeric_limits<double>::quiet_NaN();

  RecordedLine recorded;
  recorded.name = truth.name;
  recorded.priority = truth.priority;
  for (const PathPoint& point : path.points) {
    const Point2 moved =
        path.origin + point.position + (offset + wander.at(point.s)) * left_of(point.direction);
    recorded.points.push_back({moved.x(), moved.y(), not_given, not_given, not_given, not_given, not_given});
  }
  return recorded;
}

}  // namespace relative_map::core
