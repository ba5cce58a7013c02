#include "whole_bag.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "relative_map/io/whole_file.hpp"

namespace relative_map {

void expect_bag_writable(const std::string& path) {
  core::expect_writable(path);
  if (!core::is_device(path)) return;
  throw std::runtime_error("cannot write " + path + ": a bag needs a file, and this is a device or a pipe");
}

namespace {

sigset_t interrupts() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

}  // namespace

DeferredInterrupts::DeferredInterrupts() {
  const sigset_t set = interrupts();
  pthread_sigmask(SIG_BLOCK, &set, &before_);
}

DeferredInterrupts::~DeferredInterrupts() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

bool DeferredInterrupts::pending() const {
  sigset_t waiting;
  sigpending(&waiting);
  return sigismember(&waiting, SIGINT) == 1 || sigismember(&waiting, SIGTERM) == 1;
}

WholeBag::WholeBag(const std::string& path) : path_(path), temporary_(core::temporary_name(path)) {
  expect_bag_writable(path);
  bag_ = std::make_unique<rosbag::Bag>();
  errno = 0;
  try {
    bag_->open(temporary_, rosbag::bagmode::Write);
  } catch (const std::exception& fault) {
    fail(fault);
  }
}

WholeBag::~WholeBag() {
  if (bag_) discard();
}

void WholeBag::close() {
  try {
    bag_->close();
  } catch (const std::exception& fault) {
    fail(fault);
  }
  bag_.reset();
  core::move_into_place(temporary_, path_);
}

void WholeBag::fail(const std::exception& fault) {
  // The system's word says more than rosbag's, where it has one.
  const bool io = dynamic_cast<const rosbag::BagIOException*>(&fault) != nullptr && errno != 0;
  const std::string reason = io ? std::strerror(errno) : fault.what();
  discard();
  throw std::runtime_error("cannot write " + path_ + ": " + reason);
}

void WholeBag::discard() {
  static_cast<void>(bag_.release());  // on a full disk its destructor writes once more, and throws
  unlink(temporary_.c_str());
}

}  // namespace relative_map
