#include "relative_map/pipeline/lines/navigation_lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "relative_map/pipeline/lines/closed_line.hpp"

namespace relative_map::core {

namespace {

constexpr double kMinSpacing = 1e-3;  // [m] nearer vertices are one and the same
constexpr double kFarthest = 1e8;     // [m] no projection of the Earth reaches farther
/// An about-turn shows in the chords of a line over some reach [m] before and behind a vertex, by the cosine
/// of the turn between them: about 100 degrees on a radius of 0.6 m, and 115 on that of a lane's half width.
constexpr std::pair<double, double> kAboutTurns[] = {{1.0, -0.17}, {3.5, -0.42}};
constexpr std::size_t kManyLines = 1000;  // that nobody means to send

/// Positions relative to the first point, with duplicates left out; a sentence if there are too few.
std::string clean_positions(const RecordedLine& recorded, NavigationLine& line,
                            std::vector<std::size_t>& kept) {
  for (std::size_t i = 0; i < recorded.points.size(); ++i) {
    const LinePoint& point = recorded.points[i];
    for (const auto& [field, value] : {std::pair("x", point.x), std::pair("y", point.y)}) {
      if (std::abs(value) < kFarthest) continue;  // not if it is NaN
      std::ostringstream fault;
      fault << "path_point[" << i << "]." << field << " is " << value << (std::isfinite(value) ? " m" : "");
      return fault.str();
    }
  }
  if (recorded.points.empty()) return "it has no points";
  line.origin = {recorded.points[0].x, recorded.points[0].y};
  for (std::size_t i = 0; i < recorded.points.size(); ++i) {
    PathPoint point;
    point.position = Point2(recorded.points[i].x, recorded.points[i].y) - line.origin;
    if (!kept.empty() && (point.position - line.points.back().position).norm() < kMinSpacing) continue;
    line.points.push_back(point);
    kept.push_back(i);
  }
  return kept.size() < 2 ? "it has fewer than two distinct points" : "";
}

/// Whether the recorded headings are those of the positions.
bool headings_agree(const RecordedLine& recorded, const std::vector<std::size_t>& kept,
                    const PathPoints& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double difference = angle_difference(recorded.points[kept[i]].theta, points[i].theta);
    if (!(std::abs(difference) <= 0.005)) return false;
  }
  return true;
}

/// [rad] from the tangent of a circle to a chord of it.
double tangent_to_chord(double kappa, double chord) {
  return std::asin(std::clamp(0.5 * kappa * chord, -1.0, 1.0));
}

/// Whether heading and curvature at a vertex fit the segments before and after it, whichever of them a window
/// leaves.
bool fits_segments(const PathPoints& points, std::size_t i, double theta, double kappa) {
  const auto fits = [&](std::size_t from, double sign) {
    const Point2 segment = points[from + 1].position - points[from].position;
    const double along = std::atan2(segment.y(), segment.x());
    const double expected = along - sign * tangent_to_chord(kappa, segment.norm());
    return std::abs(angle_difference(theta, expected)) <= 0.008;
  };
  return (i == 0 || fits(i - 1, -1.0)) && (i + 1 == points.size() || fits(i, 1.0));
}

/// Whether the recorded curvatures are those of the headings: point by point, and summed up over a few
/// metres.
bool curvatures_agree(const RecordedLine& recorded, const std::vector<std::size_t>& kept,
                      const PathPoints& points) {
  std::size_t anchor = 0;
  double turned = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double kappa = recorded.points[kept[i]].kappa;
    if (!(std::abs(kappa - points[i].kappa) <= 0.005 + 0.1 * std::abs(points[i].kappa))) return false;
    if (!fits_segments(points, i, recorded.points[kept[i]].theta, kappa)) return false;
    if (i == 0) continue;
    turned += 0.5 * (kappa + recorded.points[kept[i - 1]].kappa) * (points[i].s - points[i - 1].s);
    if (points[i].s - points[anchor].s < 5.0 && i + 1 < points.size()) continue;
    if (std::abs(angle_difference(points[i].theta - points[anchor].theta, turned)) > 0.002) return false;
    anchor = i;
    turned = 0.0;
  }
  return true;
}

/// From the point before to the one after, as of curvatures that are computed.
void set_rates(PathPoints& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PathPoint &before = points[i == 0 ? 0 : i - 1], &after = points[std::min(i + 1, points.size() - 1)];
    points[i].dkappa = (after.kappa - before.kappa) / (after.s - before.s);
  }
}

