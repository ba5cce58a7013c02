#include "registration.hpp"

#include <time.h>

#include <iostream>

#include "relative_map/geometry/statistics.hpp"
#include "relative_map/io/point_cloud_file.hpp"
#include "relative_map/localization/clouds/cloud_filters.hpp"
#include "relative_map/localization/ndt/ndt_belief.hpp"

namespace relative_map {

namespace {

constexpr double kTargetLeafShare = 0.2;  // a map keeps more of its points than a scan

/// Median of the times [ms] of `repeat` calls.
template <class Call>
double median_ms(int repeat, const Call& call) {
  std::vector<double> times;
  for (int i = 0; i < repeat; ++i) {
    const double begin = cpu_ms();
    call();
    times.push_back(cpu_ms() - begin);
  }
  return core::median(std::move(times));
}

Registration register_by_ndt(const core::PointCloud& target, const core::PointCloud& source,
                             const RegistrationRequest& request) {
  Registration result;
  core::PointCloud few_target, few_source;
  result.prepare_ms = median_ms(1, [&] {
    const core::PointCloud all =
        request.farthest > 0.0 ? core::crop(target, request.nearest, request.farthest) : target;
    few_target = core::voxel_filter(all, kTargetLeafShare * request.leaf);
    const double farthest = request.farthest > 0.0 ? request.farthest : 100.0;
    few_source = core::voxel_filter(core::crop(source, request.nearest, farthest), request.leaf);
  });
  core::NdtMapPair maps;
  result.map_ms = median_ms(1, [&] { maps = core::make_ndt_maps(few_target.points, request.resolution); });
  core::NdtAlignment found;
  result.ms = median_ms(request.repeat, [&] {
    found = core::align(maps, few_source.points, request.guess, core::NdtMatchParam());
  });
  core::NdtBeliefParam belief;
  belief.max_correction = request.max_correction;
  core::NdtExpectation expected;
  expected.guess = request.guess;
  const core::NdtVerdict verdict = core::judge(maps, few_source.points, found, expected, belief);
  result.target_from_source = found.target_from_source;
  result.covariance = verdict.uncertainty.covariance;
  result.condition = verdict.uncertainty.condition;
  result.score = few_source.empty() ? 0.0 : found.at_end.score / static_cast<double>(few_source.size());
  result.likelihood = verdict.likelihood;
  result.upright_likelihood = verdict.upright_likelihood;
  result.overlap = verdict.overlap;
  result.iterations = found.iterations;
  result.converged = found.converged;
  result.believed = verdict.believed;
  result.reasons = verdict.reasons;
  result.remarks = verdict.remarks;
  result.target_points = few_target.size();
  result.source_points = few_source.size();
  return result;
}

Registration register_by_pyramid(const core::PointCloud& target, const core::PointCloud& source,
                                 const RegistrationRequest& request) {
  Registration result;
  core::PointCloud all, scan;
  result.prepare_ms = median_ms(1, [&] {
    all = request.farthest > 0.0 ? core::crop(target, request.nearest, request.farthest) : target;
    scan = core::crop(source, request.nearest, request.farthest > 0.0 ? request.farthest : 100.0);
  });
  const Eigen::Vector2d origin = all.empty() ? Eigen::Vector2d::Zero().eval()
                                             : all.points.front().head<2>().array().floor().matrix().eval();
  core::PyramidMap map(request.resolution, origin);
  result.map_ms = median_ms(1, [&] {
    map.add(all);
    map.finish();
  });
  core::PyramidParam param;
  param.weighing = request.weighing;
  core::PyramidMatch found;
  result.ms =
      median_ms(request.repeat, [&] { found = core::match_pyramid(map, scan, request.guess, param); });
  result.target_from_source = found.map_from_body;
  result.covariance = found.covariance;
  result.score = result.likelihood = found.score;
  result.overlap = found.coverage;
  result.iterations = found.candidates;
  result.reasons = found.reasons;
  result.remarks = found.remarks;
  result.converged = found.candidates > 0;
  const double correction = (found.map_from_body.translation() - request.guess.translation()).norm();
  if (correction > request.max_correction) result.reasons.push_back("the result is too far from the guess");
  result.believed = result.reasons.empty();
  result.target_points = all.size();
  result.source_points = scan.size();
  return result;
}

}  // namespace

double cpu_ms() {
  timespec now = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

core::PointCloud read_cloud(const std::string& path) {
  core::CloudFile file = core::read_point_cloud(path);
  if (file.dropped > 0) {
    std::cerr << path << ": " << file.dropped << " points that are not finite were left out\n";
  }
  return std::move(file.cloud);
}

Eigen::Isometry3d pose_of(const std::vector<double>& numbers) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  pose.linear() = (Eigen::AngleAxisd(numbers[5], Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(numbers[4], Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(numbers[3], Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

Registration register_clouds(const core::PointCloud& target, const core::PointCloud& source,
                             const RegistrationRequest& request) {
  return request.pyramid ? register_by_pyramid(target, source, request)
                         : register_by_ndt(target, source, request);
}

}  // namespace relative_map
