#include "relative_map/ros/health/status_log.hpp"

#include "relative_map/ros/health/diagnostics.hpp"

namespace relative_map {

std::vector<StatusLog::Line> StatusLog::lines(const core::RelativeMap& map,
                                              const std::vector<std::string>& remarks,
                                              const ros::WallTime& now) {
  std::vector<Line> lines;
  if (map.status.code != core::StatusCode::kOk) {
    const std::string complaint = "no map: " + status_name(map.status.code) + ": " + map.status.message;
    if (kinds_.due(complaint, now)) {
      told_of_none_ = true;
      lines.push_back({true, complaint});
    }
    return lines;
  }
  if (told_of_none_ && kinds_.due("the map is back", now)) {
    told_of_none_ = false;
    lines.push_back({false, "the map is back: " + std::to_string(map.lanes.size()) + " lanes"});
  }
  for (const std::string& remark : remarks) {
    if (kinds_.due(remark, now)) lines.push_back({true, remark});
  }
  return lines;
}

}  // namespace relative_map
