#pragma once

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "relative_map/route/route_index.hpp"

namespace relative_map::core {

/// [m] that a place may lie past the end of its piece, everywhere: one number, so that what one step accepts
/// the next one does not refuse.
constexpr double kOnPiece = 0.2;

/// Builds an index step by step; a step that finds a fault says so, and the ones after it do not run.
class RouteIndexBuilder {
 public:
  RouteIndexBuilder(std::shared_ptr<const LaneNetwork> network, const Route& route);
  RouteIndex::Result build();

 private:
  /// A piece that was left out for having no length, and where the route stands instead.
  struct LeftOut {
    std::size_t lane;
    double s;
    std::size_t piece;  ///< the one that would have followed it
  };

  bool check_header();
  bool check_segment(const LaneSegment& segment, const std::string& where);
  bool add_passages();
  bool add_passage(std::size_t road, std::size_t passage, std::size_t& segment);
  bool close_hole(std::size_t before, std::size_t after);
  bool connected(std::size_t before, std::size_t after) const;
  void link_roads();
  bool find_waypoints();
  bool find_waypoint(std::size_t number, const RouteWaypoint& waypoint, bool last);
  std::optional<PiecePlace> place_on(std::size_t piece, std::size_t lane, double s) const;
  std::optional<PiecePlace> place_left_out(std::size_t lane, double s) const;
  void measure();
  void measure_passage(const PassageRange& passage);

  template <class... Parts>
  bool refuse(RouteCode code, const Parts&... parts) {
    result_.status = {code, text(parts...)};
    return false;
  }
  template <class... Parts>
  static std::string text(const Parts&... parts) {
    std::ostringstream stream;
    (stream << ... << parts);
    return stream.str();
  }

  const Route& route_;
  std::shared_ptr<RouteIndex> index_;
  std::vector<LeftOut> left_out_;
  RouteIndex::Result result_;
};

}  // namespace relative_map::core
