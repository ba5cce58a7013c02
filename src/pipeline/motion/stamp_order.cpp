#include "relative_map/pipeline/motion/stamp_order.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

constexpr int kSeveral = 3;                                 // messages in a row are no stray one
constexpr Duration kSpan = std::chrono::milliseconds(200);  // that they span: as long as a burst may last
constexpr Duration kJitter =
    std::chrono::milliseconds(200);  // of receipt: a simulated clock may tick at 5 Hz
constexpr Duration kCorrection = std::chrono::milliseconds(500);  // of a clock that is kept by NTP

}  // namespace

bool goes_back(Time before, Time now) {
  return now < before - kCorrection;
}

void StampOrder::Strays::add(Time stamp) {
  if (count == 0 || stamp <= last) {
    count = 0;
    first = stamp;
  }
  ++count;
  last = stamp;
}

bool StampOrder::Strays::insist() const {
  return count >= kSeveral && last - first >= kSpan;
}

StampOrder::Verdict StampOrder::took(Time stamp, std::optional<Duration> lead) {
  newest_ = stamp;
  if (lead) greatest_lead_ = greatest_lead_ ? std::max(*greatest_lead_, *lead) : *lead;
  late_ = ahead_ = Strays();
  return {};
}

StampOrder::Verdict StampOrder::judge(Time stamp, std::optional<Time> received, double max_age) {
  const auto dropped = [&](const std::string& why) {
    Verdict verdict;
    verdict.take = false;
    verdict.remark = name_ + ": header.stamp is " + why + ": dropped";
    return verdict;
  };
  std::optional<Duration> lead;
  if (received) lead = stamp - *received;
  if (lead && to_seconds(*lead) > max_age) {
    Verdict verdict = dropped(seconds_text(*lead) + " in the future");
    verdict.of_the_future = true;
    return verdict;
  }
  if (newest_ && stamp == *newest_) return dropped("that of the message before");
  if (newest_ && stamp < *newest_) {
    late_.add(stamp);
    if (!late_.insist()) return dropped(seconds_text(*newest_ - stamp) + " older than the newest one's");
    Verdict verdict = took(stamp, std::nullopt);
    greatest_lead_ = lead;
    verdict.went_back = true;
    verdict.remark = name_ + ": time has gone back: what was known is forgotten";
    return verdict;
  }
  if (lead && greatest_lead_ && *lead > *greatest_lead_ + kJitter) {
    ahead_.add(stamp);
    if (!ahead_.insist()) {
      return dropped(seconds_text(*lead - *greatest_lead_) + " further ahead than those before");
    }
  }
  return took(stamp, lead);
}

}  // namespace relative_map::core
