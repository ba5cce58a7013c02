#include "relative_map/ros/health/input_health.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace relative_map {

namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kTolerance = 0.1;  // of the rate: clocks and schedulers jitter
constexpr int kWindow = 5;          // looks at it, one a second

}  // namespace

InputHealth::InputHealth(InputExpectation expectation)
    : DiagnosticTask(expectation.topic),
      expectation_(std::move(expectation)),
      min_rate_(expectation_.min_rate),
      max_rate_(std::numeric_limits<double>::infinity()),
      frequency_(diagnostic_updater::FrequencyStatusParam(&min_rate_, &max_rate_, kTolerance, kWindow)),
      stamps_(diagnostic_updater::TimeStampStatusParam(-expectation_.max_age, expectation_.max_age)) {}

void InputHealth::note(const ros::Time& stamp) {
  if (!has_come_) frequency_.clear();  // it counts from here
  has_come_ = true;
  frequency_.tick();
  stamps_.tick(stamp);
}

void InputHealth::forget() {
  frequency_.clear();
}

bool InputHealth::note_published_type(const std::string& type) {
  const bool right = type.empty() || type == "*" || type == expectation_.type;
  const std::string fault = right ? ""
                                  : expectation_.topic + " is published as " + type + ", not as " +
                                        expectation_.type + ": none of its messages arrives";
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(fault_, fault) != fault && !fault.empty();
}

std::string InputHealth::fault() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return fault_;
}

void InputHealth::run(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!has_come_) {
    const std::string why = fault();
    status.add("Events since startup", 0);
    if (!why.empty()) {
      status.summary(DiagnosticStatus::ERROR, why);
    } else if (expectation_.needed) {
      status.summary(DiagnosticStatus::WARN, "no message has come yet");
    } else {
      status.summary(DiagnosticStatus::OK, "no message has come: well if the vehicle has none");
    }
    return;
  }
  frequency_.run(status);
  diagnostic_updater::DiagnosticStatusWrapper stamps;
  stamps_.run(stamps);
  // That none came since the last look is the frequency's business.
  if (status.level != DiagnosticStatus::ERROR) status.mergeSummary(stamps);
  status.values.insert(status.values.end(), stamps.values.begin(), stamps.values.end());
  if (!expectation_.needed) status.level = std::min<signed char>(status.level, DiagnosticStatus::WARN);
}

}  // namespace relative_map
