#include "relative_map/route/line_graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "relative_map/geometry/angles.hpp"
#include "relative_map/route/lane_projection.hpp"

namespace relative_map::core {

namespace {

constexpr double kStep = 1.0;        // [m] from sample to sample
constexpr double kSliver = 2.0;      // [m] no lane is cut to be shorter
constexpr double kLap = 3.0;         // [m] from a line's end to its start, and it is a lap
constexpr double kPastEnd = 0.5;     // [m] past a line's end one is still beside it
constexpr double kSamePlace = 1e-6;  // [m]

struct Place {
  std::size_t line = 0;
  double s = 0.0;
};

/// What another line owns of a line.
struct Shared {
  double start = 0.0, end = 0.0;  ///< [m] of the line
  Place first, last;              ///< of the owner
};

struct Line {
  std::string name;
  LaneLine line;
  bool closed = false;
  std::vector<double> cuts;  ///< [m] rising, with 0 and the length
  std::vector<Shared> shared;
  double length() const { return line.length(); }
};

struct Piece {
  Place place;
  double end = 0.0;
  GraphLane lane;
};

class Maker {
 public:
  Maker(const std::vector<NamedLine>& lines, const LineGraphParam& param, std::vector<std::string>& notes)
      : param_(param), notes_(notes) {
    for (const NamedLine& line : lines) add(line);
  }

  LaneGraph make() {
    for (std::size_t i = 0; i < lines_.size(); ++i) find_shared(i);
    for (std::size_t i = 0; i < lines_.size(); ++i) link_shared(i);
    // What is cut on one side is cut on the other, and beyond.
    for (std::size_t round = 0; round < lines_.size(); ++round) cut_beside(round == 0);
    for (std::size_t i = 0; i < lines_.size(); ++i) cut_pieces(i);
    link_pieces();
    link_beside();
    LaneGraph graph;
    for (Piece& piece : pieces_) graph.lanes.push_back(std::move(piece.lane));
    return graph;
  }

 private:
  void add(const NamedLine& from) {
    Polyline points;
    for (const Point2& point : from.points) {
      if (points.empty() || (point - points.back()).norm() > 1e-3) points.push_back(point);
    }
    if (points.size() < 2) {
      notes_.push_back("line '" + from.name + "' has fewer than two points apart: it is left out");
      return;
    }
    Line line;
    line.name = from.name;
    for (const Line& other : lines_) {
      if (other.name == from.name) line.name = from.name + "-" + std::to_string(lines_.size());
    }
    line.line = LaneLine(points);
    const double turn = line.line.heading_at(0.0) - line.line.heading_at(line.length());
    line.closed = line.length() > 10.0 * kLap && (points.back() - points.front()).norm() < kLap &&
                  std::abs(normalize_angle(turn)) < param_.heading;
    if (line.closed) {
      if ((points.back() - points.front()).norm() > 1e-3) points.push_back(points.front());
      points.back() = points.front();
      line.line = LaneLine(points);
    }
    line.cuts = {0.0, line.length()};
    lines_.push_back(std::move(line));
  }

  /// Where a point of a line lies along another one, if it is between `least` and `most` from it.
  std::optional<LaneProjection> along(std::size_t line, double s, std::size_t other, double least,
                                      double most) const {
    const LaneLine& from = lines_[line].line;
    const LaneProjection place = lines_[other].line.project(from.point_at(s));
    const bool on = place.s >= -kPastEnd && place.s <= lines_[other].length() + kPastEnd;
    if (!on || place.distance < least || place.distance > most) return std::nullopt;
    if (std::abs(normalize_angle(place.heading - from.heading_at(s))) > param_.heading) return std::nullopt;
    return place;
  }

