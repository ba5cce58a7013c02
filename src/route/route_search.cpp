#include "relative_map/route/route_search.hpp"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <boost/property_map/function_property_map.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "relative_map/model/check_range.hpp"
#include "way.hpp"

#include "relative_map/model/check_range.hpp"

namespace relative_map::core {

namespace {

struct Link {
  double cost = 0.0;
  ChangeLane change = ChangeLane::kForward;
};

using Roads = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, boost::no_property, Link>;
using Vertex = boost::graph_traits<Roads>::vertex_descriptor;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Reached {};  ///< thrown to end a search at its goal

class StopAt : public boost::default_dijkstra_visitor {
 public:
  explicit StopAt(Vertex goal) : goal_(goal) {}
  void examine_vertex(Vertex vertex, const Roads&) const {
    if (vertex == goal_) throw Reached();
  }

 private:
  Vertex goal_;
};

}  // namespace

std::vector<std::string> SearchParam::validate() const {
  std::vector<std::string> faults;
  check_range("base_speed", base_speed, 0.1, 100.0, faults);
  check_range("left_turn", left_turn, 0.0, 1e5, faults);
  check_range("right_turn", right_turn, 0.0, 1e5, faults);
  check_range("u_turn", u_turn, 0.0, 1e5, faults);
  check_range("lane_change", lane_change, 0.0, 1e6, faults);
  check_range("lane_change_length", lane_change_length, 0.1, 1e4, faults);
  check_range("least_change_length", least_change_length, 0.01, 1e4, faults);
  check_range("min_turn_radius", min_turn_radius, 0.0, 100.0, faults);
  return faults;
}

/// A vertex is a piece of a lane. Every lane is one, from its start to its end: these are there for good. A
/// search adds pieces of the lane that it starts on and of those beside it, from where it starts, and
/// likewise of the lane that it ends on; where both are the same, the piece between. A piece of one kind is
/// changed to from pieces of its kind only, so that no change leads back along the road.
class RouteSearch::Graph {
 public:
  Graph(const LaneNetwork& network, const SearchParam& param) : network_(network), param_(param) {
    for (std::size_t lane = 0; lane < network.size(); ++lane)
      add_vertex(lane, 0.0, network.lane(lane).length());
    for (std::size_t lane = 0; lane < network.size(); ++lane) {
      for (const std::size_t next : network.lane(lane).successors) link(lane, next);
      for_each_side(lane, [&](std::size_t other, ChangeLane side) { link_change(lane, other, side); });
    }
  }

  /// The way from one place to another; empty: there is none.
  Way find(std::size_t from, double from_s, std::size_t to, double to_s,
           const std::set<std::size_t>& closed) {
    const double start_share = from_s / network_.lane(from).length();
    const double end_share = to_s / network_.lane(to).length();
    const Vertex start = boost::add_vertex(roads_), goal = boost::add_vertex(roads_);
    pieces_.resize(boost::num_vertices(roads_));
    const auto starts = add_group(from, start_share, 1.0, closed);
    const auto ends = add_group(to, 0.0, end_share, closed);
    std::map<std::size_t, Vertex> between;
    if (starts.count(to) > 0 && end_share >= start_share)
      between = add_group(from, start_share, end_share, closed);
    boost::add_edge(start, starts.at(from), Link{}, roads_);
    boost::add_edge(ends.at(to), goal, Link{}, roads_);
    if (between.count(to) > 0) {
      boost::add_edge(start, between.at(from), Link{}, roads_);
      boost::add_edge(between.at(to), goal, Link{}, roads_);
    }
    // On from where it starts, and to where it ends from before; a lane that ends at the goal may follow one
    // that it has started on.
    for (const auto& [lane, vertex] : starts) {
      for (const std::size_t next : network_.lane(lane).successors) {
        link(vertex, next);
        if (ends.count(next) > 0) link(vertex, ends.at(next));
      }
    }
    std::vector<Vertex> touched;
    for (const auto& [lane, vertex] : ends) {
      for (const std::size_t before : network_.lane(lane).predecessors) {
        if (std::count(network_.lane(before).successors.begin(), network_.lane(before).successors.end(),
                       lane) == 0)
          continue;
        link(before, vertex);
        touched.push_back(before);
      }
    }
    Way way = search(start, goal, closed);
    for (const Vertex vertex : touched) {
      boost::remove_out_edge_if(
          vertex, [&](const auto& edge) { return boost::target(edge, roads_) >= network_.size(); }, roads_);
    }
    while (boost::num_vertices(roads_) > network_.size()) {
      const Vertex last = boost::num_vertices(roads_) - 1;
      boost::clear_out_edges(last, roads_);
      roads_.m_vertices.pop_back();  // nothing leads to it any more: remove_vertex would look at every edge
    }
    pieces_.resize(network_.size());
    return way;
  }

