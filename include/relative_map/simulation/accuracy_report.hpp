#pragma once

#include <iosfwd>

#include "relative_map/simulation/accuracy_benchmark.hpp"

namespace relative_map::core {

/// A table of aligned rows, with the units in its head: scenes, then totals.
void print_table(const BenchmarkResult& result, std::ostream& out);

/// The same figures as comma-separated values; angles in [rad], shares in [0, 1], and nothing where there is
/// none.
void write_table(const BenchmarkResult& result, std::ostream& out);

/// Every map of a drive, a line each, to be drawn.
void write_maps_header(std::ostream& out);
void write_maps(const AccuracyScene& scene, std::uint64_t seed, const AccuracyMethod& method,
                const std::vector<MeasuredMap>& maps, std::ostream& out);

}  // namespace relative_map::core
