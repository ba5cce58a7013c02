#include "relative_map/simulation/accuracy_benchmark.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "relative_map/simulation/world.hpp"

namespace relative_map::core {

namespace {

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
  for (const std::string& world : options.worlds) {
    makers.emplace_back([world](std::uint64_t seed) { return make_world_scene(world, seed); });
    if (!options.markers_alone) continue;
    makers.emplace_back([world](std::uint64_t seed) { return make_world_scene(world, seed, true); });
  }
  if (options.scenes.empty() && !makers.empty()) return makers;
  for (const std::string& name : selected(
           accuracy_scene_names(), options.scenes, [](const std::string& n) { return n; }, "scene")) {
    makers.emplace_back(
        [&options, name](std::uint64_t seed) { return make_accuracy_scene(name, seed, options.level); });
  }
  return makers;
}

}  // namespace

BenchmarkResult run_benchmark(const BenchmarkOptions& options, const DriveObserver& observer) {
  std::vector<AccuracyMethod> known = accuracy_methods();
  if (!options.methods.empty()) known.push_back(reference_method());  // on demand only
  const auto methods = selected(
      known, options.methods, [](const AccuracyMethod& method) { return method.name; }, "method");

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
        const auto maps = map_drive(drive, methods[i], scene.lane_source);
        result.mapping_time += seconds_since(started);
        result.mapped += scene.duration;
        rows[i].scene = scene.name;
        rows[i].method = methods[i].name;
        rows[i].group = scene.group;
        rows[i].add(maps);
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
