#include "relative_map/geometry/self_crossings.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <iterator>
#include <utility>

namespace relative_map::core {

namespace bg = boost::geometry;

namespace {

using BoostPoint = bg::model::d2::point_xy<double>;
using Box = bg::model::box<BoostPoint>;
using Entry = std::pair<Box, std::size_t>;  ///< the box around a segment, and which one it is

struct Segment {
  Point2 from, to;
};

Box box_of(const Segment& segment) {
  const Point2 low = segment.from.cwiseMin(segment.to), high = segment.from.cwiseMax(segment.to);
  return Box({low.x(), low.y()}, {high.x(), high.y()});
}

/// Whether the ends of `b` lie on either side of the line through `a`; on it counts as left of it, so that a
/// way through a vertex is one crossing.
bool parts(const Segment& a, const Segment& b) {
  const Point2 along = a.to - a.from;
  return (cross(along, b.from - a.from) < 0.0) != (cross(along, b.to - a.from) < 0.0);
}

}  // namespace

std::vector<SelfCrossing> self_crossings(const Polyline& points, Ends ends) {
  const bool closed = ends == Ends::kClosed;
  std::vector<Segment> segments;
  std::vector<Entry> entries;
  for (std::size_t i = 0; i + (closed ? 0 : 1) < points.size(); ++i) {
    segments.push_back({points[i], points[(i + 1) % points.size()]});
    entries.emplace_back(box_of(segments.back()), i);
  }
  const bg::index::rtree<Entry, bg::index::rstar<16>> tree(entries);

  std::vector<SelfCrossing> crossings;
  std::vector<Entry> near;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    near.clear();
    tree.query(bg::index::intersects(entries[i].first), std::back_inserter(near));
    for (const auto& [box, k] : near) {
      const bool neighbours = k <= i + 1 || (closed && i == 0 && k + 1 == segments.size());
      if (neighbours || !parts(segments[i], segments[k]) || !parts(segments[k], segments[i])) continue;
      crossings.push_back({i, k});
    }
  }
  return crossings;
}

}  // namespace relative_map::core
