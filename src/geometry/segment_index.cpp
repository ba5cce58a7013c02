#include "relative_map/geometry/segment_index.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <limits>
#include <utility>

namespace relative_map::core {

namespace bg = boost::geometry;

namespace {

using BoostPoint = bg::model::d2::point_xy<double>;
using Box = bg::model::box<BoostPoint>;
using Run = std::pair<Box, std::size_t>;  ///< the box around a run of segments, and its first segment

constexpr std::size_t kRunLength = 16;

}  // namespace

struct SegmentIndex::Tree {
  bg::index::rtree<Run, bg::index::rstar<16>> runs;
};

SegmentIndex::SegmentIndex(const PathPoints& points, Ends ends)
    : segments_(ends == Ends::kClosed ? points.size() : points.size() - 1) {
  std::vector<Run> runs;
  runs.reserve(segments_ / kRunLength + 1);
  for (std::size_t first = 0; first < segments_; first += kRunLength) {
    const std::size_t end = std::min(first + kRunLength, segments_);
    Point2 low = points[first].position, high = low;
    for (std::size_t i = first + 1; i <= end; ++i) {
      const Point2& position = points[i % points.size()].position;
      low = low.cwiseMin(position);
      high = high.cwiseMax(position);
    }
    runs.emplace_back(Box({low.x(), low.y()}, {high.x(), high.y()}), first);
  }
  // Packed: faster to build and to query than one by one.
  tree_ = std::make_shared<const Tree>(Tree{{runs.begin(), runs.end()}});
}

Foot SegmentIndex::project(const PathPoints& points, std::size_t segment, const Point2& point) const {
  const std::size_t next = segment + 1 == points.size() ? 0 : segment + 1;
  Foot foot = project_on_segment(points[segment].position, points[next].position, point);
  foot.segment = segment;
  return foot;
}

std::vector<Foot> SegmentIndex::passes(const PathPoints& points, const Point2& point,
                                       double max_distance) const {
  const double reach = max_distance * max_distance;
  const Box around({point.x() - max_distance, point.y() - max_distance},
                   {point.x() + max_distance, point.y() + max_distance});
  std::vector<std::size_t> firsts;
  for (auto run = tree_->runs.qbegin(bg::index::intersects(around)); run != tree_->runs.qend(); ++run) {
    firsts.push_back(run->second);
  }
  std::sort(firsts.begin(), firsts.end());

  std::vector<Foot> near;
  for (const std::size_t first : firsts) {
    for (std::size_t i = first; i < std::min(first + kRunLength, segments_); ++i) {
      const Foot foot = project(points, i, point);
      if (foot.squared_distance <= reach) near.push_back(foot);
    }
  }

  const bool closed = segments_ == points.size();
  const auto along = [&](std::size_t segment) -> Point2 {
    return points[segment + 1 == points.size() ? 0 : segment + 1].position - points[segment].position;
  };
  // Where a path turns back, the ways there and back are two passes, unless their tip is what is near.
  const auto follows = [&](const Foot& a, const Foot& b) {
    const bool adjacent =
        b.segment == a.segment + 1 || (closed && a.segment + 1 == segments_ && b.segment == 0);
    const bool at_tip = a.fraction >= 1.0 || b.fraction <= 0.0;
    return adjacent && (at_tip || along(a.segment).dot(along(b.segment)) >= 0.0);
  };
  std::vector<Foot> minima;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Foot& before = near[i == 0 ? near.size() - 1 : i - 1];
    const Foot& after = near[i + 1 == near.size() ? 0 : i + 1];
    // Of two segments that share the nearest vertex only the first counts: < behind, <= ahead.
    const bool rises_behind = !follows(before, near[i]) || near[i].squared_distance < before.squared_distance;
    const bool rises_ahead = !follows(near[i], after) || near[i].squared_distance <= after.squared_distance;
    if (rises_behind && rises_ahead) minima.push_back(near[i]);
  }
  return minima;
}

Foot SegmentIndex::nearest(const PathPoints& points, const Point2& point) const {
  Foot best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  const BoostPoint query(point.x(), point.y());
  // Runs come by rising distance of their boxes: once a box is farther than the best foot, so is the rest.
  for (auto run = tree_->runs.qbegin(bg::index::nearest(query, static_cast<unsigned>(tree_->runs.size())));
       run != tree_->runs.qend(); ++run) {
    if (bg::comparable_distance(query, run->first) > best.squared_distance) break;
    for (std::size_t i = run->second; i < std::min(run->second + kRunLength, segments_); ++i) {
      const Foot foot = project(points, i, point);
      if (foot.squared_distance < best.squared_distance) best = foot;
    }
  }
  return best;
}

}  // namespace relative_map::core
