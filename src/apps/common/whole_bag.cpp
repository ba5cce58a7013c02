#include "whole_bag.hpp"

#include <rosbag/view.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "relative_map/io/whole_file.hpp"

namespace relative_map {

namespace {

const std::string kBagMagic = "#ROSBAG V";

[[noreturn]] void keep(const std::string& path, const std::string& why) {
  throw std::runtime_error("cannot write " + path + ": " + why + ": name another file, or remove it first");
}

/// Throws if the bag at `path`, if there is one, may be somebody's recording.
void expect_replaceable(const std::string& path, const std::set<std::string>& topics) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return;
  if (core::RegularFile(path).start(kBagMagic.size()) != kBagMagic)
    return;  // no bag: it was named, so it goes
  rosbag::Bag bag;
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagException&) {
    keep(path, "a bag is there that was cut off, or is still recorded to");
  }
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    if (topics.count(connection->topic) == 0) {
      keep(path, "a bag is there that holds " + connection->topic + " (" + connection->datatype + ")");
    }
    // `rosbag record` notes who published; what this package's tools write was published by nobody.
    if (connection->header && connection->header->count("callerid") > 0) {
      keep(path, "a bag is there that was recorded from " + connection->header->at("callerid"));
    }
  }
}

}  // namespace

void expect_bag_writable(const std::string& path, const std::set<std::string>& topics) {
  core::expect_writable(path);
  if (core::is_device(path)) {
    throw std::runtime_error("cannot write " + path + ": a bag needs a file, and this is a device or a pipe");
  }
  expect_replaceable(path, topics);
}

namespace {

sigset_t interrupts() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGHUP);
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
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (sigismember(&waiting, signal) == 1) return true;
  }
  return false;
}

WholeBag::WholeBag(const std::string& path, const std::set<std::string>& topics)
    : path_(path), temporary_(core::temporary_name(path)) {
  expect_bag_writable(path, topics);
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