 private:
  template <class Visit>
  void for_each_side(std::size_t lane, Visit visit) const {
    for (const std::size_t other : network_.lane(lane).left) visit(other, ChangeLane::kLeft);
    for (const std::size_t other : network_.lane(lane).right) visit(other, ChangeLane::kRight);
  }

  Vertex add_vertex(std::size_t lane, double start, double end) {
    const Vertex vertex = boost::add_vertex(roads_);
    pieces_.resize(vertex + 1);
    pieces_[vertex] = {lane, start, end};
    return vertex;
  }

  /// The same share of a lane and of all that can be changed to from it.
  std::map<std::size_t, Vertex> add_group(std::size_t lane, double from, double to,
                                          const std::set<std::size_t>& closed) {
    std::map<std::size_t, Vertex> group;
    std::vector<std::size_t> open = {lane};
    while (!open.empty()) {
      const std::size_t next = open.back();
      open.pop_back();
      if (group.count(next) > 0 || (closed.count(next) > 0 && next != lane)) continue;
      const double length = network_.lane(next).length();
      group[next] = add_vertex(next, from * length, to * length);
      // Both ways: what can be changed from to the goal counts as much as what can be changed to.
      for_each_side(next, [&](std::size_t other, ChangeLane) { open.push_back(other); });
    }
    for (const auto& [own, vertex] : group) {
      for_each_side(own, [&, from_vertex = vertex](std::size_t other, ChangeLane side) {
        if (group.count(other) > 0) link_change(from_vertex, group.at(other), side);
      });
    }
    return group;
  }

  /// What it costs to drive on a piece.
  double cost_of(Vertex vertex) const {
    const LanePiece& piece = pieces_[vertex];
    const GraphLane& lane = network_.lane(piece.lane).source;
    const bool fast = lane.speed_limit >= param_.base_speed;
    double cost = (piece.end - piece.start) * (fast ? std::sqrt(param_.base_speed / lane.speed_limit) : 1.0);
    if (lane.turn == LaneTurn::kLeftTurn) cost += param_.left_turn;
    if (lane.turn == LaneTurn::kRightTurn) cost += param_.right_turn;
    if (lane.turn == LaneTurn::kUTurn) cost += param_.u_turn;
    return cost;
  }

  bool too_narrow(std::size_t lane) const {
    const PathPoints& points = network_.lane(lane).line.points();
    return network_.lane(lane).source.turn == LaneTurn::kUTurn &&
           (points.back().position - points.front().position).norm() / 2.0 < param_.min_turn_radius;
  }

  void link(Vertex from, Vertex to) {
    if (!too_narrow(pieces_[to].lane))
      boost::add_edge(from, to, Link{cost_of(to), ChangeLane::kForward}, roads_);
  }

  void link_change(Vertex from, Vertex to, ChangeLane side) {
    const LanePiece &here = pieces_[from], &there = pieces_[to];
    const double length = std::min(here.end - here.start, there.end - there.start);
    if (length < param_.least_change_length || !may_change(network_, here.lane, there.lane, side)) return;
    const double share = std::min(1.0, length / param_.lane_change_length);
    // Half of either lane is driven. Not less than nothing, which the algorithm could not bear.
    const double cost = param_.lane_change * std::pow(share, -1.5) + (cost_of(to) - cost_of(from)) / 2.0;
    boost::add_edge(from, to, Link{std::max(0.0, cost), side}, roads_);
  }

