#include "relative_map/simulation/paint.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "relative_map/simulation/smooth_step.hpp"

namespace relative_map::core {

namespace {

constexpr double kSpacing = 1.0;  // [m]

bool follows(const Cubic& cubic, const Polyline& points, double max_residual) {
  return std::all_of(points.begin(), points.end(), [&](const Point2& point) {
    return std::abs(cubic.value(point.x()) - point.y()) <= max_residual;
  });
}

}  // namespace

double PaintLine::l_at(double s) const {
  const double outside = std::max({0.0, from_s - s, s - to_s});
  const double in_place = l + wave_at(s);
  if (shift == 0.0 || outside >= ramp) return in_place;
  const double t = 1.0 - outside / ramp;
  return in_place + shift * smooth_step(t).value;
}

double PaintLine::wave_at(double s) const {
  if (wave == 0.0) return 0.0;
  return wave * std::sin(2.0 * kPi * s / wave_length + wave_phase);
}

Polyline visible_paint(const DrivePath& path, double s, std::size_t vertex, const PaintLine& line,
                       const Pose2& base, const Sight& sight) {
  Polyline seen;
  const double min_cosine = std::cos(sight.max_turn);
  for (double ahead = 0.0; path.ends == Ends::kClosed || s + ahead <= path.length(); ahead += kSpacing) {
    const PathPoint point = interpolate(path.points, path.hold(s + ahead), vertex);
    if (point.direction.dot(base.forward()) < min_cosine || std::abs(point.kappa) > sight.max_kappa) break;
    const Point2 paint = base.to_local(point.position + line.l_at(point.s) * left_of(point.direction));
    if (sight.nearest == 0.0 || paint.x() >= sight.nearest) seen.push_back(paint);
    if (paint.x() > sight.range) break;
  }
  return seen;
}

Cubic fit_cubic(const Polyline& points) {
  const double scale = points.back().x();  // x up to 1, so that its powers are of one size
  Eigen::Matrix4d a = a.Zero();
  Eigen::Vector4d b = b.Zero();
  for (const Point2& point : points) {
    const double x = point.x() / scale;
    const Eigen::Vector4d powers(1.0, x, x * x, x * x * x);
    a += powers * powers.transpose();
    b += powers * point.y();
  }
  const Eigen::Vector4d c = a.ldlt().solve(b);
  return {c[0], c[1] / scale, c[2] / (scale * scale), c[3] / (scale * scale * scale)};
}

FittedPaint fit_paint(Polyline points, double max_residual) {
  while (points.size() >= 4) {
    const Cubic cubic = fit_cubic(points);
    if (follows(cubic, points, max_residual)) return {cubic, points.back().x()};
    points.resize(points.size() - 1 - points.size() / 20);  // fine steps: the range should not jump
  }
  return {};
}

}  // namespace relative_map::core
