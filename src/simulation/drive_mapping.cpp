#include "relative_map/simulation/drive_mapping.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "relative_map/pipeline/contract/map_check.hpp"
#include "relative_map/pipeline/relative_map_pipeline.hpp"
#include "relative_map/simulation/reference_filter.hpp"

namespace relative_map::core {

namespace {

constexpr Duration kTickPeriod = std::chrono::milliseconds(100);
constexpr Duration kSettleTime = std::chrono::seconds(1);

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// As the node does.
class PipelineMapMaker : public MapMaker {
 public:
  PipelineMapMaker(const NavigationInfo& navigation, const PipelineConfig& config, bool deliver_markers)
      : pipeline_(std::make_shared<PipelineConfig>(config)),
        deliver_markers_(deliver_markers),
        context_(MapContext::of(config)) {
    pipeline_.set_navigation_lines(prepare_navigation_lines(navigation, IntakeParam::of(config)));
  }

  void deliver(const Delivery& delivery) override {
    if (const auto* localization = std::get_if<Localization>(&delivery.message)) {
      pipeline_.set_localization(*localization, std::nullopt, delivery.time);
    } else if (const auto* chassis = std::get_if<Chassis>(&delivery.message)) {
      pipeline_.set_chassis(*chassis, delivery.time);
    } else if (deliver_markers_) {
      pipeline_.set_lane_markers(std::get<LaneMarkers>(delivery.message), delivery.time);
    }
  }

  RelativeMap tick(Time now) override {
    RelativeMap map = pipeline_.tick(now);
    status_ = map.status.message;
    return map;
  }

  std::string remarks() const override {
    std::string text = status_;
    for (const std::string& remark : pipeline_.remarks()) text += (text.empty() ? "" : "; ") + remark;
    return text;
  }

  std::vector<std::string> violations(const RelativeMap& map) override {
    std::vector<std::string> sentences;
    for (const Violation& violation : check_map(map, context_)) {
      sentences.push_back(violation.row + ": " + violation.what);
    }
    context_.previous_sequence_num = map.sequence_num;
    context_.previous_stamp = map.stamp;
    return sentences;
  }

 private:
  RelativeMapPipeline pipeline_;
  bool deliver_markers_;
  MapContext context_;
  std::string status_;
};

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

AccuracyMethod reference_method() {
  AccuracyMethod method;
  method.name = "filter";
  method.is_filter = true;
  return method;
}

std::vector<MeasuredMap> map_drive(const RecordedDrive& drive, MapMaker& maker) {
  std::vector<MeasuredMap> maps;
  AccuracyMeter meter(drive);
  auto delivery = drive.deliveries.begin();
  for (Time now = drive.start; now <= drive.end; now += kTickPeriod) {
    const auto started = std::chrono::steady_clock::now();
    for (; delivery != drive.deliveries.end() && delivery->time <= now; ++delivery) maker.deliver(*delivery);
    const RelativeMap map = maker.tick(now);
    MeasuredMap measured;
    measured.cost = seconds_since(started);
    measured.time = to_seconds(now - drive.start);
    measured.errors = meter.measure(map);
    measured.painted = map.fusion.source == Source::kFused || map.fusion.source == Source::kLaneMarkers;
    measured.claimed = map.fusion.lateral_offset.stddev;
    measured.remarks = maker.remarks();
    const std::vector<std::string> violations = maker.violations(map);
    measured.violations = violations.size();
    if (!violations.empty()) measured.violation = violations.front();
    if (now - drive.start < kSettleTime) measured.errors = MapErrors();
    maps.push_back(measured);
  }
  return maps;
}

std::vector<MeasuredMap> map_drive(const RecordedDrive& drive, const PipelineConfig& config,
                                   bool deliver_markers) {
  PipelineMapMaker maker(drive.navigation, config, deliver_markers);
  return map_drive(drive, maker);
}

std::vector<MeasuredMap> map_drive(const RecordedDrive& drive, const AccuracyMethod& method,
                                   LaneSource lane_source) {
  if (!method.is_filter) return map_drive(drive, method.config(lane_source), method.deliver_markers);
  ReferenceMapMaker maker(drive.navigation);
  return map_drive(drive, maker);
}

}  // namespace relative_map::core
