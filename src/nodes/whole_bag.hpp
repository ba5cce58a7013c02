#pragma once

#include <rosbag/bag.h>

#include <exception>
#include <memory>
#include <string>

namespace relative_map {

/// Throws what WholeBag's constructor would for a path that no bag can be written to, and writes nothing.
void expect_bag_writable(const std::string& path);

/// A bag that comes out whole or not at all: it is written beside its place, and moved there when it is
/// closed. Everything throws std::runtime_error, one sentence with the path and the fault; what was at the
/// place is then untouched, and nothing is left beside it.
class WholeBag {
 public:
  explicit WholeBag(const std::string& path);
  /// Without close() nothing comes out.
  ~WholeBag();
  WholeBag(const WholeBag&) = delete;
  WholeBag& operator=(const WholeBag&) = delete;

  template <class Message>
  void write(const std::string& topic, const ros::Time& time, const Message& message) {
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

  std::string path_, temporary_;
  std::unique_ptr<rosbag::Bag> bag_;  ///< none: closed, or failed
};

}  // namespace relative_map
