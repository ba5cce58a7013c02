#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <diagnostic_updater/update_functions.h>
#include <ros/time.h>

#include <atomic>
#include <mutex>
#include <string>

namespace relative_map {

/// What is expected of an input.
struct InputExpectation {
  std::string topic;      ///< resolved
  std::string type;       ///< e.g. relative_map/Chassis
  double min_rate = 0.0;  ///< [Hz] below it the input starves
  double max_age = 0.0;   ///< [s] of its stamps, when it comes
  bool needed = true;     ///< false: a vehicle may be without it
};

/// Whether an input comes as often, as fresh and as the type that it should: frequency and stamps by
/// diagnostic_updater's own tasks.
class InputHealth : public diagnostic_updater::DiagnosticTask {
 public:
  explicit InputHealth(InputExpectation expectation);

  /// A message has come.
  void note(const ros::Time& stamp);
  bool has_come() const { return has_come_; }
  /// ROS time has gone back: what was counted before does not compare.
  void forget();
  /// What its publisher sends, by the master; empty: nobody publishes. From any thread. True if that is a
  /// fault that was not known.
  bool note_published_type(const std::string& type);
  /// Why no message of it can come; empty: it can.
  std::string fault() const;
  const InputExpectation& expectation() const { return expectation_; }

  void run(diagnostic_updater::DiagnosticStatusWrapper& status) override;

 private:
  const InputExpectation expectation_;
  double min_rate_, max_rate_;  ///< [Hz] the task wants pointers
  diagnostic_updater::FrequencyStatus frequency_;
  diagnostic_updater::TimeStampStatus stamps_;
  std::atomic<bool> has_come_{false};
  mutable std::mutex mutex_;  ///< guards the next one
  std::string fault_;
};

}  // namespace relative_map
