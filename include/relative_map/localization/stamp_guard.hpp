#pragma once

#include "relative_map/model/time.hpp"

namespace relative_map::core {

/// Watches the stamps of all sources together. One stray stamp changes nothing; a clock that is set, or a
/// recording that starts again, is believed once enough messages in a row say so.
class StampGuard {
 public:
  enum class Verdict { kGood, kStray, kRestart };
  /// kRestart: what came before is of another time, and is to be forgotten. This one begins the new time.
  Verdict judge(Time stamp);

 private:
  bool begun_ = false;
  Time newest_{}, stray_{};
  int strays_ = 0;
};

}  // namespace relative_map::core
