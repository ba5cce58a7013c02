#include "relative_map/tools/line_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "relative_map/geometry/segment_index.hpp"
#include "relative_map/pipeline/lines/navigation_lines.hpp"
#include "relative_map/tools/bridged_gaps.hpp"
#include "relative_map/tools/editable_line.hpp"
#include "steering.hpp"

namespace relative_map::core {

namespace {

constexpr double kMinSpacing = 1e-3;      // [m]
constexpr double kMaxKink = 0.5;          // [rad] between chords
constexpr double kMaxStepError = 0.05;    // of a chord's length, between s and the points
constexpr double kMaxHeadingError = 0.1;  // [rad]
constexpr double kBesideItself = 1.0;     // [m]
constexpr double kApart = 30.0;           // [m] along the line, of what lies beside itself
constexpr double kSampling = 2.0;         // [m] of the search for that
constexpr double kTightCurveReach = 1.5;  // [m]
constexpr double kBeyondEquator = 2.5e5;  // [m] that a zone's coordinates go on on the other side
constexpr double kFar = 1000.0;           // [m] no gap, but a jump to another zone or origin

template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  text.precision(4);
  (text << ... << parts);
  return text.str();
}

/// Some way beyond the zone's borders: a line may lead over them, and over the equator.
bool lies_in_zone(double x, double y, bool north) {
  const double least = north ? -kBeyondEquator : 1.1e6, most = north ? 9.4e6 : 1e7 + kBeyondEquator;
  return x > 0.0 && x < 1e6 && y > least && y < most;
}

/// Collects faults; of those in a row the worst one speaks.
class Faults {
 public:
  void add(const std::string& kind, std::size_t point, double s, double size, const std::string& what,
           std::size_t reach = 1) {
    if (!list_.empty() && list_.back().kind == kind && point <= last_ + reach) {
      LineFault& fault = list_.back();
      ++fault.count;
      fault.to = s;
      if (size > worst_) {
        fault.what = what;
        fault.point = point;
        fault.s = s;
        worst_ = size;
      }
    } else {
      list_.push_back({kind, point, s, 1, what, s, s});
      worst_ = size;
    }
    last_ = point;
  }
  std::vector<LineFault> take() { return std::move(list_); }

 private:
  std::vector<LineFault> list_;
  std::size_t last_ = 0;
  double worst_ = 0.0;
};

/// A line that all coordinates of are finite.
class Checker {
 public:
  Checker(const RecordedLine& line, const LineHeader& header, const LineCheckParam& param)
      : recorded_(line), header_(header), param_(param) {
    for (const LinePoint& point : line.points) {
      s_.push_back(points_.empty() ? 0.0 : s_.back() + (position(point) - points_.back()).norm());
      points_.push_back(position(point));
    }
  }

  std::vector<LineFault> run() {
    if (check_degrees()) return faults_.take();
    check_place();
    check_steps();
    check_bridged();
    check_intake();
    if (points_.size() < 3 || distinct_points().size() < 3) return faults_.take();
    const EditableLine line = make_editable(recorded_);
    given_ = distinct_points();
    const PathPoints path = path_of(line);
    check_kinks(line, path);
    check_curvature(path);
    check_steering(line, path);
    check_headings(path);
    check_overlap(line, path);
    return faults_.take();
  }

 private:
  Point2 position(const LinePoint& point) const {
    return Point2(point.x, point.y) - Point2(recorded_.points[0].x, recorded_.points[0].y);
  }

  /// Which of the file's points make_editable() keeps.
  std::vector<std::size_t> distinct_points() const {
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (kept.empty() || (points_[i] - points_[kept.back()]).norm() >= kMinSpacing) kept.push_back(i);
    }
    return kept;
  }

  /// At a point of the line without those that are there twice.
  void add(const std::string& kind, std::size_t i, double size, const std::string& what,
           std::size_t reach = 1) {
    faults_.add(kind, given_[i], s_[given_[i]], size, what, reach);
  }

