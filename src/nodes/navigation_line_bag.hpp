#pragma once

#include <rosbag/bag.h>

#include <functional>
#include <string>
#include <vector>

#include "relative_map/io/line_formats.hpp"
#include "relative_map/tools/line_recorder.hpp"

namespace relative_map {

/// Opens a bag for reading; std::runtime_error, one sentence, if it is absent, cut off or no bag.
void open_bag(const std::string& path, rosbag::Bag& bag);

/// The topic of a bag that has one of these types, which must be there once if none is named. Throws a
/// sentence that lists what there is.
std::string find_topic(const rosbag::Bag& bag, const std::string& path, const std::string& topic,
                       const std::vector<std::string>& types);

/// A line as the last nav_msgs/Path of a topic, with its header as a std_msgs/String on TOPIC_header.
core::LineFile read_path_bag(const std::string& path, const std::string& topic);
void write_path_bag(const std::string& path, const std::string& topic, const core::LineFile& file);

/// Collects poses of any type that a line can be recorded from.
class PoseCollector {
 public:
  static const std::vector<std::string>& types();

  /// Takes a message's values; throws std::runtime_error if it is in another frame than those before.
  template <class Message>
  void add(const Message& message);
  /// Of NavSatFix: to be projected; without a fix or with a position that is not finite: left out.
  std::size_t without_fix() const { return without_fix_; }
  const std::string& frame() const { return frame_; }
  std::size_t size() const { return std::max(poses_.size(), places_.size()); }
  /// `reference` is where places on the earth are projected to, and becomes the UTM zone they lie in if it
  /// says nothing.
  std::vector<core::RecordedPose> poses(core::GeoReference& reference) const;
  bool geographic() const { return !places_.empty(); }
  const std::vector<core::GeoPoint>& places() const { return places_; }

 private:
  void note_frame(const std::string& frame);

  std::vector<core::RecordedPose> poses_;
  std::vector<core::GeoPoint> places_;
  std::vector<double> stamps_;  ///< of the places
  std::string frame_;
  bool has_frame_ = false;
  std::size_t without_fix_ = 0;
};

/// All poses of a topic, in the order of their stamps. `progress` gets the share that is done.
void read_poses(const std::string& path, const std::string& topic, PoseCollector& poses,
                const std::function<void(double)>& progress);

}  // namespace relative_map
