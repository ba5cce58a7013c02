#include "relative_map/ros/health/map_observer.hpp"

#include <algorithm>
#include <limits>

#include "relative_map/pipeline/lanes/lane_path.hpp"

namespace relative_map {

namespace {

const ros::WallDuration kRateWindow(5.0);
const ros::WallDuration kSettleTime(0.5);  // that another status must last
const ros::WallDuration kDropOutWindow(10.0);
constexpr std::size_t kMaxLineFaults = 5;  // that are shown
const ros::WallDuration kRemarkTime(2.0);  // that a remark is shown, at once a second

}  // namespace

void MapObserver::note_input(const std::string& topic, const ros::Time& stamp, const ros::WallTime& arrival) {
  Input& input = inputs_[topic];
  input.stamp = stamp;
  input.arrivals.push_back(arrival);
  while (input.arrivals.front() < arrival - kRateWindow) input.arrivals.pop_front();
}

void MapObserver::settle_status(const core::Status& status, const ros::WallTime& now) {
  core::Status& settled = statistics_.last_map.status;
  const bool first = statistics_.maps == 0;
  if (first || status.code == settled.code) {
    differs_since_.reset();
    settled = status;
    return;
  }
  if (!differs_since_) differs_since_ = now;
  if (now - *differs_since_ < kSettleTime) return;
  differs_since_.reset();
  settled = status;
}

void MapObserver::note_map(const core::RelativeMap& map, double tick_time, const ros::WallTime& now) {
  settle_status(map.status, now);
  ++statistics_.maps;
  statistics_.tick_time = tick_time;
  statistics_.last_map.fusion = map.fusion;
  statistics_.last_map.current_lane_id = map.current_lane_id;
  statistics_.lanes = map.lanes.size();
  recent_.push_back({now, !map.lanes.empty()});
  while (recent_.front().at < now - kDropOutWindow) recent_.pop_front();
  if (map.lanes.empty()) {
    ++statistics_.empty_maps[status_name(map.status.code)];
    statistics_.last_fault = map.status;
  } else if (!map.status.message.empty()) {
    statistics_.remarks = map.status.message;
    remarked_ = now;
  }
  const auto current = std::find_if(map.lanes.begin(), map.lanes.end(),
                                    [&](const core::Lane& lane) { return lane.id == map.current_lane_id; });
  if (current == map.lanes.end()) return;
  core::LanePath path;
  path.points = current->path;
  core::locate_vehicle(path);
  std::size_t hint = 0;
  statistics_.lateral_offset = path.l;
  statistics_.heading_offset = -core::interpolate(path.points, path.s_at_vehicle, hint).theta;
  statistics_.remaining_distance = current->remaining_distance;
}

void MapObserver::note_lines(const core::NavigationLines& lines) {
  statistics_.lines = lines.lines.size();
  statistics_.line_faults = lines.faults;
  if (lines.faults.size() > kMaxLineFaults) statistics_.line_faults.resize(kMaxLineFaults);
}

void MapObserver::note_clock(const ros::Time& now, const ros::WallTime& wall_now) {
  if (clock_since_ && now == clock_) return;
  clock_ = now;
  clock_since_ = wall_now;
}

void MapObserver::count_drop_outs(const ros::WallTime& wall_now, MapStatistics& result) const {
  std::size_t seen = 0, empty = 0;
  bool filled = false;
  for (const Look& look : recent_) {
    if (look.at < wall_now - kDropOutWindow) continue;
    ++seen;
    if (!look.filled) ++empty;
    if (filled && !look.filled) ++result.drop_outs;
    filled = look.filled;
  }
  if (seen > 0) result.empty_share = static_cast<double>(empty) / static_cast<double>(seen);
}

MapStatistics MapObserver::statistics(const ros::Time& now, const ros::WallTime& wall_now) const {
  MapStatistics result = statistics_;
  if (clock_since_ && now == clock_) result.clock_stands = (wall_now - *clock_since_).toSec();
  count_drop_outs(wall_now, result);
  if (wall_now - remarked_ > kRemarkTime) result.remarks.clear();
  for (const auto& [topic, input] : inputs_) {
    if (input.arrivals.empty()) {
      result.inputs[topic] = {0.0, std::numeric_limits<double>::quiet_NaN()};
      continue;
    }
    const auto recent =
        std::count_if(input.arrivals.begin(), input.arrivals.end(),
                      [&](const ros::WallTime& arrival) { return arrival >= wall_now - kRateWindow; });
    const double watched = std::min(kRateWindow.toSec(), (wall_now - input.arrivals.front()).toSec());
    const double rate = watched > 0.0 ? static_cast<double>(recent) / watched : 0.0;
    // As numbers: a difference of times throws where it is more than 68 years, as of a stamp that is scrap.
    result.inputs[topic] = {rate, now.toSec() - input.stamp.toSec()};
  }
  return result;
}

}  // namespace relative_map