  void check_bridged() {
    for (const BridgedGap& gap : header_.bridged) {
      if (length_of(gap) <= param_.max_gap) continue;
      const std::size_t i = nearest_point(recorded_, gap.from_x, gap.from_y);
      faults_.add("bridged", i, s_[i], length_of(gap),
                  sentence("nothing was recorded for ", length_of(gap),
                           " m from here on, and the line across is a guess"));
    }
  }

  /// What the map node says of it.
  void check_intake() {
    NavigationInfo info;
    info.lines.push_back(recorded_);
    const auto lines = prepare_navigation_lines(info, {});
    for (const std::string& fault : lines->faults) {
      if (fault.find("turns back") == std::string::npos) faults_.add("node", 0, 0.0, 0.0, fault);
    }
  }

  bool check_degrees() {
    const bool degrees = header_.reference.projection == Projection::kNone && s_.back() > 0.0 &&
                         s_.back() < 1.0 && points_.size() > 2;
    if (degrees) {
      faults_.add("zone", 0, 0.0, 0.0,
                  sentence("the whole line is ", s_.back(),
                           " m long: these are degrees, and not metres of a map frame"));
    }
    return degrees;
  }

  void check_place() {
    const GeoReference& reference = header_.reference;
    for (std::size_t i = 0; i < recorded_.points.size(); ++i) {
      const double x = recorded_.points[i].x, y = recorded_.points[i].y;
      if (reference.projection == Projection::kUtm && !lies_in_zone(x, y, reference.north)) {
        faults_.add("zone", i, s_[i], 0.0,
                    sentence("x ", x, ", y ", y, " can't lie in ", describe(reference)));
      }
      if (reference.projection == Projection::kLocal && !(std::hypot(x, y) < 2e5)) {
        faults_.add(
            "zone", i, s_[i], 0.0,
            sentence("it is ", std::hypot(x, y) / 1000.0, " km from the origin of ", describe(reference)));
      }
    }
  }

