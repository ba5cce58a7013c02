#include "relative_map/pipeline/lines/lanes_in_reach.hpp"

#include <algorithm>

#include "relative_map/pipeline/lines/current_lane.hpp"

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

std::variant<TrackedLines, Status> LanesInReach::track(const VehicleState& vehicle,
                                                       const PipelineConfig& config,
                                                       const std::string& current_id,
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
  TrackedLines tracked{track_all(vehicle, config.navigation_lane.max_distance_to_navigation_line, drops)};
  std::vector<TrackedLine>& lines = tracked.lines;
  tell(drops, remarks);
  if (lines.empty()) return nothing_left(drops);
  tracked.current = choose_current(lines, current_id);
  if (lines.size() > kMaxLanes) {
    remarks.push_back(std::to_string(lines.size()) + " lines are in reach: only the best " +
                      std::to_string(kMaxLanes) + " are used");
    std::swap(lines.front(), lines[tracked.current]);
    tracked.current = 0;
    std::sort(lines.begin() + 1, lines.end(),
              [](const TrackedLine& a, const TrackedLine& b) { return a.line->priority < b.line->priority; });
    lines.resize(kMaxLanes);
  }
  return tracked;
}

void LanesInReach::follow(TrackedLines& tracked, const VehicleState& vehicle, const PipelineConfig& config) {
  TrackedLines moved;
  for (std::size_t i = 0; i < tracked.lines.size(); ++i) {
    const NavigationLine& line = *tracked.lines[i].line;
    const auto place =
        tracker_of(line).track(line, vehicle, config.navigation_lane.max_distance_to_navigation_line);
    const auto* projection = std::get_if<LineProjection>(&place);
    if (i == tracked.current) {
      if (!projection) return;
      moved.current = moved.lines.size();
    }
    if (projection) moved.lines.push_back({&line, *projection});
  }
  tracked = std::move(moved);
}

}  // namespace relative_map::core
