#include "scenes.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

#include "relative_map/io/navigation_line_file.hpp"

namespace relative_map::core::benchmarks {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string reference_data() {
  const char* folder = std::getenv("RELATIVE_MAP_REFERENCE_DATA");
  return folder != nullptr ? folder : RELATIVE_MAP_DEFAULT_REFERENCE_DATA;
}

LinePoint position(const Point2& point) {
  return {point.x(), point.y(), kNaN, kNaN, kNaN, kNaN, kNaN};
}

/// Curvature swings by 0.002 1/m every 400 m.
RecordedLine winding_line(double offset, double length, double spacing) {
  RecordedLine line;
  Pose2 pose(Point2(500000.0, 3000000.0), 0.3);
  const auto count = static_cast<std::size_t>(length / spacing) + 1;
  line.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    line.points.push_back(position(pose.to_parent(Point2(0.0, offset))));
    const double turn = 0.002 * std::sin(2.0 * kPi * spacing * static_cast<double>(i) / 400.0) * spacing;
    pose = pose.to_parent(Pose2({spacing, 0.0}, turn));
  }
  return line;
}

}  // namespace

std::optional<Scene> recorded_lines() {
  Scene scene;
  scene.navigation.frame_id = "map";
  try {
    for (const char* name : {"left", "middle", "right"}) {
      scene.navigation.lines.push_back(
          read_navigation_line(reference_data() + "/apollo_multi_lane/" + name + ".smoothed"));
      scene.navigation.lines.back().priority = static_cast<std::uint32_t>(scene.navigation.lines.size() - 1);
    }
  } catch (const std::exception&) {
    return std::nullopt;
  }
  scene.map_from_base = Pose2({691191.9668313662, 3118215.5540518095}, 1.514790824310288);
  return scene;
}

Scene parallel_lines(std::size_t count, double length, double spacing) {
  Scene scene;
  scene.navigation.frame_id = "map";
  for (std::size_t i = 0; i < count; ++i) {
    const double offset = 3.5 * (static_cast<double>(count / 2) - static_cast<double>(i));
    scene.navigation.lines.push_back(winding_line(offset, length, spacing));
    scene.navigation.lines.back().name = "lane_" + std::to_string(i);
    scene.navigation.lines.back().priority = static_cast<std::uint32_t>(i);
  }
  const std::vector<LinePoint>& middle = scene.navigation.lines[count / 2].points;
  const LinePoint &a = middle[middle.size() / 2], &b = middle[middle.size() / 2 + 1];
  scene.map_from_base = Pose2({a.x, a.y}, std::atan2(b.y - a.y, b.x - a.x));
  return scene;
}

Scene scattered_lines(std::size_t count) {
  Scene scene = parallel_lines(5, 600.0, 3.0);
  std::vector<RecordedLine>& lines = scene.navigation.lines;
  for (std::size_t i = lines.size(); i < count; ++i) {
    RecordedLine copy = lines[i % 5];
    for (LinePoint& point : copy.points) point.x += 1000.0 * static_cast<double>(i / 5);
    copy.name = "lane_" + std::to_string(i);
    copy.priority = static_cast<std::uint32_t>(i);
    lines.push_back(std::move(copy));
  }
  return scene;
}

Scene closed_loop(double length, double spacing) {
  Scene scene;
  scene.navigation.frame_id = "map";
  RecordedLine line;
  line.name = "lap";
  const auto count = static_cast<std::size_t>(length / spacing);
  const double radius = length / (2.0 * kPi);
  for (std::size_t i = 0; i <= count; ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(count);
    line.points.push_back(position(radius * Point2(std::cos(angle), std::sin(angle))));
  }
  scene.navigation.lines.push_back(std::move(line));
  scene.map_from_base = Pose2({radius, 0.0}, kPi / 2.0);
  return scene;
}

RelativeMapPipeline pipeline_of(const Scene& scene, const std::string& method) {
  auto config = std::make_shared<PipelineConfig>();
  config->lane_fusion.method = method;
  RelativeMapPipeline pipeline(config);
  pipeline.set_navigation_lines(prepare_navigation_lines(scene.navigation, {}));
  Chassis chassis;
  chassis.stamp = at_seconds(1.0);
  chassis.speed = 10.0;
  pipeline.set_chassis(chassis);
  return pipeline;
}

void see(RelativeMapPipeline& pipeline, Time now) {
  LaneMarkers markers;
  markers.stamp = now;
  markers.left.quality = markers.right.quality = 0.9;
  markers.left.cubic.c0 = 1.8;
  markers.right.cubic.c0 = -1.7;
  markers.left.view_range = markers.right.view_range = 50.0;
  pipeline.set_lane_markers(markers);
}

RelativeMap tick(RelativeMapPipeline& pipeline, const Scene& scene, Time& now) {
  // So small a step that a whole benchmark stays within the inputs' greatest age.
  now += std::chrono::nanoseconds(100);
  Localization localization;
  localization.stamp = now;
  localization.position << scene.map_from_base.position(), 0.0;
  localization.heading = scene.map_from_base.heading();
  localization.map_from_body = Eigen::AngleAxisd(localization.heading, Eigen::Vector3d::UnitZ());
  pipeline.set_localization(localization);
  return pipeline.tick(now);
}

}  // namespace relative_map::core::benchmarks