  /// Samples of a line: where each of them lies on the first of the lines before it that it runs along.
  void find_shared(std::size_t j) {
    Line& line = lines_[j];
    const double length = line.length();
    const auto steps = static_cast<std::size_t>(std::ceil(length / kStep));
    std::optional<Shared> run;
    std::vector<Shared> runs;
    for (std::size_t k = 0; k <= steps; ++k) {
      const double s = std::min(length, static_cast<double>(k) * kStep);
      std::optional<Place> owner;
      for (std::size_t i = 0; i < j && !owner; ++i) {
        if (const auto place = along(j, s, i, 0.0, param_.same))
          owner = Place{i, std::clamp(place->s, 0.0, lines_[i].length())};
      }
      const bool goes_on = run && owner && owner->line == run->last.line && owner->s >= run->last.s - kStep &&
                           owner->s < run->last.s + 5.0 * kStep;
      if (run && !goes_on) {
        runs.push_back(*run);
        run.reset();
      }
      if (!owner) continue;
      if (!run) run = Shared{s, s, *owner, *owner};
      run->end = s;
      run->last = *owner;
    }
    if (run) runs.push_back(*run);
    for (const Shared& found : runs) {
      const bool at_an_end = found.start < kStep || found.end > length - kStep;
      const bool goes_on = !line.shared.empty() && found.start - line.shared.back().end <= 2.0 * kStep;
      if (at_an_end || goes_on || found.end - found.start >= param_.least_run) line.shared.push_back(found);
    }
    double own = length;
    for (const Shared& found : line.shared) own -= found.end - found.start;
    if (own < param_.least_run && !line.shared.empty() && !line.closed)
      notes_.push_back("line '" + line.name + "' runs along others nearly everywhere");
  }

  /// Cuts a line, but where that would leave a sliver; where it is cut then.
  double cut(const Place& place, double sliver = kSliver) {
    std::vector<double>& cuts = lines_[place.line].cuts;
    const auto nearest = std::min_element(cuts.begin(), cuts.end(), [&](double a, double b) {
      return std::abs(a - place.s) < std::abs(b - place.s);
    });
    if (std::abs(*nearest - place.s) <= sliver) return *nearest;
    cuts.insert(std::upper_bound(cuts.begin(), cuts.end(), place.s), place.s);
    return place.s;
  }

  void link(const Place& from, const Place& to) {
    links_.push_back({{from.line, cut(from)}, {to.line, cut(to)}});
  }

  void link_shared(std::size_t j) {
    const std::vector<Shared>& shared = lines_[j].shared;
    for (std::size_t k = 0; k < shared.size(); ++k) {
      const Shared& run = shared[k];
      const bool follows = k > 0 && run.start - shared[k - 1].end <= 2.0 * kStep;
      if (follows) {
        const bool seam = shared[k - 1].last.line == run.first.line;  // of a lap
        if (!seam) link(shared[k - 1].last, run.first);
      } else if (run.start > kStep) {
        cut({j, run.start}, 0.0);
        link({j, run.start}, run.first);
      }
      const bool followed = k + 1 < shared.size() && shared[k + 1].start - run.end <= 2.0 * kStep;
      if (!followed && run.end < lines_[j].length() - kStep) {
        cut({j, run.end}, 0.0);
        link(run.last, {j, run.end});
      }
    }
  }

  bool owned(const Place& place) const {
    return std::any_of(lines_[place.line].shared.begin(), lines_[place.line].shared.end(),
                       [&](const Shared& run) { return place.s >= run.start && place.s <= run.end; });
  }

  std::optional<LaneProjection> beside(const Place& place, std::size_t other) const {
    const auto found = along(place.line, place.s, other, param_.least_beside, param_.most_beside);
    if (!found || owned(place) || owned({other, found->s})) return std::nullopt;
    return found;
  }

  void cut_beside(bool ends) {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      for (std::size_t j = 0; j < lines_.size(); ++j) {
        if (i == j) continue;
        const std::vector<double> cuts = lines_[i].cuts;
        for (const double s : cuts) {
          if (const auto place = beside({i, s}, j))
            cut({j, std::clamp(place->s, 0.0, lines_[j].length())}, param_.least_run);
        }
        if (ends) cut_run_ends(i, j);
      }
    }
  }

  void cut_run_ends(std::size_t i, std::size_t j) {
    const double length = lines_[i].length();
    double start = 0.0;
    bool on = false;
    for (double s = 0.0; s <= length; s += kStep) {
      const bool is = beside({i, s}, j).has_value();
      const bool last = s + kStep > length;
      if (is && !on) start = s;
      on = on || is;
      if (on && (!is || last)) {
        if (s - start >= param_.least_run) {
          cut({i, start}, param_.least_run);
          cut({i, s}, param_.least_run);
        }
        on = false;
      }
    }
  }

