#include "smoothing_round.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace relative_map::core {

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Triplet = Eigen::Triplet<double>;

constexpr double kUndecided = 1e-14;  // keeps what nothing else decides
constexpr double kFixed = 1e9;        // weight of what must not move
constexpr std::array<double, 4> kThirdDifference = {-1.0, 3.0, -3.0, 1.0};

/// The neighbours of third difference `i`; closed lines go round.
std::array<int, 4> stencil(int i, int count) {
  return {i % count, (i + 1) % count, (i + 2) % count, (i + 3) % count};
}

int number_of_differences(int count, Ends ends) {
  return ends == Ends::kClosed ? count : count - 3;
}

/// One round: the offsets from a reference, along its normals, that change curvature least.
class Round {
 public:
  Round(const EditableLine& recorded, const Polyline& reference, const RoundParam& param)
      : recorded_(recorded),
        reference_(reference),
        count_(static_cast<int>(reference.size())),
        follow_(param.follow) {
    program_.stiffness = param.stiffness;
    EditableLine shape;
    shape.points = reference;
    shape.ends = recorded.ends;
    for (const PathPoint& point : path_of(shape)) normals_.push_back(left_of(point.direction));
    spacing_ = length_of(shape) / number_of_segments();
    find_rows(param.bound);
    build();
  }

  Polyline run(const std::function<void()>& iterated, double& moved) const {
    const Eigen::VectorXd offsets = solve(program_, iterated);
    if (offsets.size() == 0) return {};
    Polyline result;
    moved = 0.0;
    for (int i = 0; i < count_; ++i) {
      const double offset = is_fixed(i) ? 0.0 : offsets[i];
      moved = std::max(moved, std::abs(offset));
      result.push_back(reference_[i] + offset * normals_[i]);
    }
    return result;
  }

 private:
  bool closed() const { return recorded_.closed(); }
  int number_of_segments() const { return closed() ? count_ : count_ - 1; }
  bool is_fixed(int i) const { return !closed() && (i == 0 || i + 1 == count_); }

  /// Where each recorded point lies beside the reference.
  void find_rows(double bound) {
    Polyline track = reference_;
    const int before = closed() ? std::min(count_ / 4, 40) : 0;  // a lap, with some of its end before it
    if (closed()) {
      track.insert(track.begin(), reference_.end() - before, reference_.end());
      track.insert(track.end(), reference_.begin(), reference_.begin() + std::min(count_ / 4, 40));
    }
    PolylineWalker walker(track, static_cast<std::size_t>(before));
    const auto steps = static_cast<std::size_t>(std::max(
        1.0, std::round(static_cast<double>(count_) / static_cast<double>(recorded_.points.size()))));
    for (const Point2& point : recorded_.points) {
      const Foot foot = walker.next(point, steps);
      if (walker.beyond_end(foot)) continue;
      BandedProgram::Row row;
      row.first = (static_cast<int>(foot.segment) - before + count_) % count_;
      row.second = (row.first + 1) % count_;
      row.fraction = foot.fraction;
      const Point2 along = track[foot.segment + 1] - track[foot.segment];
      const double offset = cross(along.normalized(), point - foot.point);
      row.lower = offset - bound;
      row.upper = offset + bound;
      program_.rows.push_back(row);
    }
  }

  void build() {
    std::vector<Triplet> triplets;
    program_.gradient = Eigen::VectorXd::Zero(count_);
    const auto add = [&](int a, int b, double value) {
      if (!is_fixed(a) && !is_fixed(b) && a >= b) triplets.emplace_back(a, b, value);
    };
    for (int i = 0; i < count_; ++i) triplets.emplace_back(i, i, is_fixed(i) ? 1.0 : kUndecided);
    for (int i = 0; i < number_of_segments(); ++i) {  // the places that rows ask for
      triplets.emplace_back(std::max(i, (i + 1) % count_), std::min(i, (i + 1) % count_), 0.0);
    }
    add_curvature_change(add);
    add_recording(add);
    program_.hessian.resize(count_, count_);
    program_.hessian.setFromTriplets(triplets.begin(), triplets.end());
    for (int i = 0; i < count_; ++i) {
      if (is_fixed(i)) program_.gradient[i] = 0.0;
    }
  }

  /// p''' = dkappa * normal - kappa^2 * tangent: its part along the normal is the change of curvature.
  template <class Add>
  void add_curvature_change(const Add& add) {
    for (int i = 0; i < number_of_differences(count_, recorded_.ends); ++i) {
      const std::array<int, 4> at = stencil(i, count_);
      const Point2 normal = (normals_[at[1]] + normals_[at[2]]).normalized();
      std::array<double, 4> factors{};
      double now = 0.0;
      for (int a = 0; a < 4; ++a) {
        factors[a] = kThirdDifference[a] * normal.dot(normals_[at[a]]);
        // From a near point, or the digits of a long line are lost.
        now += kThirdDifference[a] * normal.dot(reference_[at[a]] - reference_[at[1]]);
      }
      for (int a = 0; a < 4; ++a) {
        program_.gradient[at[a]] -= factors[a] * now;
        for (int b = 0; b < 4; ++b) add(at[a], at[b], factors[a] * factors[b]);
      }
    }
  }

  template <class Add>
  void add_recording(const Add& add) {
    const double share =
        static_cast<double>(count_) / static_cast<double>(std::max<std::size_t>(1, program_.rows.size()));
    const double weight = share * std::pow(spacing_ / follow_, 6);
    for (const BandedProgram::Row& row : program_.rows) {
      const double b = row.fraction, a = 1.0 - b, offset = 0.5 * (row.lower + row.upper);
      add(row.first, row.first, weight * a * a);
      add(row.second, row.second, weight * b * b);
      add(std::max(row.first, row.second), std::min(row.first, row.second), weight * a * b);
      program_.gradient[row.first] += weight * a * offset;
      program_.gradient[row.second] += weight * b * offset;
    }
  }

  const EditableLine& recorded_;
  const Polyline& reference_;
  int count_;
  double follow_;
  double spacing_ = 0.0;
  std::vector<Point2> normals_;
  BandedProgram program_;
};

}  // namespace

Polyline low_pass(const Polyline& points, Ends ends, double length, double spacing) {
  const int count = static_cast<int>(points.size());
  const double stiffness = std::pow(length / spacing, 6);
  std::vector<Triplet> triplets;
  Eigen::MatrixX2d right(count, 2);
  for (int i = 0; i < count; ++i) {
    const bool fixed = ends == Ends::kOpen && (i == 0 || i + 1 == count);
    triplets.emplace_back(i, i, fixed ? kFixed : 1.0);
    right.row(i) = (fixed ? kFixed : 1.0) * points[i].transpose();
  }
  for (int i = 0; i < number_of_differences(count, ends); ++i) {
    const std::array<int, 4> at = stencil(i, count);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        triplets.emplace_back(at[a], at[b], stiffness * kThirdDifference[a] * kThirdDifference[b]);
      }
    }
  }
  Matrix matrix(count, count);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SimplicialLDLT<Matrix> factors(matrix);
  const Eigen::MatrixX2d solution = factors.solve(right);
  Polyline result;
  for (int i = 0; i < count; ++i) result.push_back(solution.row(i).transpose());
  return result;
}

Polyline smoothing_round(const EditableLine& recorded, const Polyline& reference, const RoundParam& param,
                         const std::function<void()>& iterated, double& moved) {
  return Round(recorded, reference, param).run(iterated, moved);
}

}  // namespace relative_map::core
