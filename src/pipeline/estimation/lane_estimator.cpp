#include "relative_map/pipeline/estimation/lane_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr double kLongestGap = 2.0;   // [s] between poses that odometry bridges
constexpr double kHoldTime = 1.0;     // [s] without paint until the estimate starts to fade
constexpr double kForgetTime = 60.0;  // [s] without paint until nothing is left worth having
constexpr double kClear = 0.8;        // [-] of the belief in one lane: it is that one
constexpr double kUnclear = 0.6;      // [-] ... and no more
constexpr double kRival = 0.3;        // [-] of the likeliest lane's share: the lane that is followed is kept
constexpr double kShift = 0.7;        // [m] at least, by which the lane is another than thought
constexpr double kAnother = 1.2;  // [m] of paint from the border of the lane that is clear: another border's
constexpr double kOpeningGate = 1.7;   // standard deviations of the lane's width
constexpr double kGate = 30.0;         // squared, in standard deviations: not this lane's paint
constexpr double kOffsetGate = 3.5;    // standard deviations of a marker's mean offset
constexpr double kAgreeBoth = 0.2;     // [s] of paint on both sides until the first is believed
constexpr double kAgreeOne = 0.7;      // [s] ... on one side: outliers last
constexpr double kLongestImage = 0.2;  // [s] that one image can count for
constexpr double kMedian = 3.36;       // of the squared distance of four numbers (chi-squared)
constexpr double kScaleStep = 0.03;    // [-] of the camera's variance, from image to image
constexpr double kLeastScale = 0.5, kMostScale = 30.0;
constexpr double kSwayWay = 150.0;                    // [m] over which the sway is measured
constexpr double kLeastSway = 0.05, kMostSway = 0.5;  // [m]

Point2 normal_of(double heading) {
  return {-std::sin(heading), std::cos(heading)};
}

double sign_of(LaneFilter::Side side) {
  return side == LaneFilter::Side::kLeft ? 1.0 : -1.0;
}

std::string refusal(const char* name, double offset) {
  std::ostringstream reason;
  reason.precision(2);
  reason << name << " is ignored: it is " << offset << " m aside of where this lane's paint is expected";
  return reason.str();
}

}  // namespace

void LaneEstimator::start(const VehicleState& localized) {
  filter_.emplace(noise_, localized, half_width_, sway_);
  last_paint_.reset();
  meter_.lose_bias();
}

void LaneEstimator::move(const VehicleState& localized, const LaneFusionParam& param) {
  if (!last_) {
    last_ = localized;
    return;
  }
  const double dt = to_seconds(localized.stamp - last_->stamp);
  if (!(dt > 0.0)) return;
  max_offset_ = param.max_offset;
  meter_.listen(*last_, localized);
  const double way = 0.5 * (last_->speed + localized.speed) * dt;
  way_ += way;
  seconds_ += dt;
  if (informed()) {
    const bool unseen = to_seconds(localized.stamp - *last_paint_) > kHoldTime;
    filter_->move(*last_, localized, meter_.position_walk(), param.decay_time, unseen);
    filter_->localize(localized, meter_.position_stddev(), meter_.heading_stddev());
    paint_range_ = std::max(0.0, paint_range_ - way);
    beyond_.move(way, dt);
    const bool forgotten = to_seconds(localized.stamp - *last_paint_) > kForgetTime;
    const double offset = std::max(filter_->state().segment<2>(LaneFilter::kBiasX).norm(),
                                   std::abs(filter_->lateral(normal_).value));
    if (offset > param.max_offset) {
      std::ostringstream why;
      why.precision(3);
      why << "the lane seemed to be " << offset << " m from where localization puts it: not believed";
      given_up_ = why.str();
    }
    if (forgotten || dt > kLongestGap || !filter_->sound() || offset > param.max_offset) {
      forget_place();
    }
  }
  last_ = localized;
}

void LaneEstimator::doubt_motion() {
  forget_place();
  // What was measured by it, too.
  meter_ = LocalizationNoiseMeter(noise_.localization);
  sway_ = noise_.road.sway;
  image_scale_ = 1.0;
}

void LaneEstimator::forget_place() {
  filter_.reset();
  which_.reset();
  agreed_ = way_ = seconds_ = 0.0;
}