  void cut_pieces(std::size_t i) {
    const Line& line = lines_[i];
    for (std::size_t k = 1; k < line.cuts.size(); ++k) {
      const double start = line.cuts[k - 1], end = line.cuts[k];
      if (end - start < kSamePlace || owned({i, 0.5 * (start + end)})) continue;
      Piece piece;
      piece.place = {i, start};
      piece.end = end;
      piece.lane.id = line.name + "_" + std::to_string(k - 1);
      piece.lane.centerline.push_back(line.line.point_at(start));
      for (const PathPoint& point : line.line.points()) {
        if (point.s > start + 1e-3 && point.s < end - 1e-3) piece.lane.centerline.push_back(point.position);
      }
      piece.lane.centerline.push_back(line.line.point_at(end));
      piece.lane.left_width = piece.lane.right_width = {{0.0, param_.width / 2.0}};
      pieces_.push_back(std::move(piece));
    }
  }

  bool is_same(const Place& a, const Place& b) const {
    if (a.line != b.line) return false;
    const double gap = std::abs(a.s - b.s);
    return gap < kSamePlace ||
           (lines_[a.line].closed && std::abs(gap - lines_[a.line].length()) < kSamePlace);
  }

  /// Draws one end of a centerline to a point, less and less along it.
  void draw_to(Polyline& centerline, const Point2& point, bool start) const {
    if (!start) std::reverse(centerline.begin(), centerline.end());
    const Point2 off = point - centerline.front();
    const double reach = std::min(param_.blend, 0.5 * chord_length(centerline));
    double s = 0.0;
    Point2 before = centerline.front();
    for (Point2& each : centerline) {
      s += (each - before).norm();
      before = each;
      each += off * std::max(0.0, 1.0 - s / reach);
    }
    if (!start) std::reverse(centerline.begin(), centerline.end());
  }

  void link_pieces() {
    for (Piece& from : pieces_) {
      for (Piece& to : pieces_) {
        const Place end{from.place.line, from.end};
        bool follows = is_same(end, to.place);
        for (const auto& [a, b] : links_) {
          if (!is_same(a, end) || !is_same(b, to.place)) continue;
          follows = true;
          // The line that was there first stays where it is.
          if (a.line < b.line) draw_to(to.lane.centerline, lines_[a.line].line.point_at(a.s), true);
          if (b.line < a.line) draw_to(from.lane.centerline, lines_[b.line].line.point_at(b.s), false);
        }
        if (!follows) continue;
        from.lane.successors.push_back(to.lane.id);
        to.lane.predecessors.push_back(from.lane.id);
      }
    }
  }

  void link_beside() {
    for (Piece& own : pieces_) {
      for (Piece& other : pieces_) {
        if (own.place.line == other.place.line) continue;
        const auto there = beside({own.place.line, 0.5 * (own.place.s + own.end)}, other.place.line);
        const auto back = beside({other.place.line, 0.5 * (other.place.s + other.end)}, own.place.line);
        const bool in = there && back && there->s > other.place.s && there->s < other.end &&
                        back->s > own.place.s && back->s < own.end;
        if (!in) continue;
        const bool left = there->l > 0.0;  // of the other
        (left ? own.lane.right_neighbors : own.lane.left_neighbors).push_back(other.lane.id);
        (left ? own.lane.right_width : own.lane.left_width) = {{0.0, there->distance / 2.0}};
      }
    }
  }

  LineGraphParam param_;
  std::vector<std::string>& notes_;
  std::vector<Line> lines_;
  std::vector<std::pair<Place, Place>> links_;
  std::vector<Piece> pieces_;
};

}  // namespace

LaneGraph graph_from_lines(const std::vector<NamedLine>& lines, const LineGraphParam& param,
                           std::vector<std::string>& notes) {
  return Maker(lines, param, notes).make();
}

}  // namespace relative_map::core
