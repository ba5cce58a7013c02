#include "relative_map/localization/imu/imu_buffer.hpp"

#include <algorithm>
#include <chrono>

namespace relative_map::core {

namespace {

constexpr Duration kLength = std::chrono::seconds(2);

bool is_before(const std::pair<Time, ImuSample>& entry, Time time) {
  return entry.first < time;
}

}  // namespace

void ImuBuffer::add(Time stamp, const ImuSample& sample) {
  const auto place = std::lower_bound(samples_.begin(), samples_.end(), stamp, is_before);
  if (place != samples_.end() && place->first == stamp) return;
  if (!empty() && stamp < newest() - kLength) return;
  samples_.insert(place, {stamp, sample});
  while (samples_.front().first < newest() - kLength) samples_.pop_front();
}

ImuBuffer::Found ImuBuffer::at(Time time, double max_bracket) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), time, is_before);
  if (after == samples_.end()) return {std::nullopt, "there is no inertial sample after it yet"};
  if (after->first == time) return {after->second, ""};
  if (after == samples_.begin()) return {std::nullopt, "there is no inertial sample before it"};
  const auto before = std::prev(after);
  const double width = to_seconds(after->first - before->first);
  if (width > max_bracket) {
    return {std::nullopt,
            "the inertial samples around it are " + seconds_text(after->first - before->first) + " apart"};
  }
  const double weight = to_seconds(time - before->first) / width;
  const ImuSample &a = before->second, &b = after->second;
  return {ImuSample{a.angular_velocity + weight * (b.angular_velocity - a.angular_velocity),
                    a.specific_force + weight * (b.specific_force - a.specific_force)},
          ""};
}

}  // namespace relative_map::core
