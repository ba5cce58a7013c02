#include "relative_map/simulation/road.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <stdexcept>

namespace relative_map::core {

Point2 RoadShape::Piece::position_after(double distance) const {
  // Ten Gauss points integrate a turn of 1 rad to the last digit, so panels are made of that size. It holds
  // for straights and arcs too: no need for cases, and none for small-angle limits.
  const double turn = std::max(std::abs(kappa), std::abs(kappa + distance * dkappa)) * distance;
  const int panels = 1 + static_cast<int>(turn);
  const double step = distance / panels;
  using Quadrature = boost::math::quadrature::gauss<double, 10>;
  Point2 result = position;
  for (int i = 0; i < panels; ++i) {
    const double middle = (i + 0.5) * step;
    for (std::size_t j = 0; j < Quadrature::abscissa().size(); ++j) {  // those above 0, each with its mirror
      for (const double side : {-0.5, 0.5}) {
        const double turned = turned_after(middle + side * step * Quadrature::abscissa()[j]);
        result += 0.5 * step * Quadrature::weights()[j] * Point2(std::cos(turned), std::sin(turned));
      }
    }
  }
  return result;
}

RoadShape& RoadShape::add_clothoid(double length, double kappa_start, double kappa_end) {
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw std::invalid_argument("the length of a piece of road must be above 0");
  }
  if (!std::isfinite(kappa_start) || !std::isfinite(kappa_end)) {
    throw std::invalid_argument("the curvature of a piece of road must be finite");
  }
  Piece piece{length_, length, Point2::Zero(), 0.0, kappa_start, (kappa_end - kappa_start) / length};
  if (!pieces_.empty()) {
    piece.position = pieces_.back().position_after(pieces_.back().length);
    piece.turned = pieces_.back().turned_after(pieces_.back().length);
  }
  pieces_.push_back(piece);
  length_ += length;
  kappa_end_ = kappa_end;
  return *this;
}

RoadShape& RoadShape::add_clothoid(double length, double kappa_end) {
  return add_clothoid(length, kappa_end_, kappa_end);
}

RoadShape& RoadShape::add_straight(double length) {
  return add_clothoid(length, 0.0, 0.0);
}

RoadShape& RoadShape::add_arc(double length, double kappa) {
  return add_clothoid(length, kappa, kappa);
}

RoadShape& RoadShape::add_arc(double length) {
  return add_arc(length, kappa_end_);
}

const RoadShape::Piece& RoadShape::piece_at(double s) const {
  if (pieces_.empty()) throw std::out_of_range("the road has no pieces");
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), s,
                                      [](double value, const Piece& piece) { return value < piece.s; });
  return after == pieces_.begin() ? pieces_.front() : *(after - 1);
}

PathPoint RoadShape::at(double s, double l) const {
  s = std::clamp(s, 0.0, length_);
  const Piece& piece = piece_at(s);
  const double distance = s - piece.s;
  const double kappa = piece.kappa + distance * piece.dkappa;
  const double stretch = 1.0 - l * kappa;  // of the parallel curve, by the reference curve's s
  if (!(stretch > 0.0)) throw std::out_of_range("the offset lies beyond the centre of the road's curve");
  const double turned = piece.turned_after(distance);
  const Pose2 local(piece.position_after(distance), turned);

  PathPoint point;
  point.position = start_.to_parent(local.to_parent(Point2(0.0, l)));
  point.theta = normalize_angle(start_.heading() + turned);
  point.direction = Point2(std::cos(point.theta), std::sin(point.theta));
  point.kappa = kappa / stretch;
  point.dkappa = piece.dkappa / (stretch * stretch * stretch);
  point.s = s - l * turned;
  return point;
}

RecordedLine RoadShape::lane(double offset, double spacing, const std::string& name) const {
  if (!(spacing > 0.0)) throw std::invalid_argument("the spacing of a lane's points must be above 0");
  const auto steps = static_cast<std::size_t>(std::max(1.0, std::round(length_ / spacing)));
  RecordedLine line;
  line.name = name;
  line.points.reserve(steps + 1);
  for (std::size_t i = 0; i <= steps; ++i) {
    const PathPoint point = at(length_ * static_cast<double>(i) / static_cast<double>(steps), offset);
    LinePoint recorded;
    recorded.x = point.position.x();
    recorded.y = point.position.y();
    recorded.z = std::nan("");
    recorded.theta = point.theta;
    recorded.kappa = point.kappa;
    recorded.dkappa = point.dkappa;
    recorded.s = point.s;
    line.points.push_back(recorded);
  }
  return line;
}

std::vector<RecordedLine> RoadShape::lanes(std::size_t count, double lane_width, double spacing) const {
  std::vector<RecordedLine> lines;
  for (std::size_t i = 0; i < count; ++i) {
    const double offset = lane_width * (0.5 * (static_cast<double>(count) - 1.0) - static_cast<double>(i));
    lines.push_back(lane(offset, spacing, "lane_" + std::to_string(i)));
    lines.back().priority = static_cast<std::uint32_t>(i);
  }
  return lines;
}

RoadShape demo_road(const Pose2& start) {
  RoadShape road(start);
  road.add_straight(120.0);
  road.add_clothoid(60.0, 1.0 / 300.0).add_arc(120.0).add_clothoid(60.0, 0.0).add_straight(60.0);
  road.add_clothoid(40.0, -1.0 / 100.0).add_arc(80.0).add_clothoid(40.0, 0.0).add_straight(50.0);
  road.add_clothoid(30.0, 1.0 / 60.0).add_arc(50.0).add_clothoid(30.0, 0.0).add_straight(60.0);
  road.add_clothoid(50.0, -1.0 / 200.0).add_arc(80.0).add_clothoid(50.0, 0.0).add_straight(100.0);
  return road;
}

RoadShape closed_road(const Pose2& start) {
  const double radius = 60.0, clothoid = 40.0;
  RoadShape road(start);
  for (int half = 0; half < 2; ++half) {  // each turns by pi, so the two are mirror images and meet
    road.add_straight(150.0).add_clothoid(clothoid, 1.0 / radius);
    road.add_arc(kPi * radius - clothoid).add_clothoid(clothoid, 0.0);
  }
  return road;
}

}  // namespace relative_map::core
