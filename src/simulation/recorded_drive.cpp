#include "relative_map/simulation/recorded_drive.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "relative_map/simulation/random_process.hpp"

namespace relative_map::core {

namespace {

constexpr Time kStart(std::chrono::seconds(1000));
constexpr Duration kTruthPeriod = std::chrono::milliseconds(10);

/// Something that is done again and again.
struct Beat {
  Duration period;
  Duration due;
};

Beat random_beat(std::mt19937_64& engine, const TransmissionParam& param) {
  std::uniform_real_distribution<double> rate(param.min_rate, param.max_rate), phase(0.0, 1.0);
  const double period = 1.0 / rate(engine);
  return {from_seconds(period), from_seconds(period * phase(engine))};
}

TruePose true_pose(const VehicleSimulation& vehicle, Time now) {
  const Pose2 pose = vehicle.map_from_base();
  return {now, Pose2(pose.position() - vehicle.path().origin, pose.heading()), vehicle.s(), vehicle.l()};
}

/// Spoils all the markers of a drive in one way.
class Spoiler {
 public:
  explicit Spoiler(const AccuracyScene& scene)
      : fault_(scene.marker_fault), lane_width_(2.0 * scene.lanes.front().half_width) {}

  void spoil(LaneMarkers& markers) {
    if (fault_ == MarkerFault::kLaneOff) {
      for (LaneMarker* marker : {&markers.left, &markers.right}) marker->cubic.c0 += lane_width_;
    } else if (fault_ == MarkerFault::kMirrored) {
      std::swap(markers.left, markers.right);
    } else if (fault_ == MarkerFault::kFrozen) {
      if (!first_) first_ = markers;
      const Time stamp = markers.stamp;
      markers = *first_;
      markers.stamp = stamp;
    } else if (fault_ == MarkerFault::kFuture) {
      markers.stamp += std::chrono::seconds(1);
    }
  }

 private:
  MarkerFault fault_;
  double lane_width_;  ///< [m]
  std::optional<LaneMarkers> first_;
};

}  // namespace

TruePose RecordedDrive::truth_at(Time stamp) const {
  const auto after = std::upper_bound(truth.begin() + 1, truth.end() - 1, stamp,
                                      [](Time time, const TruePose& pose) { return time < pose.stamp; });
  const TruePose &a = *(after - 1), &b = *after;
  const double weight = std::clamp(to_seconds(stamp - a.stamp) / to_seconds(b.stamp - a.stamp), 0.0, 1.0);
  double ds = b.s - a.s;
  if (road.path.ends == Ends::kClosed) ds = std::remainder(ds, road.path.length());
  const Pose2 &from = a.path_from_base, &to = b.path_from_base;
  return {stamp,
          Pose2(from.position() + weight * (to.position() - from.position()),
                interpolate_angle(from.heading(), to.heading(), weight)),
          road.path.hold(a.s + weight * ds), a.l + weight * (b.l - a.l)};
}

RecordedDrive record_drive(const AccuracyScene& scene) {
  VehicleSimulation vehicle(scene.reference, scene.vehicle);
  RecordedDrive drive;
  drive.road = {vehicle.path(), scene.lanes, scene.vehicle.paint.lines, scene.end_s};
  drive.navigation = {"map", scene.lines};
  drive.start = kStart;
  drive.end = kStart + from_seconds(scene.duration);

  std::mt19937_64 engine = random_engine(scene.vehicle.seed, 70);
  Beat truth{kTruthPeriod, Duration::zero()};
  const SensorTransmission& sensors = scene.transmission;
  Beat localization = random_beat(engine, sensors.localization),
       chassis = random_beat(engine, sensors.chassis), markers = random_beat(engine, sensors.markers);
  const std::uint64_t seed = scene.vehicle.seed;
  Transmission localizations(sensors.localization, seed, 71), speeds(sensors.chassis, seed, 72),
      images(sensors.markers, seed, 73);
  const auto deliver = [&](const auto& message, const std::vector<Time>& arrivals) {
    for (const Time arrival : arrivals) {
      drive.deliveries.emplace_back();
      drive.deliveries.back().time = arrival;
      drive.deliveries.back().message.emplace<std::decay_t<decltype(message)>>(message);
    }
  };
  const Duration duration = from_seconds(scene.duration);
  Spoiler spoiler(scene);
  Time last_marker_message = kStart;
  for (;;) {
    Beat* next = std::min({&truth, &localization, &chassis, &markers},
                          [](const Beat* a, const Beat* b) { return a->due < b->due; });
    if (next->due > duration) break;
    vehicle.step(to_seconds(next->due - vehicle.time()));
    const Time now = kStart + vehicle.time();
    next->due += next->period;
    if (drive.truth.empty() || drive.truth.back().stamp < now) drive.truth.push_back(true_pose(vehicle, now));
    if (next == &localization) {
      Localization message = vehicle.measure_localization();
      message.stamp = now;
      deliver(message, localizations.arrivals(now));
    } else if (next == &chassis) {
      Chassis message = vehicle.measure_chassis();
      message.stamp = now;
      deliver(message, speeds.arrivals(now));
    } else if (next == &markers) {
      LaneMarkers message = vehicle.measure_lane_markers();
      message.stamp = now;
      spoiler.spoil(message);
      // One camera's messages do not overtake each other.
      last_marker_message = std::max(last_marker_message, now + vehicle.marker_latency());
      deliver(message, images.arrivals(last_marker_message));
    }
  }
  std::stable_sort(drive.deliveries.begin(), drive.deliveries.end(),
                   [](const Delivery& a, const Delivery& b) { return a.time < b.time; });
  return drive;
}

}  // namespace relative_map::core
