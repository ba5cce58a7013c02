#include "relative_map/simulation/accuracy_benchmark.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

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

/// Those of `all` that were asked for.
template <class Item, class NameOf>
std::vector<Item> selected(const std::vector<Item>& all, const std::vector<std::string>& names,
                           NameOf name_of, const std::string& kind) {
  if (names.empty()) return all;
  std::vector<Item> found;
  for (const std::string& name : names) {
    const auto item = std::find_if(all.begin(), all.end(),
                                   [&](const Item& candidate) { return name_of(candidate) == name; });
    if (item == all.end()) throw std::invalid_argument("there is no " + kind + " '" + name + "'");
    found.push_back(*item);
  }
  return found;
}

const char* group_name(SceneGroup group) {
  switch (group) {
    case SceneGroup::kWithLine:
      return "= with a line";
    case SceneGroup::kDrifting:
      return "= drifting";
    case SceneGroup::kBadMarkers:
      return "= bad markers";
    case SceneGroup::kMarkersAlone:
      return "= markers alone";
    default:
      return "= perfect";
  }
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
  IntakeParam intake;
  intake.stitch_closed_lines = config.enable_cyclic_rerouting;
  intake.lane_half_width =
      std::max(config.map_param.default_left_width, config.map_param.default_right_width);
  pipeline.set_navigation_lines(prepare_navigation_lines(drive.navigation, intake));

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
    MeasuredMap measured{to_seconds(now - drive.start), meter.measure(map), violations.size(), "", cost};
    if (!violations.empty()) measured.violation = violations.front().row + ": " + violations.front().what;
    if (now - drive.start < kSettleTime) measured.errors = MapErrors();
    maps.push_back(measured);
  }
  return maps;
}

double ErrorStatistics::rms() const {
  double sum = 0.0;
  for (const double error : errors_) sum += error * error;
  return std::sqrt(sum / static_cast<double>(errors_.size()));  // NaN: 0 / 0
}

double ErrorStatistics::percentile(double share) const {
  if (errors_.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sizes;
  for (const double error : errors_) sizes.push_back(std::abs(error));
  const auto nth = sizes.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), nth, sizes.end());
  return *nth;
}

void AccuracyRow::add(const MeasuredMap& map) {
  const MapErrors& errors = map.errors;
  for (std::size_t i = 0; i < center.size(); ++i) center[i].add(errors.center[i]);
  boundary.add(errors.left_boundary);
  boundary.add(errors.right_boundary);
  half_width.add(errors.left_half_width);
  half_width.add(errors.right_half_width);
  heading.add(errors.heading);
  jitter_10.add(errors.jitter_10);
  jitter_30.add(errors.jitter_30);
  cost.add(map.cost);
  if (errors.usable) {
    ++usable_of;
    if (*errors.usable) ++usable;
  }
  violations += map.violations;
  if (violation.empty()) violation = map.violation;
}

void AccuracyRow::add(const AccuracyRow& other) {
  for (std::size_t i = 0; i < center.size(); ++i) center[i].add(other.center[i]);
  boundary.add(other.boundary);
  half_width.add(other.half_width);
  heading.add(other.heading);
  jitter_10.add(other.jitter_10);
  jitter_30.add(other.jitter_30);
  cost.add(other.cost);
  usable += other.usable;
  usable_of += other.usable_of;
  violations += other.violations;
  if (violation.empty()) violation = other.violation;
}

namespace {

void add_to_totals(const AccuracyRow& row, std::vector<AccuracyRow>& totals) {
  auto total = std::find_if(totals.begin(), totals.end(), [&](const AccuracyRow& candidate) {
    return candidate.group == row.group && candidate.method == row.method;
  });
  if (total == totals.end()) {
    totals.emplace_back();
    total = totals.end() - 1;
    total->scene = group_name(row.group);
    total->method = row.method;
    total->group = row.group;
  }
  total->add(row);
}

/// Makes the scene of one seed.
using SceneMaker = std::function<AccuracyScene(std::uint64_t seed)>;

std::vector<SceneMaker> scene_makers(const BenchmarkOptions& options) {
  std::vector<SceneMaker> makers;
  for (const RecordedLine& line : options.lines) {
    makers.emplace_back([&](std::uint64_t seed) { return make_line_scene(line, seed, options.level); });
  }
  if (options.scenes.empty() && !options.lines.empty()) return makers;
  for (const std::string& name : selected(
           accuracy_scene_names(), options.scenes, [](const std::string& n) { return n; }, "scene")) {
    makers.emplace_back(
        [&options, name](std::uint64_t seed) { return make_accuracy_scene(name, seed, options.level); });
  }
  return makers;
}

}  // namespace

BenchmarkResult run_benchmark(const BenchmarkOptions& options, const DriveObserver& observer) {
  const auto methods = selected(
      accuracy_methods(), options.methods, [](const AccuracyMethod& method) { return method.name; },
      "method");

  BenchmarkResult result;
  for (const SceneMaker& make : scene_makers(options)) {
    std::vector<AccuracyRow> rows(methods.size());
    for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
      auto started = std::chrono::steady_clock::now();
      const AccuracyScene scene = make(seed);
      const RecordedDrive drive = record_drive(scene);
      result.driven += scene.duration;
      result.simulation_time += seconds_since(started);
      for (std::size_t i = 0; i < methods.size(); ++i) {
        if (scene.lines.empty() && !methods[i].deliver_markers) continue;
        started = std::chrono::steady_clock::now();
        const auto maps = map_drive(drive, methods[i].config(scene.lane_source), methods[i].deliver_markers);
        result.mapping_time += seconds_since(started);
        result.mapped += scene.duration;
        rows[i].scene = scene.name;
        rows[i].method = methods[i].name;
        rows[i].group = scene.group;
        for (const MeasuredMap& map : maps) rows[i].add(map);
        if (observer) observer(scene, seed, methods[i], maps);
      }
    }
    for (AccuracyRow& row : rows) {
      if (row.cost.empty()) continue;
      add_to_totals(row, result.totals);
      result.rows.push_back(std::move(row));
    }
  }
  std::stable_sort(result.totals.begin(), result.totals.end(),
                   [](const AccuracyRow& a, const AccuracyRow& b) { return a.group < b.group; });
  return result;
}

}  // namespace relative_map::core
