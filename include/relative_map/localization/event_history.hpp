#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "relative_map/localization/measurements.hpp"

namespace relative_map::core {

/// What became of a measurement.
enum class Taken { kTaken, kTwice, kTooOld };

/// Runs a filter over measurements in the order of their stamps, in whatever order they come: the state after
/// each of the last seconds' measurements is kept, and where one comes late, those after it are run again.
/// The state is then, bit for bit, the one of all measurements in order.
///
/// `Filter` has a type State (a value, with everything that the filter remembers) and
///   State step(State before, const Event& event, const Event* next_imu) const
/// where `next_imu` is the inertial sample after a measurement of another source, if it has come.
template <class Filter>
class EventHistory {
 public:
  using State = typename Filter::State;

  /// `length`: how late a measurement may come. A measurement waits for an inertial sample at or after it,
  /// but when another is `imu_wait` newer, no longer.
  EventHistory(const Filter& filter, State initial, Duration length, Duration imu_wait)
      : filter_(filter), before_(std::move(initial)), length_(length), imu_wait_(imu_wait) {}

  EventHistory(const EventHistory&) = delete;
  EventHistory& operator=(const EventHistory&) = delete;

  Taken add(const Event& event) {
    if (has_begun_ && event.stamp < begin_) return Taken::kTooOld;
    const auto [place, is_new] = entries_.emplace(event.key(), Entry{event, State()});
    if (!is_new) return Taken::kTwice;
    const bool imu = event.source == Sensor::kImu;
    newest_ = has_begun_ ? std::max(newest_, event.stamp) : event.stamp;
    if (imu) newest_imu_ = has_imu_ ? std::max(newest_imu_, event.stamp) : event.stamp;
    has_imu_ = has_imu_ || imu;
    has_begun_ = true;
    auto first = place;
    // What was run with another inertial sample to come is run again.
    while (imu && first != entries_.begin() && !is_imu(std::prev(first))) --first;
    if (next_ == entries_.end() || first->first < next_->first) next_ = first;
    run();
    forget();
    return Taken::kTaken;
  }

  /// After the newest measurement that could be used.
  const State& state() const { return next_ == entries_.begin() ? before_ : std::prev(next_)->second.after; }
  /// The newest stamp of all.
  Time newest() const { return newest_; }
  bool empty() const { return !has_begun_; }
  const Filter& filter() const { return filter_; }

 private:
  struct Entry {
    Event event;
    State after;
  };
  using Entries = std::map<std::tuple<Time, Sensor>, Entry>;

  static bool is_imu(typename Entries::const_iterator entry) {
    return entry->second.event.source == Sensor::kImu;
  }
  bool is_ready(const Event& event) const {
    return (has_imu_ && event.stamp <= newest_imu_) || newest_ - event.stamp >= imu_wait_;
  }

  void run() {
    for (; next_ != entries_.end() && is_ready(next_->second.event); ++next_) {
      auto imu = std::next(next_);
      while (imu != entries_.end() && !is_imu(imu)) ++imu;
      const Event* next_imu = imu == entries_.end() || is_imu(next_) ? nullptr : &imu->second.event;
      next_->second.after = filter_.step(state(), next_->second.event, next_imu);
    }
  }

  void forget() {
    while (entries_.begin() != next_ && entries_.begin()->second.event.stamp < newest_ - length_) {
      before_ = std::move(entries_.begin()->second.after);
      begin_ = entries_.begin()->second.event.stamp;
      entries_.erase(entries_.begin());
    }
  }

  Filter filter_;
  State before_;  ///< all of `entries_`
  Duration length_, imu_wait_;
  Entries entries_;
  typename Entries::iterator next_ = entries_.end();  ///< the first that has not been run
  Time begin_{}, newest_{}, newest_imu_{};
  bool has_begun_ = false, has_imu_ = false;
};

}  // namespace relative_map::core