/// dkappa as recorded where all of it is finite and of a size with the curvature's changes.
bool rates_agree(const RecordedLine& recorded, const std::vector<std::size_t>& kept,
                 const PathPoints& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double difference = recorded.points[kept[i]].dkappa - points[i].dkappa;
    if (!(std::abs(difference) <= 1e-3 + 0.1 * std::abs(points[i].dkappa))) return false;
  }
  return true;
}

/// Keeps the line's own theta, kappa and dkappa as far as they agree with its positions.
void keep_recorded_geometry(const RecordedLine& recorded, const std::vector<std::size_t>& kept,
                            NavigationLine& line) {
  PathPoints& points = line.points;
  if (!headings_agree(recorded, kept, points) || !curvatures_agree(recorded, kept, points)) return;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].theta = normalize_angle(recorded.points[kept[i]].theta);
    points[i].direction = {std::cos(points[i].theta), std::sin(points[i].theta)};
    points[i].kappa = recorded.points[kept[i]].kappa;
  }
  set_rates(points);
  if (!rates_agree(recorded, kept, points)) return;
  for (std::size_t i = 0; i < points.size(); ++i) points[i].dkappa = recorded.points[kept[i]].dkappa;
}

std::string kink_sentence(const NavigationLine& line) {
  std::ostringstream sentence;
  sentence.precision(3);
  sentence << "line '" << line.id << "' turns back at s = " << line.points[line.kinks.front()].s << " m";
  if (line.kinks.size() > 1) sentence << " and at " << line.kinks.size() - 1 << " more points";
  sentence << ": no vehicle gets round so sharply, and its lane ends there";
  return sentence.str();
}

bool has_kink(const NavigationLine& line, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i <= to; ++i) {
    if (line.is_kink(i % line.points.size())) return true;
  }
  return false;
}

/// Adds to the kinks of a line the about-turns that take it several vertices: where the chords before and
/// behind a vertex enclose so sharp an angle, no vehicle gets round, and no lane has two borders.
void add_about_turns(NavigationLine& line, double reach, double sharpest) {
  const PathPoints& points = line.points;
  const std::size_t n = points.size();
  // Vertices are counted on from the second of three laps of a closed line.
  const std::size_t first = line.closed() ? n : 0, last = line.closed() ? 2 * n - 1 : n - 1;
  const std::size_t most = line.closed() ? 3 * n - 1 : n - 1;
  const auto s = [&](std::size_t i) { return points[i % n].s + static_cast<double>(i / n) * line.length; };
  const auto at = [&](std::size_t i) -> const Point2& { return points[i % n].position; };
  std::vector<std::size_t> found;
  std::size_t before = 0, after = first, sharp_since = 0;  // 0: it is not sharp
  for (std::size_t i = first; i <= last; ++i) {
    while (before + 1 < i && s(i) - s(before + 1) >= reach) ++before;
    while (after < most && s(after) - s(i) < reach) ++after;
    const Point2 back = at(i) - at(before), ahead = at(after) - at(i);
    // Beside a kink the chords are of two directions anyhow.
    const bool sharp =
        back.dot(ahead) < sharpest * back.norm() * ahead.norm() && !has_kink(line, before, after);
    if (sharp && sharp_since == 0) sharp_since = i;
    if (sharp_since == 0 || (sharp && i < last)) continue;
    const std::size_t end = sharp ? i : i - 1;
    for (const std::size_t kink : {sharp_since, (sharp_since + end) / 2, end}) found.push_back(kink % n);
    sharp_since = 0;
  }
  line.kinks.insert(line.kinks.end(), found.begin(), found.end());
  std::sort(line.kinks.begin(), line.kinks.end());
  line.kinks.erase(std::unique(line.kinks.begin(), line.kinks.end()), line.kinks.end());
}

/// The last segment may be of any length, so it does not count.
bool spacing_varies(const PathPoints& points) {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const double ds = points[i].s - points[i - 1].s;
    shortest = std::min(shortest, ds);
    longest = std::max(longest, ds);
  }
  return longest > 2.0 * shortest;
}

/// A sentence if the line can't be driven on.
std::string prepare(const RecordedLine& recorded, const IntakeParam& param, NavigationLine& line) {
  std::vector<std::size_t> kept;
  if (std::string fault = clean_positions(recorded, line, kept); !fault.empty()) return fault;
  compute_arc_length(line.points);
  compute_geometry(line.points);
  line.length = line.points.back().s;
  const bool stitched = param.stitch_closed_lines && stitch(line, param.lane_half_width);
  if (!stitched) keep_recorded_geometry(recorded, kept, line);
  line.thinned = spacing_varies(line.points);
  line.kinks = find_kinks(line.points, line.ends);
  for (const auto& [reach, sharpest] : kAboutTurns) add_about_turns(line, reach, sharpest);
  line.index = SegmentIndex(line.points, line.ends);
  for (const PathPoint& point : line.points) line.bounds.extend(point.position);
  return "";
}

