#include "relative_map/localization/stamp_guard.hpp"

#include <algorithm>
#include <chrono>

namespace relative_map::core {

namespace {

constexpr Duration kAhead = std::chrono::seconds(10);  // a longer silence is not one stamp's business
constexpr Duration kLate = std::chrono::seconds(2);    // how late a measurement may come
constexpr Duration kTogether = std::chrono::seconds(10);
constexpr int kBelieved = 20;  // strays in a row, a fifth of a second of an inertial sensor

}  // namespace

StampGuard::Verdict StampGuard::judge(Time stamp) {
  if (!begun_) {
    begun_ = true;
    newest_ = stamp;
    return Verdict::kGood;
  }
  if (stamp <= newest_ + kAhead && stamp >= newest_ - kLate) {
    newest_ = std::max(newest_, stamp);
    strays_ = 0;
    return Verdict::kGood;
  }
  const bool together = strays_ > 0 && stamp <= stray_ + kTogether && stamp >= stray_ - kTogether;
  strays_ = together ? strays_ + 1 : 1;
  stray_ = stamp;
  if (strays_ < kBelieved) return Verdict::kStray;
  strays_ = 0;
  newest_ = stamp;
  return Verdict::kRestart;
}

}  // namespace relative_map::core
