#include "relative_map/pipeline/estimation/estimator.hpp"

#include <algorithm>

#include "relative_map/pipeline/lines/current_lane.hpp"

namespace relative_map::core {

LaneEstimate Estimator::update(const std::vector<ImageQueue::Image>& images, const TrackedLines& lines,
                               const Tick& tick) {
  const TrackedLine& current = lines.current_line();
  const PipelineConfig& config = tick.config;
  lane_.expect_half_width(expected_half_width(lines.lines, current, config.navigation_lane,
                                              config.map_param.default_half_width()));
  std::vector<double> others;  // how far to the left of the current line
  for (const TrackedLine& line : lines.lines) {
    if (line.line != current.line) others.push_back(current.projection.l - line.projection.l);
  }
  lane_.follow_line(*current.line, current.projection, others);
  LaneEstimate estimate;
  for (const ImageQueue::Image& image : images) {  // remarks on the newest one
    estimate.remarks = lane_.see(image.sides, *current.line, current.projection, image.stamp);
  }
  if (!lane_.given_up().empty()) estimate.remarks.push_back(lane_.given_up());

  estimate.vehicle = tick.at_map_time(lane_.corrected(tick.localized));
  estimate.fusion = lane_.state(current.projection, estimate.vehicle.map_from_base.heading());
  estimate.fusion.source = Source::kNavigationLine;
  const auto last_paint = lane_.last_paint();
  if (last_paint && to_seconds(tick.now - *last_paint) <= config.max_age.lane_markers) {
    estimate.fusion.source = Source::kFused;
    estimate.fusion.marker_range = lane_.paint_range();
    estimate.fusion.marker_age = std::max(0.0, to_seconds(estimate.vehicle.stamp - *last_paint));
    estimate.paint = {
        lane_.left_paint(), lane_.right_paint(), lane_.next_left_paint(), lane_.next_right_paint(), 0.0,
        lane_.paint_range()};
  }
  return estimate;
}

}  // namespace relative_map::core