  Way search(Vertex start, Vertex goal, const std::set<std::size_t>& closed) {
    const std::size_t count = boost::num_vertices(roads_);
    std::vector<Vertex> before(count);
    for (Vertex vertex = 0; vertex < count; ++vertex) before[vertex] = vertex;
    std::vector<double> distance(count, kInfinity);
    const auto weights = boost::make_function_property_map<boost::graph_traits<Roads>::edge_descriptor>(
        [&](const boost::graph_traits<Roads>::edge_descriptor& edge) {
          const Vertex target = boost::target(edge, roads_);
          const bool shut = target < network_.size() && closed.count(pieces_[target].lane) > 0;
          return shut ? kInfinity : roads_[edge].cost;
        });
    bool reached = false;
    try {
      boost::dijkstra_shortest_paths(roads_, start,
                                     boost::predecessor_map(before.data())
                                         .distance_map(distance.data())
                                         .weight_map(weights)
                                         .distance_inf(kInfinity)
                                         .visitor(StopAt(goal)));
    } catch (const Reached&) {
      reached = true;
    }
    Way way;
    if (!reached || !std::isfinite(distance[goal])) return way;
    ChangeLane leave = ChangeLane::kForward;
    for (Vertex vertex = before[goal]; vertex != start; vertex = before[vertex]) {
      way.push_back({pieces_[vertex], leave});
      leave = roads_[boost::edge(before[vertex], vertex, roads_).first].change;
    }
    std::reverse(way.begin(), way.end());
    return way;
  }

  const LaneNetwork& network_;
  SearchParam param_;
  Roads roads_;
  std::vector<LanePiece> pieces_;  ///< of each vertex
};

RouteSearch::RouteSearch(std::shared_ptr<const LaneNetwork> network, const SearchParam& param)
    : network_(std::move(network)), graph_(std::make_unique<Graph>(*network_, param)) {}
RouteSearch::~RouteSearch() = default;
RouteSearch::RouteSearch(RouteSearch&&) noexcept = default;
RouteSearch& RouteSearch::operator=(RouteSearch&&) noexcept = default;

std::string RouteSearch::fault_of(const SearchRequest& request) const {
  std::ostringstream text;
  if (request.places.size() < 2) {
    text << "a route needs a start and a destination, " << request.places.size() << " places are named";
    return text.str();
  }
  for (const LanePosition& place : request.places) {
    const auto lane = network_->find(place.lane_id);
    if (!lane) return "lane '" + place.lane_id + "' is not in the lane graph";
    const double length = network_->lane(*lane).length();
    if (!(place.s >= 0.0 && place.s <= length + 0.2)) {
      text << "lane '" << place.lane_id << "' is " << length << " m long: " << place.s << " m is not on it";
      return text.str();
    }
    if (request.closed_lanes.count(place.lane_id) > 0) return "lane '" + place.lane_id + "' is closed";
  }
  return "";
}

SearchResult RouteSearch::find(const SearchRequest& request) {
  SearchResult result;
  result.why_not = fault_of(request);
  if (!result.why_not.empty()) return result;
  std::set<std::size_t> closed;
  for (const std::string& id : request.closed_lanes) {
    if (const auto lane = network_->find(id)) closed.insert(*lane);
  }
  Way way;
  double distance = 0.0;
  for (std::size_t leg = 0; leg + 1 < request.places.size(); ++leg) {
    const LanePosition &from = request.places[leg], &to = request.places[leg + 1];
    const std::size_t from_lane = *network_->find(from.lane_id), to_lane = *network_->find(to.lane_id);
    Way next = graph_->find(from_lane, std::min(from.s, network_->lane(from_lane).length()), to_lane,
                            std::min(to.s, network_->lane(to_lane).length()), closed);
    if (next.empty()) {
      std::ostringstream text;
      text << "no way leads from " << from.s << " m of lane '" << from.lane_id << "' to " << to.s
           << " m of lane '" << to.lane_id << "'";
      result.why_not = text.str();
      return result;
    }
    for (const WayStep& step : next) {
      // A lane that is left for one beside it counts once, as that one.
      if (step.leave == ChangeLane::kForward) distance += step.piece.end - step.piece.start;
    }
    widen(*network_, next);
    join(way, next);
  }
  Route route;
  route.frame_id = network_->frame_id();
  route.map_version = network_->map_version();
  route.roads = roads_of(*network_, way, closed);
  for (const LanePosition& place : request.places) {
    const Point2 position = network_->lane(*network_->find(place.lane_id)).line.point_at(place.s);
    route.waypoints.push_back({place.lane_id, place.s, position});
  }
  route.distance = distance;
  result.route = std::move(route);
  return result;
}

}  // namespace relative_map::core
