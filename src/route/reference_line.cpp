#include "relative_map/route/reference_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "relative_map/model/check_range.hpp"
#include "relative_map/route/box_smoother.hpp"

namespace relative_map::core {

namespace {

constexpr double kSamePlace = 0.01;  // [m] along a lane

BoundaryType paint_at(const std::vector<PaintSpan>& paint, double s) {
  BoundaryType type = BoundaryType::kUnknown;
  for (const PaintSpan& span : paint) {
    if (span.s <= s) type = span.type;
  }
  return type;
}

}  // namespace

std::vector<std::string> ReferenceLineParam::validate() const {
  std::vector<std::string> faults;
  check_range("spacing", spacing, 0.2, 5.0, faults);
  check_range("vehicle_width", vehicle_width, 0.1, 5.0, faults);
  check_range("half_width", half_width, 0.5, 10.0, faults);
  check_range("clearance", clearance, 0.0, 2.0, faults);
  check_range("curb_clearance", curb_clearance, 0.0, 2.0, faults);
  check_range("curb_shift", curb_shift, 0.0, 1.0, faults);
  check_range("least_bound", least_bound, 0.0, 2.0, faults);
  check_range("greatest_bound", greatest_bound, least_bound, 3.0, faults);
  check_range("follow", follow, 1.0, 200.0, faults);
  check_range("pinned", pinned, 0.0, 200.0, faults);
  check_range("speed_limit", speed_limit, 0.1, 100.0, faults);
  check_range("lateral_acceleration", lateral_acceleration, 0.1, 20.0, faults);
  return faults;
}

/// The lanes of some segments, one after the other.
class ReferenceLineMaker::Way {
 public:
  struct Place {
    std::size_t lane = 0;
    double s = 0.0;
  };

  Way(const LaneNetwork& network, const RouteSegments& segments) : network_(network) {
    double along = 0.0;
    for (const LaneSegment& segment : segments.segments) {
      const auto lane = network.find(segment.lane_id);
      if (!lane) continue;
      parts_.push_back({along, *lane, segment.start_s});
      along += segment.end_s - segment.start_s;
    }
    length_ = along;
  }

  double length() const { return length_; }
  Place at(double along) const {
    const auto after = std::upper_bound(parts_.begin() + 1, parts_.end(), along,
                                        [](double value, const Part& part) { return value < part.along; });
    const Part& part = *(after - 1);
    return {part.lane, part.start + along - part.along};
  }
  Point2 point_at(double along) const {
    const Place place = at(std::clamp(along, 0.0, length_));
    return network_.lane(place.lane).line.point_at(place.s);
  }
  /// Across the way, over `reach` [m] of it to either side: at a kink it halves the angle.
  Point2 left_at(double along, double reach) const {
    const Point2 chord = point_at(along + reach) - point_at(along - reach);
    return left_of(chord.norm() > 1e-6 ? Point2(chord.normalized()) : Point2(Point2::UnitX()));
  }

 private:
  struct Part {
    double along = 0.0;
    std::size_t lane = 0;
    double start = 0.0;
  };

  const LaneNetwork& network_;
  std::vector<Part> parts_;
  double length_ = 0.0;
};

/// What was made before of this way, where the vehicle is and as far as it goes on over the same lanes.
ReferenceLineMaker::Knots ReferenceLineMaker::kept(const Way& way, double vehicle_s) const {
  const Way::Place here = way.at(std::clamp(vehicle_s, 0.0, way.length()));
  for (const Knots& before : last_) {
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (before[i].lane != here.lane || std::abs(before[i].lane_s - here.s) > param_.spacing) continue;
      const double shift =
          std::clamp(vehicle_s, 0.0, way.length()) + before[i].lane_s - here.s - before[i].along;
      const auto same = [&](const Knot& knot) {
        const double along = knot.along + shift;
        if (knot.passing || along < 0.0 || along > way.length()) return false;
        const Way::Place place = way.at(along);
        if (place.lane == knot.lane) return std::abs(place.s - knot.lane_s) < kSamePlace;
        // On the joint it is the end of one lane and the start of the next.
        return (way.point_at(along) - knot.point).norm() < kSamePlace;
      };
      std::size_t first = i, end = i;
      while (end < before.size() && same(before[end])) ++end;
      while (first > 0 && same(before[first - 1])) --first;
      Knots knots(before.begin() + static_cast<std::ptrdiff_t>(first),
                  before.begin() + static_cast<std::ptrdiff_t>(end));
      for (Knot& knot : knots) knot.along += shift;
      if (!knots.empty()) return knots;
    }
  }
  return {};
}