  void check_steps() {
    if (s_.back() < kMinSpacing) faults_.add("short", 0, 0.0, 0.0, "all points are one");
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const double step = s_[i] - s_[i - 1];
      if (step < kMinSpacing) faults_.add("duplicate", i, s_[i], 0.0, "it lies where the point before lies");
    }
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const double step = s_[i] - s_[i - 1];
      if (step <= param_.max_gap) continue;
      const char* const why = step > kFar ? ": is it another zone or origin from here on?" : "";
      faults_.add("gap", i, s_[i - 1], step, sentence("it is ", step, " m to the point before", why));
    }
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const double given = recorded_.points[i].s - recorded_.points[i - 1].s, step = s_[i] - s_[i - 1];
      if (step < kMinSpacing || !std::isfinite(given)) continue;
      if (given <= 0.0) {
        faults_.add("backward s", i, s_[i], -given, sentence("s goes back by ", -given, " m"));
      } else if (std::abs(given - step) > kMaxStepError * step + kMinSpacing) {
        faults_.add("wrong s", i, s_[i], std::abs(given - step),
                    sentence("s grows by ", given, " m over ", step, " m"));
      }
    }
  }

  void check_kinks(const EditableLine& line, const PathPoints& path) {
    const std::size_t count = path.size(), open = line.closed() ? 0 : 1;
    for (std::size_t i = open; i + open < count; ++i) {
      const Point2 before = line.points[i] - line.points[(i + count - 1) % count];
      const Point2 after = line.points[(i + 1) % count] - line.points[i];
      const double turn = std::abs(std::atan2(cross(before, after), before.dot(after)));
      if (turn > 0.5 * kPi) {
        add("backward", i, turn, sentence("the line turns back by ", turn, " rad"));
      } else if (turn > kMaxKink) {
        add("kink", i, turn, sentence("the line turns by ", turn, " rad at once"));
      }
    }
  }

  void check_curvature(const PathPoints& path) {
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double kappa = std::abs(path[i].kappa);
      if (kappa <= param_.max_curvature) continue;
      add("curvature", i, kappa,
          sentence("the curvature is ", kappa, " 1/m, and the vehicle's limit ", param_.max_curvature,
                   " 1/m"),
          3);
    }
  }

  /// Points near those whose curvature is a fault already.
  std::vector<bool> near_tight_curves(const PathPoints& path) const {
    std::vector<bool> near(path.size(), false);
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (std::abs(path[i].kappa) <= param_.max_curvature) continue;
      for (std::size_t k = i + 1; k-- > 0 && path[i].s - path[k].s <= kTightCurveReach;) near[k] = true;
      for (std::size_t k = i; k < path.size() && path[k].s - path[i].s <= kTightCurveReach; ++k)
        near[k] = true;
    }
    return near;
  }

  void check_steering(const EditableLine& line, const PathPoints& path) {
    const std::vector<Steering> all = steering_along(path, line.ends, length_of(line));
    const std::vector<bool> said = near_tight_curves(path);
    for (std::size_t i = 0; i < path.size(); ++i) {
      const Steering& steering = all[i];
      if (steering.rate <= param_.max_curvature_rate || said[i]) continue;
      add("curvature rate", i, steering.rate,
          sentence("the curvature goes from ", steering.before, " to ", steering.after,
                   " 1/m within a metre: at ", steering.speed, " m/s by ", steering.rate,
                   " 1/(m s), and the vehicle's limit is ", param_.max_curvature_rate),
          3);
    }
  }

  void check_headings(const PathPoints& path) {
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double given = recorded_.points[given_[i]].theta;
      const double error = std::abs(angle_difference(given, path[i].theta));
      if (!(error > kMaxHeadingError)) continue;
      add("wrong theta", i, error,
          sentence("theta is ", given, " rad, but the points lead to ", path[i].theta, " rad"), 5);
    }
  }

  static double s_of_next(const PathPoints& path, std::size_t i) {
    return path[std::min(i + 1, path.size() - 1)].s;
  }

  void check_overlap(const EditableLine& line, const PathPoints& path) {
    const SegmentIndex index(path, line.ends);
    const double length = length_of(line);
    double next = 0.0;
    for (std::size_t i = 0, step = 0; i < path.size(); ++i, ++step) {
      if (path[i].s < next) continue;
      next = path[i].s + kSampling;
      for (const Foot& foot : index.passes(path, path[i].position, kBesideItself)) {
        double apart = std::abs(path[foot.segment].s - path[i].s);
        if (line.closed()) apart = std::min(apart, length - apart);
        const bool same_way = path[foot.segment].direction.dot(path[i].direction) > 0.9;
        const bool in_gap = s_of_next(path, foot.segment) - path[foot.segment].s > param_.max_gap;
        if (in_gap || apart < kApart || !same_way || path[foot.segment].s > path[i].s) continue;
        add("overlap", i, 0.0,
            sentence("the line lies beside itself: it has been here at s = ", path[foot.segment].s, " m"),
            step + 1);
        step = 0;
        break;
      }
    }
  }

  const RecordedLine& recorded_;
  const LineHeader& header_;
  const LineCheckParam& param_;
  Polyline points_;
  std::vector<double> s_;
  std::vector<std::size_t> given_;  ///< the points of the file that the line is made of
  Faults faults_;
};

}  // namespace

std::vector<std::string> line_fault_kinds() {
  return {"not finite",     "zone",        "short",    "duplicate", "gap",
          "backward s",     "wrong s",     "backward", "kink",      "curvature",
          "curvature rate", "wrong theta", "overlap",  "bridged",   "node"};
}

std::vector<LineFault> check_line(const RecordedLine& line, const LineHeader& header,
                                  const LineCheckParam& param) {
  Faults faults;
  if (line.points.size() < 2) {
    faults.add("short", 0, 0.0, 0.0, "it has fewer than two points");
    return faults.take();
  }
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    if (std::isfinite(line.points[i].x) && std::isfinite(line.points[i].y)) continue;
    faults.add("not finite", i, 0.0, 0.0, "x or y is not finite");
  }
  std::vector<LineFault> not_finite = faults.take();
  return not_finite.empty() ? Checker(line, header, param).run() : not_finite;
}

}  // namespace relative_map::core
