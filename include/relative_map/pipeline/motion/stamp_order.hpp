#pragma once

#include <optional>
#include <string>

#include "relative_map/model/time.hpp"

namespace relative_map::core {

/// The one policy on stamps, for each input alike:
///  - repeated: a message with the stamp of the newest one is that message again, and is dropped;
///  - late: a message that is older than the newest one was overtaken by it, and is dropped;
///  - future: a message is dropped whose stamp is ahead of the clock by more than max_age, or by 0.2 s more
///  than
///    the stamps of this input ever were;
///  - backward: time has gone back where late messages say so: three or more in a row, by rising stamps that
///    span 0.2 s; and where the clock itself goes back by more than half a second (goes_back). What is known
///    is of another time then, and forgotten.
/// A clock that was set forward by less than max_age is believed like one that went back: where three in a
/// row say so. Nothing is made of a message that is dropped, and nothing is forgotten for it.
class StampOrder {
 public:
  struct Verdict {
    bool take = true;
    bool went_back = false;  ///< then it is taken, and what was known is of another time
    std::string remark;      ///< a sentence for a message that is dropped, or that sets time back; else empty
    bool of_the_future = false;
  };

  /// `name` of the input, which the sentences begin with.
  explicit StampOrder(std::string name) : name_(std::move(name)) {}

  /// `received`: when the message came, by the clock; none: not known, and no stamp is of the future.
  /// `max_age` [s]: how old, or how far ahead of the clock, a message may be.
  Verdict judge(Time stamp, std::optional<Time> received, double max_age);
  void reset() { *this = StampOrder(std::move(name_)); }

 private:
  /// Messages that are dropped one after the other, each later than the one before.
  struct Strays {
    int count = 0;
    Time first{}, last{};

    void add(Time stamp);
    bool insist() const;
  };
  Verdict took(Time stamp, std::optional<Duration> lead);

  std::string name_;
  std::optional<Time> newest_;
  std::optional<Duration> greatest_lead_;  ///< of a stamp that was taken, before its receipt
  Strays late_, ahead_;
};

/// Whether the clock was set back from `before` to `now`: by more than machines correct their clocks by.
bool goes_back(Time before, Time now);

}  // namespace relative_map::core
