#include "random_scene.hpp"

#include "relative_map/simulation/paint.hpp"

namespace relative_map::core::test {

RandomDrive::RandomDrive(std::uint64_t seed, const SceneParam& param) : random_(seed), param_(param) {
  make_config();
  make_road();
  make_lines();
  s_ = random_.uniform(0.0, road_.length());
  l_ = random_.uniform(-6.0, 6.0);
  speed_ = random_.uniform(-5.0, 35.0);
}

void RandomDrive::make_config() {
  NavigationLaneParam& lane = config_.navigation_lane;
  const int weight = random_.integer(0, 3);
  lane.lane_marker_weight = weight == 0 ? 0.0 : weight == 1 ? 1.0 : random_.uniform(0.0, 1.0);
  if (random_.chance(0.1)) lane.lane_source = LaneSource::kPerception;
  if (random_.chance(0.3)) lane.max_len_from_navigation_line = random_.uniform(5.0, 400.0);
  if (random_.chance(0.3)) lane.max_lane_half_width = random_.uniform(1.5, 4.0);
  if (random_.chance(0.3)) config_.footprint.half_width = random_.uniform(0.3, 1.4);
  if (random_.chance(0.3)) config_.lane_fusion.method = "fixed_weight";
  if (random_.chance(0.3)) config_.lane_fusion.fade_length = random_.uniform(10.0, 100.0);
  config_.enable_cyclic_rerouting = random_.chance(0.8);
}

void RandomDrive::make_road() {
  const bool map_sized = random_.chance(0.5);
  const Point2 origin = map_sized ? Point2(691191.97, 3118215.55) : Point2::Zero();
  road_ = RoadShape(Pose2(origin, random_.uniform(-kPi, kPi)));
  if (random_.chance(0.15)) {
    road_ = closed_road(Pose2(origin, random_.uniform(-kPi, kPi)));
    return;
  }
  const int pieces = random_.integer(1, 6);
  for (int i = 0; i < pieces; ++i) {
    const double kappa = random_.chance(0.3) ? random_.uniform(-0.06, 0.06) : random_.uniform(-0.01, 0.01);
    if (random_.chance(0.4)) road_.add_straight(random_.uniform(10.0, 200.0));
    road_.add_clothoid(random_.uniform(20.0, 60.0), 0.0, kappa);
    road_.add_arc(random_.uniform(5.0, 0.7 * kPi / std::max(0.01, std::abs(kappa))));
    road_.add_clothoid(random_.uniform(20.0, 60.0), 0.0);
  }
}

void RandomDrive::make_lines() {
  const int lanes = random_.integer(1, 4);
  const double width = random_.uniform(2.2, 4.5), spacing = random_.uniform(0.2, 2.0);
  for (int i = 0; i < lanes; ++i) {
    offsets_.push_back(width * (0.5 * (lanes - 1) - i));
    lines_.push_back(road_.lane(offsets_.back(), spacing, "lane_" + std::to_string(i)));
    lines_.back().priority = static_cast<std::uint32_t>(random_.integer(0, 3));
  }
  if (param_.odd_lines) {
    const int odd = random_.integer(0, 3);
    for (int i = 0; i < odd; ++i) lines_.push_back(odd_line(i));
  }
  if (param_.faults && random_.chance(0.1)) {
    RecordedLine& line = lines_[static_cast<std::size_t>(random_.integer(0, lanes - 1))];
    const auto i = static_cast<std::size_t>(random_.integer(0, static_cast<int>(line.points.size()) - 1));
    (random_.chance(0.5) ? line.points[i].x : line.points[i].theta) = kNaN;
  }
  if (param_.faults && random_.chance(0.1)) lines_.push_back(recording({}, "empty"));
  if (param_.faults && random_.chance(0.1)) lines_.push_back(recording({Point2(1.0, 2.0)}, "point"));
}

/// From one offset to another, cut at either end, at its own spacing.
RecordedLine RandomDrive::odd_line(int number) {
  const double from = random_.uniform(-9.0, 9.0),
               to = random_.chance(0.5) ? from : random_.uniform(-9.0, 9.0);
  const double change_s = random_.uniform(0.0, road_.length()), change = random_.uniform(20.0, 120.0);
  const double start = random_.chance(0.5) ? 0.0 : random_.uniform(0.0, 0.8 * road_.length());
  const double end = random_.chance(0.5) ? road_.length() : random_.uniform(start, road_.length());
  const double noise = random_.chance(0.3) ? random_.uniform(0.0, 0.01) : 0.0;
  const bool thinned = random_.chance(0.3);
  Polyline points;
  for (double s = start; s <= end;) {
    const double t = std::clamp((s - change_s) / change, 0.0, 1.0);
    const double l = from + (to - from) * t * t * (3.0 - 2.0 * t);
    points.push_back(road_.at(s, l).position +
                     noise * Point2(random_.uniform(-1.0, 1.0), random_.uniform(-1.0, 1.0)));
    s += thinned && random_.chance(0.2) ? random_.uniform(0.3, 8.0) : 0.4;
  }
  RecordedLine line =
      recording(points, "odd_" + std::to_string(number), static_cast<std::uint32_t>(random_.integer(0, 5)));
  if (random_.chance(0.1)) std::reverse(line.points.begin(), line.points.end());
  if (random_.chance(0.1) && !lines_.empty()) line = lines_.front();
  return line;
}

void RandomDrive::step(RelativeMapPipeline& pipeline) {
  const double dt = random_.chance(0.1) ? random_.uniform(0.2, 0.7) : 0.1;
  now_ += from_seconds(dt);
  s_ += speed_ * dt;
  if (random_.chance(0.05)) s_ = random_.uniform(-20.0, road_.length() + 20.0);  // a jump
  if (random_.chance(0.05)) l_ = random_.uniform(-20.0, 20.0);
  l_ += random_.uniform(-0.2, 0.2);
  turn_ = random_.chance(0.03) ? random_.uniform(-kPi, kPi) : 0.8 * turn_ + random_.uniform(-0.03, 0.03);
  const PathPoint on_road = road_.at(s_, 0.0);
  const double beyond = s_ - std::clamp(s_, 0.0, road_.length());
  pose_ = Pose2(on_road.position + beyond * on_road.direction + l_ * left_of(on_road.direction),
                normalize_angle(on_road.theta + turn_));

  Localization localization = localization_at(pose_, now_, speed_);
  if (param_.faults && random_.chance(0.02)) localization.position.x() = kNaN;
  if (param_.faults && random_.chance(0.02)) localization.heading = kNaN;
  if (param_.faults && random_.chance(0.02)) localization.angular_velocity_body.setConstant(kNaN);
  if (!param_.faults || !random_.chance(0.03)) pipeline.set_localization(localization);
  if (random_.chance(0.9))
    pipeline.set_chassis({now_, param_.faults && random_.chance(0.02) ? kNaN : speed_});
  if (random_.chance(0.7)) pipeline.set_lane_markers(markers());
}

LaneMarkers RandomDrive::markers() {
  LaneMarkers markers;
  markers.stamp = now_ - from_seconds(random_.chance(0.5) ? 0.0 : random_.uniform(0.0, 0.6));
  if (random_.chance(0.3))
    markers.base_from_sensor = Pose2(Point2(random_.uniform(0.0, 2.5), 0.0), random_.uniform(-0.05, 0.05));
  double center = offsets_.front();
  for (const double offset : offsets_) {
    if (std::abs(offset - l_) < std::abs(center - l_)) center = offset;
  }
  center += random_.uniform(-0.3, 0.3);
  markers.left = paint(center + 1.75);
  markers.right = paint(center - 1.75);
  if (param_.wild_markers && random_.chance(0.2)) {
    markers.left.cubic = wild_cubic();
    markers.right.cubic = markers.left.cubic;
    markers.right.cubic.c0 -= random_.uniform(2.0, 4.5);
    markers.left.view_range = markers.right.view_range = random_.uniform(0.0, 200.0);
    markers.left.longitude_start = markers.right.longitude_start = random_.uniform(-5.0, 30.0);
  }
  if (param_.faults && random_.chance(0.05)) markers.left.cubic.c2 = kNaN;
  if (param_.faults && random_.chance(0.05)) markers.right.quality = kNaN;
  if (param_.faults && random_.chance(0.05)) std::swap(markers.left, markers.right);
  return markers;
}

/// What a camera in the body frame would see of the paint l [m] beside the road.
LaneMarker RandomDrive::paint(double l) {
  Polyline points;
  for (double ahead = 0.0; ahead <= 50.0 && s_ + ahead <= road_.length(); ahead += 2.0) {
    const Point2 point = pose_.to_local(road_.at(s_ + ahead, l).position);
    if (!points.empty() && point.x() < points.back().x() + 1.0) break;
    points.push_back(point);
  }
  if (points.size() < 5) return {};
  LaneMarker seen = marker(fit_cubic(points), points.back().x(), random_.uniform(0.3, 1.0));
  seen.type = static_cast<BoundaryType>(random_.integer(0, 6));
  seen.cubic.c0 += random_.uniform(-0.05, 0.05);
  seen.cubic.c1 += random_.uniform(-0.005, 0.005);
  return seen;
}

Cubic RandomDrive::wild_cubic() {
  return {random_.uniform(-6.0, 6.0), random_.uniform(-0.5, 0.5), random_.uniform(-0.02, 0.02),
          random_.uniform(-2e-4, 2e-4)};
}

}  // namespace relative_map::core::test