ReferenceLineMaker::Knots ReferenceLineMaker::knots_on(const Way& way, double vehicle_s) const {
  Knots knots = kept(way, vehicle_s);
  const auto knot_at = [&](double along) {
    Knot knot;
    const Way::Place place = way.at(along);
    knot.lane = place.lane;
    knot.lane_s = place.s;
    knot.along = along;
    knot.point = way.point_at(along);
    knot.left = way.left_at(along, param_.spacing);
    return knot;
  };
  for (Knot& knot : knots) knot.pinned = knot.along < vehicle_s + param_.pinned;
  if (knots.empty()) knots.push_back(knot_at(0.0));
  Knots before;
  for (double along = knots.front().along - param_.spacing; along > 0.0; along -= param_.spacing) {
    before.push_back(knot_at(along));
  }
  knots.insert(knots.begin(), before.rbegin(), before.rend());
  for (double along = knots.back().along + param_.spacing; along < way.length(); along += param_.spacing) {
    knots.push_back(knot_at(along));
  }
  // The last piece may be a little longer or shorter than the others, but not much: two points close together
  // would make a bend of nothing.
  if (way.length() - knots.back().along < 0.5 * param_.spacing && knots.size() > 1 && !knots.back().pinned) {
    knots.pop_back();
  }
  if (way.length() - knots.back().along > 0.5 * param_.spacing) {
    knots.push_back(knot_at(way.length()));
    knots.back().passing = true;
  }
  return knots;
}

bool ReferenceLineMaker::smooth(Knots& knots) const {
  std::vector<Anchor> anchors;
  for (const Knot& knot : knots) {
    const LaneNetwork::Lane& lane = network_->lane(knot.lane);
    const double left = lane.left_half_width(knot.lane_s), right = lane.right_half_width(knot.lane_s);
    const double width = (left > 0.0 ? left : param_.half_width) + (right > 0.0 ? right : param_.half_width);
    const bool left_curb = paint_at(lane.source.left_paint, knot.lane_s) == BoundaryType::kCurb;
    const bool right_curb = paint_at(lane.source.right_paint, knot.lane_s) == BoundaryType::kCurb;
    const double curbs = param_.curb_clearance * ((left_curb ? 1 : 0) + (right_curb ? 1 : 0));
    const double bound = std::clamp((width - param_.vehicle_width - curbs) / 2.0 - param_.clearance,
                                    param_.least_bound, param_.greatest_bound);
    const double center = param_.curb_shift * ((right_curb ? 1 : 0) - (left_curb ? 1 : 0));
    Anchor anchor{knot.point, knot.left, center - bound, center + bound, center};
    if (knot.pinned) anchor.lower = anchor.upper = knot.offset;
    anchors.push_back(anchor);
  }
  const double follow = std::pow(param_.spacing / param_.follow, 6);
  const std::vector<double> offsets = smooth_within(anchors, follow);
  if (offsets.size() != knots.size()) return false;
  for (std::size_t i = 0; i < knots.size(); ++i) knots[i].offset = offsets[i];
  return true;
}

ReferenceLine ReferenceLineMaker::line_of(const std::string& id, const Knots& knots,
                                          const Point2& vehicle) const {
  ReferenceLine line;
  line.id = id;
  PathPoints path(knots.size());
  for (std::size_t i = 0; i < knots.size(); ++i)
    path[i].position = knots[i].point + knots[i].offset * knots[i].left;
  compute_arc_length(path);
  compute_geometry(path);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const LaneNetwork::Lane& lane = network_->lane(knots[i].lane);
    ReferencePoint point;
    point.path = path[i];
    point.lane = knots[i].lane;
    point.lane_s = knots[i].lane_s;
    point.l = knots[i].offset;
    point.left_half_width = lane.left_half_width(knots[i].lane_s);
    point.right_half_width = lane.right_half_width(knots[i].lane_s);
    if (point.left_half_width <= 0.0) point.left_half_width = param_.half_width;
    if (point.right_half_width <= 0.0) point.right_half_width = param_.half_width;
    const double limit = lane.source.speed_limit > 0.0 ? lane.source.speed_limit : param_.speed_limit;
    const double bend = std::sqrt(param_.lateral_acceleration / std::max(1e-9, std::abs(path[i].kappa)));
    point.speed_limit = std::min(limit, bend);
    line.points.push_back(point);
    if (i + 1 == knots.size()) break;
    const Foot foot = project_on_segment(path[i].position, path[i + 1].position, vehicle);
    if (foot.squared_distance >= nearest) continue;
    nearest = foot.squared_distance;
    line.s = path[i].s + foot.fraction * (path[i + 1].s - path[i].s);
  }
  return line;
}

std::vector<ReferenceLine> ReferenceLineMaker::make(const std::vector<RouteSegments>& segments,
                                                    const Point2& vehicle) {
  std::vector<ReferenceLine> lines;
  std::vector<Knots> made;
  for (const RouteSegments& passage : segments) {
    ReferenceLine line;
    line.id = passage.id;
    const Way way(*network_, passage);
    if (way.length() > param_.spacing) {
      Knots knots = knots_on(way, passage.s);
      if (knots.size() >= 2 && smooth(knots)) {
        line = line_of(passage.id, knots, vehicle);
        made.push_back(std::move(knots));
      }
    }
    lines.push_back(std::move(line));
  }
  if (!made.empty()) last_ = std::move(made);
  return lines;
}

}  // namespace relative_map::core
