#include "relative_map/ros/health/throttled_log.hpp"

#include <cctype>

namespace relative_map {

namespace {

const ros::WallDuration kPeriod(10.0);  // between repetitions
constexpr std::size_t kMaxKept = 200;   // complaints; there are not that many kinds
constexpr std::size_t kMaxInPeriod = 30;

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// How many characters at `i` are a number's, "nan" and "inf" included; its sign is taken as part of the
/// text.
std::size_t number_length(const std::string& text, std::size_t i) {
  const bool within_word = i > 0 && is_letter(text[i - 1]);
  if (!within_word && (text.compare(i, 3, "nan") == 0 || text.compare(i, 3, "inf") == 0)) {
    return i + 3 < text.size() && is_letter(text[i + 3]) ? 0 : 3;
  }
  if (!is_digit(text[i])) return 0;
  std::size_t end = i;
  const auto skip_digits = [&] {
    while (end < text.size() && is_digit(text[end])) ++end;
  };
  skip_digits();
  if (end + 1 < text.size() && text[end] == '.' && is_digit(text[end + 1])) {
    ++end;
    skip_digits();
  }
  if (end + 2 < text.size() && text[end] == 'e' && (text[end + 1] == '-' || text[end + 1] == '+')) {
    end += 2;
    skip_digits();
  }
  return end - i;
}

std::string without_numbers(const std::string& text) {
  std::string rest;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = number_length(text, i);
    if (length == 0) {
      rest += text[i++];
      continue;
    }
    if (!rest.empty() && rest.back() == '-') rest.pop_back();
    i += length;
  }
  return rest;
}

}  // namespace

bool ThrottledLog::due(const std::string& complaint, const ros::WallTime& now) {
  if (period_start_.isZero() || now - period_start_ >= kPeriod) {
    period_start_ = now;
    told_in_period_ = 0;
  }
  if (last_.size() > kMaxKept) last_.clear();
  ros::WallTime& last = last_[without_numbers(complaint)];
  if (!last.isZero() && now - last < kPeriod) return false;
  // Complaints that differ each time, as in a name that is scrap, are kinds of their own: they must not flood
  // the log.
  if (++told_in_period_ > kMaxInPeriod) return false;
  last = now;
  return true;
}

}  // namespace relative_map
