#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "relative_map/io/geodetic_projection.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/ros/setup/frames.hpp"
#include "relative_map/tools/line_recorder.hpp"

namespace relative_map {

/// Poses of the base frame, by their stamps.
struct CarriedPoses {
  std::vector<core::RecordedPose> poses;
  std::size_t without_direction = 0;  ///< left out: no orientation that they could be carried by
};

/// Collects poses of any type that a line can be recorded from, and carries them to the vehicle's base frame.
class PoseCollector {
 public:
  static const std::vector<std::string>& types();

  /// `convention` is that of LocalizationEstimate. `transforms` are asked only when poses are.
  PoseCollector(std::string base_frame, OrientationConvention convention, LinkTransforms transforms);

  /// Takes a message's values; a zero stamp reads as `received`. Throws std::runtime_error if it is in
  /// another map frame than those before.
  template <class Message>
  void add(const Message& message, const ros::Time& received);

  std::size_t size() const { return poses_.size() + places_.size(); }
  /// The map frame; empty: not named.
  const std::string& frame() const { return frame_; }
  /// Links other than the base frame that poses are of.
  const std::set<std::string>& links() const { return links_; }
  /// A sentence if a transform is missing that poses are to be carried by; empty: none is.
  std::string missing_transform() const;
  /// `reference` is where places on the earth are projected to, and
  /// becomes the UTM zone they lie in if it says nothing. Throws std::runtime_error, one sentence.
  CarriedPoses poses(core::GeoReference& reference) const;

  // Of NavSatFix:
  bool geographic() const { return !places_.empty(); }
  const std::vector<core::GeoPoint>& places() const { return places_; }
  /// Left out: without a fix, or with a position that is not finite or was never set.
  std::size_t without_fix() const { return without_fix_; }
  /// The receiver's frame if it is another one than the base frame; else empty.
  const std::string& antenna() const { return antenna_; }

 private:
  void note_frame(const std::string& frame);
  void add_pose(const core::Localization& pose, const std::string& frame, const std::string& link);

  struct LinkPose {
    core::Localization pose;
    std::string link;
  };
  std::string base_frame_;
  OrientationConvention convention_;
  LinkTransforms transforms_;
  std::vector<LinkPose> poses_;
  std::vector<core::GeoPoint> places_;
  std::vector<double> stamps_;  ///< [s] of the places
  std::set<std::string> links_;
  std::string frame_, antenna_;
  bool has_frame_ = false;
  std::size_t without_fix_ = 0;
};

/// All poses of a topic. `progress` gets the share that is done. Throws std::runtime_error, one sentence.
void read_poses(const rosbag::Bag& bag, const std::string& path, const std::string& topic,
                PoseCollector& poses, const std::function<void(double)>& progress);

}  // namespace relative_map
