#include "relative_map/prediction/road_user_store.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace relative_map::core {

namespace {

// This many old frames in a row, rising: it is not one that came late, it is a new beginning.
constexpr int kNewBeginning = 5;
// A sight so far from what the filter expects is another road user's (an id that was swapped or used again).
constexpr double kSurprise = 40.0;     // squared standard deviations, 2 degrees of freedom: p = 2e-9
constexpr double kSurpriseStep = 3.0;  // [m] and at least so far off

std::string count_text(std::size_t count, const char* what) {
  std::ostringstream text;
  text << count << (count == 1 ? " road user " : " road users ") << what;
  return text.str();
}

}  // namespace

RoadUserStore::RoadUserStore(const RoadUserStoreParam& store, const MotionFilterParam& filter)
    : param_(store), filter_(filter), noise_(filter) {}

void RoadUserStore::clear() {
  *this = RoadUserStore(param_, filter_);
}

bool RoadUserStore::accepts(Time stamp) {
  if (!newest_) return true;
  if (std::abs(to_seconds(stamp - *newest_)) > param_.time_jump) {
    clear();
    remarks_.push_back("the stamp of road users jumped: all of them are forgotten");
    return true;
  }
  if (stamp > *newest_) {
    dropped_in_a_row_ = 0;
    dropped_.reset();
    return true;
  }
  dropped_in_a_row_ = dropped_ && stamp > *dropped_ ? dropped_in_a_row_ + 1 : 1;
  dropped_ = stamp;
  if (dropped_in_a_row_ < kNewBeginning) {
    remarks_.push_back("a frame of road users is not newer than the last one, and is dropped");
    return false;
  }
  clear();
  remarks_.push_back("time runs on from an earlier stamp: all road users are forgotten");
  return true;
}

std::vector<SeenRoadUser> RoadUserStore::plausible(const SeenRoadUsers& frame, const Point2& center) {
  std::vector<SeenRoadUser> good;
  good.reserve(frame.users.size());
  std::size_t not_finite = 0;
  for (const SeenRoadUser& seen : frame.users) {
    if (!seen.position.allFinite() || seen.position.norm() > 1e8) {
      ++not_finite;
      continue;
    }
    good.push_back(seen);
    SeenRoadUser& kept = good.back();
    // A box or a velocity that can't be is not given; the road user is still there.
    for (double* size : {&kept.length, &kept.width, &kept.height}) {
      if (!(*size >= 0.0 && *size < 100.0)) *size = 0.0;
    }
    if (!(kept.velocity.norm() <= param_.max_speed)) kept.velocity.setConstant(kNotGiven);
    if (!(kept.position_stddev > 0.0 && kept.position_stddev < 100.0)) kept.position_stddev = kNotGiven;
  }
  if (not_finite > 0) remarks_.push_back(count_text(not_finite, "without a place, left out"));
  const auto most = static_cast<std::size_t>(param_.max_road_users);
  if (good.size() > most) {
    remarks_.push_back(count_text(good.size() - most, "too many, the farthest are left out"));
    std::nth_element(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(most), good.end(),
                     [&](const SeenRoadUser& a, const SeenRoadUser& b) {
                       return (a.position - center).squaredNorm() < (b.position - center).squaredNorm();
                     });
    good.resize(most);
  }
  return good;
}

void RoadUserStore::add(const SeenRoadUsers& frame, const Point2& center) {
  remarks_.clear();
  if (!accepts(frame.stamp)) return;
  newest_ = frame.stamp;
  std::vector<SeenRoadUser> users = plausible(frame, center);
  // Of two with one id the one nearer to where that is expected is it.
  std::stable_sort(users.begin(), users.end(), [&](const SeenRoadUser& a, const SeenRoadUser& b) {
    if (a.id != b.id) return a.id < b.id;
    const auto known = users_.find(a.id);
    return known != users_.end() && known->second.distance_to(frame.stamp, a.position) <
                                        known->second.distance_to(frame.stamp, b.position);
  });
  const auto repeated =
      std::unique(users.begin(), users.end(), [](const auto& a, const auto& b) { return a.id == b.id; });
  if (repeated != users.end()) {
    const auto count = static_cast<std::size_t>(users.end() - repeated);
    remarks_.push_back(count_text(count, "with an id that is there already, left out"));
    users.erase(repeated, users.end());
  }
  for (const SeenRoadUser& seen : users) add(frame.stamp, seen);
  for (auto user = users_.begin(); user != users_.end();) {
    const bool gone = to_seconds(frame.stamp - user->second.stamp()) > param_.forget_after;
    user = gone ? users_.erase(user) : std::next(user);
  }
  measure_noise();
}

void RoadUserStore::add(Time stamp, const SeenRoadUser& seen) {
  const double least =
      seen.type == RoadUserType::kPedestrian ? filter_.min_pedestrian_stddev : filter_.min_position_stddev;
  const double stddev =
      std::max(least, std::isfinite(seen.position_stddev) ? seen.position_stddev : noise_.stddev());
  const auto known = users_.find(seen.id);
  if (known == users_.end()) {
    users_.emplace(seen.id, RoadUser(stamp, seen, stddev, filter_));
    return;
  }
  RoadUser& user = known->second;
  const bool other = user.distance_to(stamp, seen.position) > kSurpriseStep &&
                     user.surprise(stamp, seen, stddev, filter_) > kSurprise;
  if (!other) {
    user.see(stamp, seen, stddev, filter_, param_.history_length);
    if (user.speed() <= param_.max_speed) return;
  }
  user = RoadUser(stamp, seen, stddev, filter_);
}

void RoadUserStore::measure_noise() {
  // Standing ones count where nothing moves: some trackers hold them fast.
  for (const bool moving : {true, false}) {
    std::size_t measured = 0;
    for (const auto& [id, user] : users_) {
      const auto& history = user.history();
      if (history.size() < 4 || history.back().stamp != *newest_ || user.still() == moving) continue;
      Point2 positions[4];
      double steps[3];
      const std::size_t first = history.size() - 4;
      for (std::size_t i = 0; i < 4; ++i) positions[i] = history[first + i].position;
      for (std::size_t i = 0; i < 3; ++i) {
        steps[i] = to_seconds(history[first + i + 1].stamp - history[first + i].stamp);
      }
      noise_.add(positions, steps);
      ++measured;
    }
    if (measured >= 3) break;
  }
  noise_.end_frame();
}

std::vector<const RoadUser*> RoadUserStore::present(Time now) const {
  std::vector<const RoadUser*> users;
  users.reserve(users_.size());
  for (const auto& [id, user] : users_) {
    if (to_seconds(now - user.stamp()) <= param_.max_age) users.push_back(&user);
  }
  std::sort(users.begin(), users.end(),
            [](const RoadUser* a, const RoadUser* b) { return a->seen().id < b->seen().id; });
  return users;
}

}  // namespace relative_map::core
