#pragma once

#include <relative_map/MapMsg.h>
#include <visualization_msgs/Marker.h>

#include <vector>

namespace relative_map {

/// Boundaries in the style and colour of their paint, each stretch of it a marker. Paint has a dark rim,
/// which makes white seen on white; the rims of all paint of one width are one marker.
class BoundaryMarkers {
 public:
  /// Dotted lines are laid out from the end of the lane's line, `remaining_distance` [m] from the vehicle, so
  /// that they stand still while the vehicle drives by.
  void add(const MapMsg& map, const LaneBoundary& boundary, double remaining_distance);

  const std::vector<visualization_msgs::Marker>& markers() const { return markers_; }
  const std::vector<visualization_msgs::Marker>& rims() const { return rims_; }

 private:
  void add_rim(const MapMsg& map, const visualization_msgs::Marker& paint);

  std::vector<visualization_msgs::Marker> markers_, rims_;
};

}  // namespace relative_map
