#include "ugly_drive.hpp"

#include <algorithm>

namespace relative_map::core::test {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double any_number(Random& random) {
  constexpr double kNumbers[] = {0.0,  -0.0, 1.0,  -1.0,   kNaN,  kInfinity, -kInfinity, 1e-300,
                                 1e30, -1e9, 40.0, 1000.0, 1e308, -1000.0,   90.0,       1e-9};
  return kNumbers[random.integer(0, 15)];
}

/// Now and then another number than `value`.
double spoilt(Random& random, double value, double probability) {
  return random.chance(probability) ? any_number(random) : value;
}

void append(Polyline& points, const Polyline& more) {
  points.insert(points.end(), more.begin(), more.end());
}

Polyline hairpins(Random& random, double spacing) {
  Polyline points;
  Pose2 place;
  const int turns = random.integer(1, 5);
  for (int i = 0; i < turns; ++i) {
    const double length = random.uniform(0.0, 60.0), radius = random.uniform(1.5, 8.0);
    const double angle = random.uniform(0.3, 1.6) * kPi, side = random.chance(0.5) ? 1.0 : -1.0;
    append(points, straight(place, length, spacing));
    place = place.to_parent(Pose2(Point2(length, 0.0), 0.0));
    append(points, arc(place, side / radius, radius * angle, std::min(spacing, 0.7 * radius)));
    place = along_arc(place, side / radius, radius * angle);
  }
  append(points, straight(place, random.uniform(0.0, 60.0), spacing));
  return points;
}

/// A walk with bends of up to `sharpest` [rad] at each vertex: it crosses itself sooner or later.
Polyline walk(Random& random, double spacing, double sharpest) {
  Polyline points = {Point2::Zero()};
  Pose2 place;
  const int steps = random.integer(1, 300);
  for (int i = 0; i < steps; ++i) {
    place = place.to_parent(Pose2(Point2(spacing, 0.0), random.uniform(-sharpest, sharpest)));
    points.push_back(place.position());
  }
  return points;
}

Polyline zigzag(Random& random) {
  Polyline points;
  const double stride = random.uniform(0.01, 5.0), height = random.uniform(0.0, 3.0);
  for (int i = 0; i < 200; ++i) points.emplace_back(stride * i, (i % 2) * height);
  return points;
}

Polyline figure(Random& random, double spacing) {
  const double a = random.uniform(2.0, 120.0), b = random.uniform(1.0, 80.0),
               turns = random.uniform(0.1, 3.0);
  const int lobes = random.integer(1, 3);
  const auto count = static_cast<int>(std::clamp(2.0 * kPi * (a + lobes * b) * turns / spacing, 3.0, 3000.0));
  Polyline points;
  for (int i = 0; i <= count; ++i) {
    const double t = 2.0 * kPi * turns * i / count;
    points.emplace_back(a * std::sin(t), b * std::sin(lobes * t + (lobes == 1 ? 0.5 * kPi : 0.0)));
  }
  return points;
}

Polyline there_and_back(Random& random, double spacing) {
  Polyline points = random.chance(0.5) ? straight(Pose2(), random.uniform(5.0, 200.0), spacing)
                                       : arc(Pose2(), random.uniform(-0.1, 0.1), 80.0, spacing);
  Polyline back(points.rbegin(), points.rend());
  if (random.chance(0.5)) back.erase(back.begin());  // else the far end is twice there
  append(points, moved(back, Pose2(Point2(0.0, random.chance(0.5) ? 0.0 : random.uniform(-3.0, 3.0)), 0.0)));
  return points;
}

Polyline any_shape(Random& random) {
  const double spacing = random.chance(0.2) ? random.uniform(5.0, 60.0) : random.uniform(0.05, 3.0);
  switch (random.integer(0, 6)) {
    case 0:
      return hairpins(random, spacing);
    case 1:
      return walk(random, spacing, random.uniform(0.0, 0.5));
    case 2:
      return walk(random, spacing, kPi);
    case 3:
      return zigzag(random);
    case 4:
      return figure(random, spacing);
    case 5:
      return there_and_back(random, spacing);
    default:
      return straight(Pose2(), random.uniform(0.0, 300.0), spacing);
  }
}

}  // namespace

