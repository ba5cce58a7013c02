#include "relative_map/ros/throttled_log.hpp"

#include <algorithm>
#include <cctype>

namespace relative_map {

namespace {

const ros::WallDuration kPeriod(10.0);  // between repetitions
constexpr std::size_t kMaxKept = 200;   // complaints; there are not that many kinds

std::string without_numbers(std::string text) {
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  text.erase(std::remove_if(text.begin(), text.end(), is_digit), text.end());
  return text;
}

}  // namespace

bool ThrottledLog::due(const std::string& complaint, const ros::WallTime& now) {
  if (last_.size() > kMaxKept) last_.clear();
  ros::WallTime& last = last_[without_numbers(complaint)];
  if (!last.isZero() && now - last < kPeriod) return false;
  last = now;
  return true;
}

}  // namespace relative_map
