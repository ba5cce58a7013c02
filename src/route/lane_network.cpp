#include "relative_map/route/lane_network.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <iterator>
#include <sstream>
#include <utility>

namespace relative_map::core {

namespace bg = boost::geometry;

namespace {

using BoostPoint = bg::model::d2::point_xy<double>;
using Box = bg::model::box<BoostPoint>;
using Run = std::pair<Box, std::size_t>;  ///< the box around a run of chords, and their lane

constexpr std::size_t kRunLength = 16;
constexpr double kSamePoint = 1e-7;  // [m]
constexpr double kMeet = 1.0;        // [m] that a lane's end may be from its successor's start

bool finite(const std::vector<WidthSample>& samples) {
  return std::all_of(samples.begin(), samples.end(), [](const WidthSample& sample) {
    return std::isfinite(sample.s) && std::isfinite(sample.width);
  });
}

bool finite(const std::vector<PaintSpan>& spans) {
  return std::all_of(spans.begin(), spans.end(), [](const PaintSpan& span) { return std::isfinite(span.s); });
}

/// The fault for which a lane can't be used; empty: none.
std::string fault_of(const GraphLane& lane) {
  if (lane.id.empty()) return "a lane has no id";
  const std::string name = "lane '" + lane.id + "' ";
  for (const Point2& point : lane.centerline) {
    if (!point.allFinite()) return name + "has a point that is not finite";
  }
  if (!finite(lane.left_width) || !finite(lane.right_width)) return name + "has a width that is not finite";
  if (!finite(lane.left_paint) || !finite(lane.right_paint)) return name + "has paint at no finite s";
  if (!std::isfinite(lane.speed_limit) || lane.speed_limit < 0.0)
    return name + "has no speed limit that could be one";
  const bool goes_on = std::any_of(lane.centerline.begin(), lane.centerline.end(), [&](const Point2& point) {
    return (point - lane.centerline.front()).norm() >= kSamePoint;
  });
  if (!goes_on) return name + "has fewer than two points apart";
  return "";
}

double half_width(const std::vector<WidthSample>& samples, double s) {
  if (samples.empty()) return 0.0;
  const auto after =
      std::upper_bound(samples.begin(), samples.end(), s,
                       [](double value, const WidthSample& sample) { return value < sample.s; });
  if (after == samples.begin()) return samples.front().width;
  if (after == samples.end()) return samples.back().width;
  const WidthSample& before = *std::prev(after);
  const double weight = (s - before.s) / (after->s - before.s);
  return before.width + weight * (after->width - before.width);
}

}  // namespace

struct LaneNetwork::Tree {
  bg::index::rtree<Run, bg::index::rstar<16>> runs;
};

double LaneNetwork::Lane::left_half_width(double s) const {
  return half_width(source.left_width, s);
}

double LaneNetwork::Lane::right_half_width(double s) const {
  return half_width(source.right_width, s);
}

std::shared_ptr<const LaneNetwork> LaneNetwork::prepare(LaneGraph graph, std::vector<GraphFault>& faults) {
  auto network = std::make_shared<LaneNetwork>();
  network->frame_id_ = std::move(graph.frame_id);
  network->map_version_ = std::move(graph.map_version);
  bool usable = !graph.lanes.empty();
  if (!usable) faults.push_back({true, "the lane graph has no lane"});
  for (GraphLane& lane : graph.lanes) {
    std::string fault = fault_of(lane);
    if (fault.empty() && !network->by_id_.emplace(lane.id, network->lanes_.size()).second) {
      fault = "two lanes are called '" + lane.id + "'";
    }
    if (!fault.empty()) {
      faults.push_back({true, fault});
      usable = false;
      continue;
    }
    Lane prepared;
    prepared.line = LaneLine(lane.centerline);
    prepared.source = std::move(lane);
    network->lanes_.push_back(std::move(prepared));
  }
  if (!usable) return nullptr;
  network->link(faults);
  network->index();
  return network;
}

void LaneNetwork::link(std::vector<GraphFault>& faults) {
  const auto linked = [&](const std::string& from, const std::vector<std::string>& ids, const char* as) {
    std::vector<std::size_t> places;
    for (const std::string& id : ids) {
      if (const auto place = find(id)) {
        places.push_back(*place);
      } else {
        faults.push_back(
            {false, "lane '" + from + "' has the " + as + " '" + id + "', which is not in the graph"});
      }
    }
    return places;
  };
  for (Lane& lane : lanes_) {
    const GraphLane& source = lane.source;
    lane.successors = linked(source.id, source.successors, "successor");
    lane.predecessors = linked(source.id, source.predecessors, "predecessor");
    lane.left = linked(source.id, source.left_neighbors, "left neighbor");
    lane.right = linked(source.id, source.right_neighbors, "right neighbor");
  }
  // What one lane names holds for the other, too: many maps name a link at one of its ends only.
  const auto complete = [&](std::vector<std::size_t> Lane::*named, std::vector<std::size_t> Lane::*back) {
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      for (const std::size_t other : lanes_[i].*named) {
        std::vector<std::size_t>& links = lanes_[other].*back;
        if (std::find(links.begin(), links.end(), i) == links.end()) links.push_back(i);
      }
    }
  };
  complete(&Lane::successors, &Lane::predecessors);
  complete(&Lane::predecessors, &Lane::successors);
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    Lane& lane = lanes_[i];
    const Point2& end = lane.line.points().back().position;
    for (const std::size_t next : lane.successors) {
      const double gap = (lanes_[next].line.points().front().position - end).norm();
      if (next == i && gap <= kMeet) lane.closed = true;
      if (gap <= kMeet) continue;
      std::ostringstream what;
      what << "lane '" << lane.source.id << "' ends " << gap << " m from where its successor '"
           << lanes_[next].source.id << "' starts";
      faults.push_back({false, what.str()});
    }
  }
}

void LaneNetwork::index() {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    const PathPoints& points = lanes_[i].line.points();
    for (std::size_t first = 0; first + 1 < points.size(); first += kRunLength) {
      Point2 low = points[first].position, high = low;
      for (std::size_t k = first; k <= std::min(first + kRunLength, points.size() - 1); ++k) {
        low = low.cwiseMin(points[k].position);
        high = high.cwiseMax(points[k].position);
      }
      runs.emplace_back(Box({low.x(), low.y()}, {high.x(), high.y()}), i);
    }
  }
  tree_ = std::make_shared<const Tree>(Tree{{runs.begin(), runs.end()}});
}

std::optional<std::size_t> LaneNetwork::find(const std::string& id) const {
  const auto found = by_id_.find(id);
  if (found == by_id_.end()) return std::nullopt;
  return found->second;
}

std::vector<std::size_t> LaneNetwork::lanes_near(const Point2& point, double distance) const {
  const Box around({point.x() - distance, point.y() - distance},
                   {point.x() + distance, point.y() + distance});
  std::vector<std::size_t> lanes;
  for (auto run = tree_->runs.qbegin(bg::index::intersects(around)); run != tree_->runs.qend(); ++run) {
    lanes.push_back(run->second);
  }
  std::sort(lanes.begin(), lanes.end());
  lanes.erase(std::unique(lanes.begin(), lanes.end()), lanes.end());
  return lanes;
}

}  // namespace relative_map::core
