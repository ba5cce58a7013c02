#pragma once

namespace relative_map::core {

/// How an alignment is driven. Angles in rad.
struct NdtMatchParam {
  int iterations = 30;            ///< at most, on the finest voxels
  double translation_end = 0.01;  ///< [m] converged below this step
  double rotation_end = 8.7e-4;   ///< [rad] (0.05 deg) and below this one
  double far_step = 1.0;          ///< [m] longest step while steps keep their direction
  double near_step = 0.1;         ///< [m] and once one has turned back
  int oscillations = 10;          ///< more steps that turn back are a failure
  bool coarse_start = true;       ///< begin on voxels of twice the size: a wider basin
  double coarse_points = 2500.0;  ///< [-] of the source that take part in that
};

/// When a result is believed. All of it must hold.
struct NdtBeliefParam {
  double min_likelihood = 0.2;  ///< [-] best voxel's score a point, over the largest possible; voxels of 1 m
  double upright_share = 0.75;  ///< [-] of that which those points need that are not on the ground
  double min_place_share = 0.75;  ///< [-] and of what is usual at this place, where that is known
  double min_overlap = 0.6;       ///< [-] share of points in or beside a voxel
  double min_points = 100.0;      ///< [-] in voxels
  double max_correction = 3.0;    ///< [m] from the guess to the result
  double max_turn = 0.35;         ///< [rad] (20 deg) likewise
  double max_innovation = 22.5;   ///< [-] squared, of 6: chi-square at 1e-3, where the guess has a covariance
  double weak_share = 0.02;       ///< [-] a direction with less of the largest information is weak
  double weak_stddev = 10.0;      ///< [m] what is said of a weak direction
  double min_translation_stddev = 0.05;  ///< [m] a result is never said to be better
  double min_rotation_stddev = 0.005;    ///< [rad] (0.3 deg) likewise
};

}  // namespace relative_map::core
