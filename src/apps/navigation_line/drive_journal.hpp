#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>
#include <topic_tools/shape_shifter.h>

#include <memory>
#include <string>

namespace relative_map {

/// What a live recording receives, written to a bag beside its result as it comes in: when the power fails,
/// all but the last second can be saved by `rosbag reindex`, and recorded from like any bag. Nothing is
/// written before the first message.
class DriveJournal {
 public:
  using Event = ros::MessageEvent<topic_tools::ShapeShifter const>;

  /// For a recording that goes to `result`. Throws std::runtime_error, one sentence, if a journal is there
  /// already: of a recording that was cut off.
  explicit DriveJournal(const std::string& result);
  /// Leaves a whole bag.
  ~DriveJournal();
  DriveJournal(const DriveJournal&) = delete;
  DriveJournal& operator=(const DriveJournal&) = delete;

  /// A fault to write ends the journal, and is told; the recording goes on without it.
  void add(const std::string& topic, const ros::Time& received, const Event& event);
  void add(const ros::Time& received, const tf2_msgs::TFMessage& static_transforms);
  /// The journal has done its service.
  void remove();
  /// Where it is, or empty: there is none.
  std::string place() const;

 private:
  template <class Message>
  void write(const std::string& topic, const ros::Time& received, const Message& message);
  void sync();
  void close();

  std::string path_;
  std::unique_ptr<rosbag::Bag> bag_;
  ros::WallTime synced_;
  bool wanted_ = true, on_disk_ = false;
};

}  // namespace relative_map