/// By name where names tell lines apart, else by place in the message too.
std::vector<std::string> make_ids(const std::vector<RecordedLine>& lines) {
  std::map<std::string, int> uses;
  for (const RecordedLine& line : lines) ++uses[line.name];
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string id = lines[i].name;
    if (id.empty() || uses[id] > 1) {
      id = "line_" + std::to_string(i) + "_" + id;
      while (uses.count(id) > 0) id += "_";  // another line bears that very name
    }
    ids.push_back(id);
  }
  return ids;
}

/// The first of the line's own numbers that is infinite, which is not what "not given" looks like.
std::string infinite_number(const RecordedLine& recorded) {
  for (std::size_t i = 0; i < recorded.points.size(); ++i) {
    const LinePoint& point = recorded.points[i];
    for (const auto& [field, value] : {std::pair("theta", point.theta), std::pair("kappa", point.kappa),
                                       std::pair("dkappa", point.dkappa), std::pair("s", point.s)}) {
      if (!std::isinf(value)) continue;
      std::ostringstream fault;
      fault << "path_point[" << i << "]." << field << " is " << value
            << ": computed from the positions, as all along the line";
      return fault.str();
    }
  }
  return "";
}

/// Two lines of one priority would leave open which one yields: the later one moves back.
void make_priorities_unique(NavigationLines& result) {
  std::vector<NavigationLine*> order;
  const auto room = static_cast<std::uint32_t>(result.lines.size());
  for (NavigationLine& line : result.lines) {
    line.priority = std::min(line.priority, std::numeric_limits<std::uint32_t>::max() - room);
    order.push_back(&line);
  }
  std::stable_sort(order.begin(), order.end(), [](const NavigationLine* a, const NavigationLine* b) {
    return a->priority < b->priority;
  });
  std::string fault;
  std::size_t moved = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (order[i]->priority > order[i - 1]->priority) continue;
    const std::string given = std::to_string(order[i]->priority);
    order[i]->priority = order[i - 1]->priority + 1;
    if (moved++ > 0) continue;
    fault = "path_priority of line '" + order[i]->id + "' is " + given +
            ", which is taken: it now has priority " + std::to_string(order[i]->priority);
  }
  if (moved > 1) fault += ", and " + std::to_string(moved - 1) + " more lines move back as well";
  if (moved > 0) result.faults.push_back(fault);
  if (!order.empty() && order.front()->priority > 0) {
    result.faults.push_back("path_priority of the best line, '" + order.front()->id + "', is " +
                            std::to_string(order.front()->priority) + ", not 0: it counts as 0");
  }
}

}  // namespace

IntakeParam IntakeParam::of(const PipelineConfig& config) {
  return {config.enable_cyclic_rerouting,
          std::min(config.map_param.default_left_width, config.map_param.default_right_width)};
}

std::shared_ptr<const NavigationLines> prepare_navigation_lines(const NavigationInfo& info,
                                                                const IntakeParam& param) {
  auto result = std::make_shared<NavigationLines>();
  result->frame_id = info.frame_id;
  const std::vector<std::string> ids = make_ids(info.lines);
  for (std::size_t i = 0; i < info.lines.size(); ++i) {
    NavigationLine line;
    line.id = ids[i];
    line.name = info.lines[i].name;
    line.priority = info.lines[i].priority;
    if (const std::string fault = prepare(info.lines[i], param, line); !fault.empty()) {
      result->faults.push_back("line '" + line.id + "' is left out: " + fault);
      continue;
    }
    if (!line.kinks.empty()) result->faults.push_back(kink_sentence(line));
    if (const std::string fault = infinite_number(info.lines[i]); !fault.empty()) {
      result->faults.push_back("line '" + line.id + "': " + fault);
    }
    result->lines.push_back(std::move(line));
  }
  make_priorities_unique(*result);
  if (info.lines.size() > kManyLines) {
    result->faults.push_back(
        "navigation_path has " + std::to_string(info.lines.size()) +
        " lines: each tick looks at all of them, and a map has the best of those in reach");
  }
  return result;
}

}  // namespace relative_map::core