void LaneEstimator::follow_line(const NavigationLine& line, const LineProjection& projection,
                                const std::vector<double>& others) {
  if (!last_) return;
  const VehicleState vehicle = corrected(*last_);
  const double line_heading = vehicle.map_from_base.heading() - projection.heading_offset;
  normal_ = normal_of(line_heading);
  const double sideways = way_ * std::sin(0.5 * (projection.heading_offset + heading_offset_));
  const double localized =
      projection.l + normal_.dot(last_->map_from_base.position() - vehicle.map_from_base.position());
  road_.centers = others;
  road_.centers.push_back(0.0);
  if (informed()) {
    road_.half_width = filter_->half_width().value;
    road_.half_width_stddev = filter_->half_width().stddev;
  } else {
    road_.half_width = half_width_;
    road_.half_width_stddev = noise_.road.half_width;
  }
  if (line.id != line_id_ && which_.started()) which_.change_line(line_l_ + sideways - projection.l);
  if (which_.started()) {
    which_.move(sideways, std::hypot(0.1 * std::sqrt(seconds_), 0.02 * way_), localized);
  } else {
    which_.start(road_, localized);
  }
  line_id_ = line.id;
  line_l_ = projection.l;
  heading_offset_ = projection.heading_offset;
  way_ = seconds_ = 0.0;
  if (!informed()) start(*last_);
  filter_->follow(line, projection.s);
}

std::vector<std::string> LaneEstimator::see(const SeenSides& sides, const NavigationLine& line,
                                            const LineProjection& projection, Time stamp) {
  if (!last_ || !filter_) return {};
  if (frozen_.look(sides.unchanged, last_->map_from_base, line, projection.nearest_vertex)) {
    const std::string why = "they are frozen: the numbers stay the same while the line beside them moves";
    if (informed()) {  // they have led it astray
      start(*last_);
      filter_->follow(line, projection.s);
      agreed_ = 0.0;
      given_up_ = why;
    }
    return {why};
  }
  const double seconds =
      last_image_ ? std::clamp(to_seconds(stamp - *last_image_), 0.0, kLongestImage) : kLongestImage;
  last_image_ = stamp;
  std::array<SeenSide, 2> seen = assign(sides, line, projection);
  find_lane(seen, line, projection, seconds);
  std::vector<std::string> ignored;
  if (!lane_clear_) {
    ignored.push_back("which lane the vehicle is in is not clear yet");
    agreed_ = 0.0;
    return ignored;
  }
  if (!informed()) {
    bool all = true;
    int count = 0;
    for (const SeenSide& one : seen) {
      if (!one.measurement) continue;
      ++count;
      if (!fits(one)) {
        all = false;
        ignored.push_back(refusal(one.name, one.measurement->near_offset()));
      }
    }
    agreed_ = all ? agreed_ + seconds : 0.0;
    if (agreed_ < (count == 2 ? kAgreeBoth : kAgreeOne)) return ignored;
  }
  const auto distance = [](const SeenSide& one) {
    return one.measurement ? one.measurement->squared_distance : std::numeric_limits<double>::max();
  };
  if (distance(seen[1]) < distance(seen[0])) std::swap(seen[0], seen[1]);
  bool any = false;
  const bool opens = is_opening(seen);
  for (SeenSide& one : seen) {
    if (any && opens) {
      ignored.push_back(refusal(one.name, one.measurement->near_offset()));
      break;
    }
    if (any) measure(one, line, projection);  // the surer side has moved the state
    if (!one.measurement) continue;
    const double scale = std::exp(one.measurement->squared_distance > kMedian ? kScaleStep : -kScaleStep);
    image_scale_ = std::clamp(image_scale_ * scale, kLeastScale, kMostScale);
    if (!fits(one)) {
      ignored.push_back(refusal(one.name, one.measurement->near_offset()));
      continue;
    }
    filter_->correct(*one.measurement);
    if (!any) left_paint_ = right_paint_ = BoundaryType::kUnknown;
    (one.side == Side::kLeft ? left_paint_ : right_paint_) = one.paint->type;
    paint_range_ = any ? std::max(paint_range_, one.paint->to) : one.paint->to;
    any = true;
  }
  if (!filter_->sound()) {
    filter_.reset();
  } else if (any) {
    last_paint_ = stamp;
    given_up_.clear();
    beyond_.see_nothing();
    see_beyond(sides.next_left, Side::kLeft, line, projection.nearest_vertex, stamp);
    see_beyond(sides.next_right, Side::kRight, line, projection.nearest_vertex, stamp);
    const Estimate lateral = filter_->lateral(normal_);
    meter_.see_bias(stamp, normal_, filter_->state().segment<2>(LaneFilter::kBiasX), lateral.stddev);
    learn_sway(std::abs(last_->speed) * seconds);
  }
  return ignored;
}