RecordedLine ugly_line(Random& random, const std::string& name) {
  Polyline points = any_shape(random);
  if (random.chance(0.2)) std::reverse(points.begin(), points.end());
  const double noise = random.chance(0.3) ? random.uniform(0.0, 0.3) : 0.0;
  const auto stray = [&] { return noise * random.uniform(-1.0, 1.0); };
  for (Point2& point : points) point += Point2(stray(), stray());
  const Pose2 somewhere(Point2(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0)),
                        random.uniform(-kPi, kPi));
  RecordedLine line = recording(moved(points, somewhere), name,
                                static_cast<std::uint32_t>(random.chance(0.1) ? -1 : random.integer(0, 3)));
  const PathPoints truth = points.size() > 1 ? path_through(moved(points, somewhere)) : PathPoints();
  const double wrong = random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.02);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (wrong == 0.0) break;
    LinePoint& point = line.points[i];
    point.theta = truth[i].theta + wrong * random.uniform(-1.0, 1.0);
    point.kappa = truth[i].kappa + wrong * random.uniform(-1.0, 1.0);
    point.dkappa = truth[i].dkappa;
    point.s = any_number(random);
  }
  if (line.points.size() > 3 && random.chance(0.2)) {  // the vehicle stood for a while
    const auto at = line.points.begin() + random.integer(0, static_cast<int>(line.points.size()) - 1);
    line.points.insert(at, static_cast<std::size_t>(random.integer(1, 20)), LinePoint(*at));
  }
  if (!line.points.empty() && random.chance(0.05)) {
    line.points[line.points.size() / 2].y = any_number(random);
  }
  return line;
}

LaneMarkers ugly_markers(Random& random, Time now) {
  LaneMarkers markers;
  markers.stamp = now + from_seconds(random.chance(0.7) ? 0.0 : random.uniform(-1.0, 1.0));
  markers.base_from_sensor = Pose2(Point2(random.uniform(-3.0, 3.0), random.uniform(-1.0, 1.0)),
                                   random.chance(0.5) ? 0.0 : random.uniform(-0.5, 0.5));
  const double view_range = random.chance(0.5) ? random.uniform(0.0, 3.0) : random.uniform(3.0, 300.0);
  const auto bend = [&](double most) { return random.chance(0.5) ? 0.0 : random.uniform(-most, most); };
  const Cubic cubic{bend(3.0), bend(1.0), bend(0.1), bend(1e-2)};
  for (LaneMarker* marker : {&markers.left, &markers.right}) {
    marker->cubic = cubic;
    marker->cubic.c0 += (marker == &markers.left ? 1.0 : -1.0) * random.uniform(0.8, 2.5);
    marker->quality = spoilt(random, random.uniform(0.0, 1.0), 0.1);
    marker->view_range = spoilt(random, view_range, 0.1);
    marker->longitude_start = spoilt(random, bend(20.0), 0.1);
    marker->type = static_cast<BoundaryType>(random.integer(0, 255));
    double* const numbers[] = {&marker->cubic.c0, &marker->cubic.c1, &marker->cubic.c2, &marker->cubic.c3};
    if (random.chance(0.1)) *numbers[random.integer(0, 3)] = any_number(random);
  }
  return markers;
}

PipelineConfig ugly_config(Random& random) {
  while (true) {
    PipelineConfig config;
    NavigationLaneParam& lane = config.navigation_lane;
    double* const numbers[] = {&config.map_param.default_left_width,
                               &config.map_param.default_right_width,
                               &lane.max_len_from_navigation_line,
                               &lane.min_len_for_navigation_lane,
                               &lane.max_len_for_navigation_lane,
                               &lane.ratio_navigation_lane_len_to_speed,
                               &lane.max_distance_to_navigation_line,
                               &lane.min_view_range_to_use_lane_marker,
                               &lane.min_lane_half_width,
                               &lane.max_lane_half_width,
                               &config.lane_fusion.fade_length,
                               &config.footprint.half_width};
    for (double* number : numbers) {
      if (random.chance(0.2)) *number *= std::exp(random.uniform(-2.5, 1.5));
    }
    config.lane_fusion.method = random.chance(0.7) ? "estimator" : "fixed_weight";
    lane.lane_marker_weight = random.chance(0.3) ? 1.0 : random.uniform(0.0, 1.0);
    lane.min_lane_marker_quality = random.uniform(0.0, 0.5);
    if (random.chance(0.1)) lane.lane_source = LaneSource::kPerception;
    config.enable_cyclic_rerouting = random.chance(0.7);
    config.generate_left_boundary = random.chance(0.7);
    if (config.validate().empty()) return config;
  }
}

