#pragma once

#include <rosbag/bag.h>
#include <signal.h>

#include <exception>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>

namespace relative_map {

/// Throws what WholeBag's constructor would for a path that no bag of these topics can be written to, and
/// writes nothing.
void expect_bag_writable(const std::string& path, const std::set<std::string>& topics);

/// SIGINT, SIGTERM and SIGHUP wait until this goes, so that what was begun can be cleared away before they
/// end the process.
class DeferredInterrupts {
 public:
  DeferredInterrupts();
  ~DeferredInterrupts();
  DeferredInterrupts(const DeferredInterrupts&) = delete;
  DeferredInterrupts& operator=(const DeferredInterrupts&) = delete;
  bool pending() const;

 private:
  sigset_t before_;
};

/// A bag that comes out whole or not at all: it is written beside its place, and moved there when it is
/// closed. Everything throws std::runtime_error, one sentence with the path and the fault; what was at the
/// place is then untouched, and nothing is left beside it, as after an interrupt. A bag that is there already
/// is replaced only if a tool like this one made it: one that holds a topic other than `topics`, or was
/// recorded from a node, is somebody's drive.
class WholeBag {
 public:
  WholeBag(const std::string& path, const std::set<std::string>& topics);
  /// Without close() nothing comes out.
  ~WholeBag();
  WholeBag(const WholeBag&) = delete;
  WholeBag& operator=(const WholeBag&) = delete;

  template <class Message>
  void write(const std::string& topic, const ros::Time& time, const Message& message) {
    if (interrupts_.pending()) throw std::runtime_error("interrupted");
    try {
      bag_->write(topic, time, message);
    } catch (const std::exception& fault) {
      fail(fault);
    }
  }
  /// The last call.
  void close();

 private:
  [[noreturn]] void fail(const std::exception& fault);
  void discard();

  DeferredInterrupts interrupts_;  ///< goes last
  std::string path_, temporary_;
  std::unique_ptr<rosbag::Bag> bag_;  ///< none: closed, or failed
};

}  // namespace relative_map
