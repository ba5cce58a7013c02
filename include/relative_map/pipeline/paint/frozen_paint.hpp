#pragma once

#include <Eigen/Core>
#include <string>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/inputs.hpp"
#include "relative_map/pipeline/lines/line_walker.hpp"

namespace relative_map::core {

/// Paint that is not to be believed: it has not changed, though the line beside it has. (ImageQueue finds
/// paint that stays although the vehicle has moved.)
class FrozenPaint {
 public:
  /// `unchanged`: the image's numbers are those of the one before. `pose` of the vehicle, whose heading
  /// counts; `vertex` of the line near it. Returns whether the paint is frozen.
  bool look(bool unchanged, const Pose2& pose, const NavigationLine& line, std::size_t vertex);

 private:
  bool frozen_ = false;
  std::string line_id_;
  /// [rad] the line's directions at the vehicle and ahead, when paint last changed
  Eigen::Vector2d line_shape_ = Eigen::Vector2d::Zero();
};

}  // namespace relative_map::core