void UglyDrive::change_lines() {
  lines_.clear();
  const int count = random_.integer(1, 5);
  for (int i = 0; i < count; ++i) {
    lines_.push_back(ugly_line(random_, random_.chance(0.1) ? "twice" : "line " + std::to_string(i)));
  }
  if (random_.chance(0.3)) {  // the same road again, a little beside it
    RecordedLine beside = lines_.front();
    const double dx = random_.uniform(-4.0, 4.0), dy = random_.uniform(-4.0, 4.0);
    for (LinePoint& point : beside.points) {
      point.x += dx;
      point.y += dy;
    }
    beside.name = "beside";
    lines_.push_back(beside);
  }
}

void UglyDrive::put_beside_a_line() {
  const RecordedLine& line =
      lines_[static_cast<std::size_t>(random_.integer(0, static_cast<int>(lines_.size()) - 1))];
  if (line.points.size() < 2) return;
  const auto i = static_cast<std::size_t>(random_.integer(0, static_cast<int>(line.points.size()) - 2));
  const LinePoint &a = line.points[i], &b = line.points[i + 1];
  if (!std::isfinite(a.x + a.y + b.x + b.y)) return;
  const Pose2 on_line(Point2(a.x, a.y), std::atan2(b.y - a.y, b.x - a.x));
  const double l = random_.chance(0.7) ? random_.uniform(-2.0, 2.0) : random_.uniform(-20.0, 20.0);
  const double turn = random_.chance(0.7) ? random_.uniform(-0.3, 0.3) : random_.uniform(-kPi, kPi);
  pose_ = on_line.to_parent(Pose2(Point2(0.0, l), turn));
}

void UglyDrive::move_vehicle() {
  const double choice = random_.uniform(0.0, 1.0);
  const double seconds = choice < 0.8    ? 0.1
                         : choice < 0.86 ? 0.0
                         : choice < 0.95 ? random_.uniform(-0.6, 2.0)
                                         : random_.uniform(-1e4, 1e4);
  now_ += from_seconds(seconds);
  if (random_.chance(0.2)) speed_ = random_.uniform(-15.0, 40.0);
  if (random_.chance(0.3)) return put_beside_a_line();
  pose_ = pose_.to_parent(
      Pose2(Point2(speed_ * std::clamp(seconds, -1.0, 1.0), 0.0), random_.uniform(-0.1, 0.1)));
}

Localization UglyDrive::localization() {
  Localization localization = localization_at(pose_, now_, speed_);
  if (random_.chance(0.1)) localization.stamp += from_seconds(random_.uniform(-1.0, 1.0));
  double* const numbers[] = {&localization.position.x(),
                             &localization.position.y(),
                             &localization.heading,
                             &localization.linear_velocity.x(),
                             &localization.angular_velocity_body.z(),
                             &localization.map_from_body.z()};
  if (random_.chance(0.1)) *numbers[random_.integer(0, 5)] = any_number(random_);
  return localization;
}

UglyInputs UglyDrive::next() {
  UglyInputs inputs;
  inputs.intake = intake_;
  if (lines_.empty() || random_.chance(0.08)) {
    change_lines();
    inputs.lines = lines_;
  }
  if (random_.chance(0.1)) {
    inputs.config = ugly_config(random_);
    intake_ = IntakeParam::of(*inputs.config);
  }
  move_vehicle();
  if (random_.chance(0.9)) inputs.localization = localization();
  if (random_.chance(0.5)) inputs.chassis = Chassis{now_, spoilt(random_, speed_, 0.1)};
  if (random_.chance(0.6)) inputs.markers = ugly_markers(random_, now_);
  return inputs;
}

void UglyDrive::step(RelativeMapPipeline& pipeline) {
  const UglyInputs inputs = next();
  if (inputs.lines) {
    pipeline.set_navigation_lines(prepare_navigation_lines({"map", *inputs.lines}, inputs.intake));
  }
  if (inputs.config) pipeline.set_config(std::make_shared<PipelineConfig>(*inputs.config));
  if (inputs.localization) pipeline.set_localization(*inputs.localization);
  if (inputs.chassis) pipeline.set_chassis(*inputs.chassis);
  if (inputs.markers) pipeline.set_lane_markers(*inputs.markers);
}

}  // namespace relative_map::core::test
