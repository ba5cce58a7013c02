#include "drive_journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "relative_map/io/whole_file.hpp"

namespace relative_map {

namespace {

constexpr double kSyncPeriod = 1.0;           // [s]
constexpr std::uint32_t kChunk = 768 * 1024;  // [bytes] of a bag, as is usual
constexpr std::uint32_t kAtOnce = 1;          // [bytes] a chunk ends with the next message

}  // namespace

DriveJournal::DriveJournal(const std::string& result) : path_(result + ".recording.bag") {
  wanted_ = !core::is_device(result);
  if (!wanted_ || access(path_.c_str(), F_OK) != 0) return;
  throw std::runtime_error(path_ +
                           " is left of a recording that was cut off: save it by rosbag reindex, and record "
                           "from it, or remove it");
}

DriveJournal::~DriveJournal() {
  close();
}

void DriveJournal::add(const std::string& topic, const ros::Time& received, const Event& event) {
  write(topic, received, event);
}

void DriveJournal::add(const ros::Time& received, const tf2_msgs::TFMessage& static_transforms) {
  write("/tf_static", received, static_transforms);
}

namespace {

void put(rosbag::Bag& bag, const std::string& topic, const ros::Time& time,
         const DriveJournal::Event& event) {
  bag.write(topic, time, event.getConstMessage(), event.getConnectionHeaderPtr());
}

void put(rosbag::Bag& bag, const std::string& topic, const ros::Time& time,
         const tf2_msgs::TFMessage& message) {
  bag.write(topic, time, message);
}

}  // namespace

template <class Message>
void DriveJournal::write(const std::string& topic, const ros::Time& received, const Message& message) {
  if (!wanted_) return;
  try {
    if (!bag_) {
      bag_ = std::make_unique<rosbag::Bag>();
      bag_->open(path_, rosbag::bagmode::Write);
      on_disk_ = true;
      synced_ = ros::WallTime::now();
    }
    // What is in a chunk that was not ended is lost with the power.
    const bool due = ros::WallTime::now() - synced_ > ros::WallDuration(kSyncPeriod);
    bag_->setChunkThreshold(due ? kAtOnce : kChunk);
    put(*bag_, topic, received, message);
    if (due) sync();
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "%s: cannot be written any longer, and power loss would lose the drive: %s\n",
                 path_.c_str(), fault.what());
    wanted_ = false;
    static_cast<void>(bag_.release());  // its destructor would write once more, and throw
  }
}

void DriveJournal::sync() {
  synced_ = ros::WallTime::now();
  std::fflush(nullptr);  // rosbag does not give its stream away
  const int descriptor = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  ::close(descriptor);
}

void DriveJournal::close() {
  if (!bag_) return;
  try {
    bag_->close();
    bag_.reset();
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "%s: %s\n", path_.c_str(), fault.what());
    static_cast<void>(bag_.release());
  }
}

void DriveJournal::remove() {
  close();
  if (on_disk_) unlink(path_.c_str());
  on_disk_ = wanted_ = false;
}

std::string DriveJournal::place() const {
  return on_disk_ ? path_ : "";
}

}  // namespace relative_map
