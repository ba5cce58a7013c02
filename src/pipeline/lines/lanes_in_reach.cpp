#include "relative_map/pipeline/lines/lanes_in_reach.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

constexpr std::size_t kMaxLanes = 16;   // no road has more side by side
constexpr std::size_t kMaxReasons = 3;  // that are told one by one

void tell(const std::vector<LineDrop>& drops, std::vector<std::string>& remarks) {
  for (std::size_t i = 0; i < std::min(drops.size(), kMaxReasons); ++i) remarks.push_back(drops[i].reason);
  if (drops.size() > kMaxReasons) {
    remarks.push_back(std::to_string(drops.size() - kMaxReasons) + " more lines are out of reach");
  }
}

/// Past the end of one line and away from all others, the end is what matters.
Status nothing_left(const std::vector<LineDrop>& drops) {
  const bool at_end = std::any_of(drops.begin(), drops.end(),
                                  [](const LineDrop& drop) { return drop.code == StatusCode::kLineEnd; });
  if (at_end) return {StatusCode::kLineEnd, "the end of the line is reached"};
  return {StatusCode::kOffRoute, "no navigation line is in reach"};
}

}  // namespace

void LanesInReach::set_lines(std::shared_ptr<const NavigationLines> lines) {
  lines_ = std::move(lines);
  trackers_.assign(lines_->lines.size(), NavigationLineTracker());
}

void LanesInReach::reset() {
  for (NavigationLineTracker& tracker : trackers_) tracker.reset();
}

std::vector<TrackedLine> LanesInReach::track_all(const VehicleState& vehicle, double max_distance,
                                                 std::vector<LineDrop>& drops) {
  std::vector<TrackedLine> found;
  for (std::size_t i = 0; i < lines_->lines.size(); ++i) {
    const NavigationLine& line = lines_->lines[i];
    const auto tracked = trackers_[i].track(line, vehicle, max_distance);
    if (const auto* drop = std::get_if<LineDrop>(&tracked)) {
      drops.push_back({drop->code, "line '" + line.id + "': " + drop->reason});
    } else {
      found.push_back({&line, std::get<LineProjection>(tracked)});
    }
  }
  return found;
}

std::variant<std::vector<TrackedLine>, Status> LanesInReach::track(const VehicleState& vehicle,
                                                                   const PipelineConfig& config,
                                                                   std::vector<std::string>& remarks) {
  if (!lines_) return Status{StatusCode::kNoNavigationLine, "no navigation line received yet"};
  if (lines_->lines.empty()) {
    Status status{StatusCode::kNoNavigationLine, "no usable navigation line"};
    for (std::size_t i = 0; i < std::min(lines_->faults.size(), kMaxReasons); ++i) {
      status.message += "; " + lines_->faults[i];
    }
    return status;
  }

  std::vector<LineDrop> drops;
  std::vector<TrackedLine> tracked =
      track_all(vehicle, config.navigation_lane.max_distance_to_navigation_line, drops);
  tell(drops, remarks);
  if (tracked.empty()) return nothing_left(drops);
  if (tracked.size() > kMaxLanes) {
    remarks.push_back(std::to_string(tracked.size()) + " lines are in reach: only the best " +
                      std::to_string(kMaxLanes) + " are used");
    std::sort(tracked.begin(), tracked.end(),
              [](const TrackedLine& a, const TrackedLine& b) { return a.line->priority < b.line->priority; });
    tracked.resize(kMaxLanes);
  }
  return tracked;
}

}  // namespace relative_map::core