/// Holds the paint against the lanes that there are, and moves the filter to the one that the vehicle is in.
void LaneEstimator::find_lane(std::array<SeenSide, 2>& seen, const NavigationLine& line,
                              const LineProjection& projection, double seconds) {
  LineWalker walker(line, projection.nearest_vertex);
  const BesideLine beside = walker.beside(filter_->pose().position() - line.origin);
  if (!beside.exists) return;
  const double offset = beside.lateral - filter_->offsets().at(filter_->knots_at(line, beside.s));
  std::array<std::optional<WhichLane::Seen>, 2> paint;
  for (const SeenSide& one : seen) {
    if (!one.measurement) continue;
    const LaneFilter::Measurement& m = *one.measurement;
    const double there = m.innovation[0] + sign_of(one.side) * filter_->half_width().value - offset;
    paint[one.name == std::string("left") ? 0 : 1] = WhichLane::Seen{there, std::sqrt(m.covariance(0, 0))};
  }
  which_.see(paint[0], paint[1], seconds, road_);
  const WhichLane::Place place = which_.likeliest();
  lane_clear_ = which_.share_alike(place, road_) > (lane_clear_ ? kUnclear : kClear);
  const double gap = place.offset - offset;
  if (!lane_clear_ || std::abs(gap) < kShift || std::abs(gap) > max_offset_) return;
  // A second or two of wrong paint is not enough to leave the lane that is followed.
  if (informed() && which_.share_near(offset) > kRival * place.share) return;
  filter_->shift(beside.normal, gap, std::hypot(place.stddev, 0.3));
  meter_.lose_bias();
  for (SeenSide& one : seen) measure(one, line, projection);
}

/// Whether the sides lie farther apart than they should: the lane opens into a second one. Its center stays
/// with the side that has moved less.
bool LaneEstimator::is_opening(const std::array<SeenSide, 2>& seen) const {
  if (!seen[0].measurement || !seen[1].measurement) return false;
  const double sign = sign_of(seen[0].side);
  const LaneFilter::Measurement &a = *seen[0].measurement, &b = *seen[1].measurement;
  const auto apart = a.jacobian.row(0) - b.jacobian.row(0);
  const double variance =
      apart * filter_->covariance() * apart.transpose() + a.covariance(0, 0) + b.covariance(0, 0);
  const double wider = sign * (a.near_offset() - b.near_offset());
  return wider > 0.0 && wider * wider > kOpeningGate * kOpeningGate * variance;
}

bool LaneEstimator::fits(const SeenSide& one) const {
  if (!informed() && std::abs(one.measurement->near_offset()) > max_offset_) return false;
  return one.measurement->squared_distance < kGate && std::abs(one.measurement->near_offset()) < kAnother &&
         std::abs(one.measurement->near_offset()) < kOffsetGate * one.measurement->near_stddev();
}

void LaneEstimator::measure(SeenSide& one, const NavigationLine& line,
                            const LineProjection& projection) const {
  one.measurement.reset();
  if (one.paint) {
    one.measurement = filter_->measure(*one.paint, one.side, line, projection.nearest_vertex, image_scale_);
  }
}

std::array<LaneEstimator::SeenSide, 2> LaneEstimator::assign(const SeenSides& sides,
                                                             const NavigationLine& line,
                                                             const LineProjection& projection) const {
  std::array<SeenSide, 2> seen{SeenSide{Side::kLeft, "left", sides.left, {}},
                               SeenSide{Side::kRight, "right", sides.right, {}}};
  for (SeenSide& one : seen) measure(one, line, projection);
  // Beside a border the camera and the map may not be of one mind yet on which lane the vehicle is in: the
  // lane's left border may be on the right of the camera already, and the other way round.
  constexpr double kNearEdge = 0.5, kSameBorder = 0.6;  // [m]
  const double half_width = filter_->half_width().value;
  const double to_left = std::abs(half_width - projection.l), to_right = std::abs(half_width + projection.l);
  if (std::min(to_left, to_right) < kNearEdge) {
    const bool at_left = to_left < to_right;
    SeenSide &border = seen[at_left ? 0 : 1], &beyond = seen[at_left ? 1 : 0];
    SeenSide crossed{border.side, beyond.name, beyond.paint, {}};
    measure(crossed, line, projection);
    const double offset = crossed.measurement ? std::abs(crossed.measurement->near_offset()) : kSameBorder;
    if (offset < kSameBorder &&
        !(border.measurement && std::abs(border.measurement->near_offset()) < offset)) {
      border = crossed;
      beyond.paint.reset();
      beyond.measurement.reset();
    }
  }
  return seen;
}

