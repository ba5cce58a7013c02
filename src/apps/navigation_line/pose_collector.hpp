#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "relative_map/io/geodetic_projection.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/ros/setup/frames.hpp"
#include "relative_map/tools/clock_faults.hpp"
#include "relative_map/tools/line_recorder.hpp"

namespace relative_map {

/// Poses of the base frame, by their stamps.
struct CarriedPoses {
  std::vector<core::RecordedPose> poses;
  std::vector<core::ClockStep> clock_steps;  ///< that were taken out of the stamps
  std::size_t without_direction = 0;         ///< left out: no orientation that they could be carried by
};

/// Collects poses of any type that a line can be recorded from, and carries them to the vehicle's base frame.
class PoseCollector {
 public:
  static const std::vector<std::string>& types();

  /// `convention` is that of LocalizationEstimate. `transforms` are asked only when poses are.
  PoseCollector(std::string base_frame, OrientationConvention convention, LinkTransforms transforms);

  /// Takes a message's values; a zero stamp reads as `received`. `publisher` is the node that it comes from,
  /// or empty. Throws std::runtime_error if it is in another map frame than those before.
  template <class Message>
  void add(const Message& message, const ros::Time& received, const std::string& publisher);

  /// Only what this node publishes, or is of this frame, counts from here on; empty: all.
  void listen_to(const std::string& source) { only_ = source; }
  std::size_t of_others() const { return of_others_; }

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
  /// [m] the median of the standard deviations that the receiver states for east and north; NaN: none
  double stated_deviation() const;
  /// The receiver's frame if it is another one than the base frame; else empty.
  const std::string& antenna() const { return antenna_; }

 private:
  /// How a message came in.
  struct Arrival {
    double received = 0.0;       ///< [s]
    std::uint32_t sequence = 0;  ///< by its publisher, where that counts
  };
  /// A source's first and last message [s].
  struct Span {
    double first = 0.0, last = 0.0;
  };

  /// False: of a source that is not listened to.
  bool note_source(const std_msgs::Header& header, const std::string& publisher, const std::string& frame,
                   const ros::Time& received);
  void expect_one_source() const;
  std::vector<core::RecordedPose> in_order_of_sending(const std::vector<core::RecordedPose>& poses,
                                                      const std::vector<Arrival>& arrivals) const;
  void note_frame(const std::string& frame);
  void add_pose(const core::Localization& pose, const std::string& frame, const std::string& link);

  struct LinkPose {
    core::Localization pose;
    std::string link;
    Arrival arrival;
  };
  std::string base_frame_;
  OrientationConvention convention_;
  LinkTransforms transforms_;
  std::vector<LinkPose> poses_;
  std::vector<core::GeoPoint> places_;
  std::vector<core::RecordedPose> fixes_;  ///< of the places: their stamps and standard deviations
  std::vector<Arrival> fix_arrivals_;
  std::map<std::string, Span> sources_;
  std::string only_;
  Arrival arrival_;  ///< of the last message
  std::size_t of_others_ = 0;
  std::set<std::string> links_;
  std::string frame_, antenna_;
  bool has_frame_ = false;
  std::size_t without_fix_ = 0;
};

/// All poses of a topic. `progress` gets the share that is done. Throws std::runtime_error, one sentence.
void read_poses(const rosbag::Bag& bag, const std::string& path, const std::string& topic,
                PoseCollector& poses, const std::function<void(double)>& progress);

}  // namespace relative_map
