#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/pipeline/relative_map_pipeline.hpp"

// What is driven on in the benchmarks.
namespace relative_map::core::benchmarks {

/// Lines, and a vehicle on one of them.
struct Scene {
  NavigationInfo navigation;
  Pose2 map_from_base;
};

/// The three recorded lines and the vehicle as it was recorded with them; none where they are not there.
std::optional<Scene> recorded_lines();
/// Side by side, 3.5 m apart, gently winding.
Scene parallel_lines(std::size_t count, double length, double spacing);
/// Five lines side by side, and their copies all over the country, `count` in all.
Scene scattered_lines(std::size_t count);
/// A lap of `length` [m] whose last point is its first.
Scene closed_loop(double length, double spacing);

/// A pipeline that has the scene's lines, and fuses by `method`.
RelativeMapPipeline pipeline_of(const Scene& scene, const std::string& method = "estimator");
/// An image of the lane markers beside the vehicle.
void see(RelativeMapPipeline& pipeline, Time now);
/// Gives the pose of the scene, a little later each time.
RelativeMap tick(RelativeMapPipeline& pipeline, const Scene& scene, Time& now);

}  // namespace relative_map::core::benchmarks
