#pragma once

#include <iosfwd>

#include "relative_map/simulation/accuracy_benchmark.hpp"

namespace relative_map::core {

/// How each method does in each world, a line a world.
void print_worlds(const BenchmarkResult& result, std::ostream& out);

/// What a drive's maps say, a line each `period` [s]: errors, what is claimed, and remarks.
void print_drive(const AccuracyScene& scene, std::uint64_t seed, const AccuracyMethod& method,
                 const std::vector<MeasuredMap>& maps, double period, std::ostream& out);

}  // namespace relative_map::core
