#include "relative_map/simulation/drive_mapping.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "relative_map/pipeline/contract/map_check.hpp"
#include "relative_map/pipeline/relative_map_pipeline.hpp"

namespace relative_map::core {

namespace {

constexpr Time kTickPeriod = std::chrono::milliseconds(100);
constexpr Time kSettleTime = std::chrono::seconds(1);

void deliver(const Delivery& delivery, bool with_markers, RelativeMapPipeline& pipeline) {
  if (const auto* localization = std::get_if<Localization>(&delivery.message)) {
    pipeline.set_localization(*localization);
  } else if (const auto* chassis = std::get_if<Chassis>(&delivery.message)) {
    pipeline.set_chassis(*chassis);
  } else if (with_markers) {
    pipeline.set_lane_markers(std::get<LaneMarkers>(delivery.message));
  }
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string remarks_of(const RelativeMap& map, const RelativeMapPipeline& pipeline) {
  std::string text = map.status.message;
  for (const std::string& remark : pipeline.remarks()) text += (text.empty() ? "" : "; ") + remark;
  return text;
}

}  // namespace

PipelineConfig AccuracyMethod::config(LaneSource lane_source) const {
  PipelineConfig config;
  config.lane_fusion.method = fusion;
  config.navigation_lane.lane_source = lane_source;
  return config;
}

std::vector<AccuracyMethod> accuracy_methods() {
  std::vector<AccuracyMethod> known;
  for (const AccuracyMethod& method :
       {AccuracyMethod{"fixed_weight", "fixed_weight", true}, AccuracyMethod{"line", "fixed_weight", false},
        AccuracyMethod{"estimator", "estimator", true}}) {
    if (method.config(LaneSource::kOfflineGenerated).validate().empty()) known.push_back(method);
  }
  return known;
}

std::vector<MeasuredMap> map_drive(const RecordedDrive& drive, const PipelineConfig& config,
                                   bool deliver_markers) {
  RelativeMapPipeline pipeline(std::make_shared<PipelineConfig>(config));
  pipeline.set_navigation_lines(prepare_navigation_lines(drive.navigation, IntakeParam::of(config)));

  std::vector<MeasuredMap> maps;
  AccuracyMeter meter(drive);
  MapContext context{config.base_frame, std::nullopt};
  auto delivery = drive.deliveries.begin();
  for (Time now = drive.start; now <= drive.end; now += kTickPeriod) {
    const auto started = std::chrono::steady_clock::now();
    for (; delivery != drive.deliveries.end() && delivery->time <= now; ++delivery) {
      deliver(*delivery, deliver_markers, pipeline);
    }
    const RelativeMap map = pipeline.tick(now);
    const double cost = seconds_since(started);
    const std::vector<Violation> violations = check_map(map, context);
    context.previous_sequence_num = map.sequence_num;
    MeasuredMap measured;
    measured.time = to_seconds(now - drive.start);
    measured.errors = meter.measure(map);
    measured.violations = violations.size();
    measured.cost = cost;
    measured.painted = map.fusion.source == Source::kFused || map.fusion.source == Source::kLaneMarkers;
    measured.claimed = map.fusion.lateral_offset.stddev;
    measured.remarks = remarks_of(map, pipeline);
    if (!violations.empty()) measured.violation = violations.front().row + ": " + violations.front().what;
    if (now - drive.start < kSettleTime) measured.errors = MapErrors();
    maps.push_back(measured);
  }
  return maps;
}

}  // namespace relative_map::core