void LaneEstimator::see_beyond(const std::optional<PaintSamples>& paint, Side side,
                               const NavigationLine& line, std::size_t vertex, Time stamp) {
  const auto measurement = paint ? filter_->measure(*paint, side, line, vertex, image_scale_) : std::nullopt;
  if (!measurement) return;
  // Measured as if it were the lane's own border: what it is off by is the width of the lane beyond.
  const double own = filter_->half_width().value, distance = own + sign_of(side) * measurement->near_offset();
  beyond_.see(side == Side::kLeft ? beyond_.left : beyond_.right, stamp, distance,
              measurement->covariance(0, 0), own, paint->to, paint->type);
}

/// How far recordings sway: by the knots that have just been seen best.
void LaneEstimator::learn_sway(double way) {
  constexpr int kPassed = LaneFilter::kFirstKnot + 1;  // at the vehicle
  const double seen =
      filter_->state()[kPassed] * filter_->state()[kPassed] + filter_->covariance()(kPassed, kPassed);
  const double share = std::min(1.0, way / kSwayWay);
  const double variance = sway_ * sway_ + share * (std::min(seen, 9.0 * sway_ * sway_) - sway_ * sway_);
  sway_ = std::clamp(std::sqrt(variance), kLeastSway, kMostSway);
  filter_->set_sway(sway_);
}

VehicleState LaneEstimator::corrected(const VehicleState& localized) const {
  if (!informed()) return localized;
  VehicleState state = localized;
  const Pose2 pose = filter_->pose();
  state.map_from_base = Pose2(pose.position(), normalize_angle(pose.heading()));
  return state;
}

bool LaneEstimator::apply(const NavigationLine& line, const LineProjection& projection,
                          double least_half_width, LanePath& lane) const {
  if (!informed() || lane.id != filter_->line_id()) return false;
  lane.left_half_width = lane.right_half_width = std::max(least_half_width, filter_->half_width().value);
  lane.seen = {lane.left_half_width, lane.right_half_width, lane.s_at_vehicle + paint_range_};
  const LaneFilter::Offsets offsets = filter_->offsets();
  const double start = filter_->knots_at(line, projection.s) - lane.s_at_vehicle / OffsetProfile::kSpacing;
  for (PathPoint& point : lane.points) {
    point.position += offsets.at(start + point.s / OffsetProfile::kSpacing) * left_of(point.direction);
  }
  compute_arc_length(lane.points);
  compute_geometry(lane.points);
  locate_vehicle(lane);
  return true;
}

void LaneEstimator::apply_beside(std::vector<LanePath>& lanes, std::size_t current) const {
  if (!informed() || lanes[current].id != filter_->line_id() || !lanes[current].seen) return;
  beyond_.apply(lanes, current, last_->stamp);
}

FusionState LaneEstimator::state(const LineProjection& projection, double heading) const {
  FusionState state;
  if (!informed()) return state;
  state.method = "estimator";
  const Point2 left = normal_of(heading - projection.heading_offset), along(left.y(), -left.x());
  const auto& x = filter_->state();
  const auto& p = filter_->covariance();
  const Eigen::Matrix2d place = p.block<2, 2>(LaneFilter::kX, LaneFilter::kX);
  state.lateral_offset = filter_->lateral(left);
  state.longitudinal_offset = {-along.dot(x.segment<2>(LaneFilter::kBiasX)),
                               std::sqrt(along.dot(place * along))};
  state.heading_offset = {x[LaneFilter::kBiasHeading],
                          std::sqrt(p(LaneFilter::kHeading, LaneFilter::kHeading))};
  state.left_half_width = state.right_half_width = filter_->half_width();
  return state;
}

}  // namespace relative_map::core
