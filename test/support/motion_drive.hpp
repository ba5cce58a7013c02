#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "relative_map/model/inputs.hpp"

namespace relative_map::core::test {

/// A vehicle that is driven by speed and curvature, and what a localization makes of it.
struct MotionDrive {
  std::function<double(double)> speed = [](double) { return 10.0; };  ///< [m/s] by time [s], negative: back
  std::function<double(double)> curvature = [](double) { return 0.0; };  ///< [1/m] by time
  std::function<double(double)> slip = [](double) { return 0.0; };  ///< [rad] of the heading to the course
  double rate = 50.0;                                               ///< [Hz] of poses
  double heading = 0.3;                                             ///< [rad] at the start
  double position_noise = 0.02, heading_noise = 0.003;              ///< [m], [rad] white
  Point2 drift = Point2::Zero();                                    ///< [m/s] of localization
  std::vector<std::pair<double, Point2>> jumps;                     ///< [s], [m]
  std::uint64_t seed = 1;

  struct Moment {
    double t = 0.0;
    Pose2 truth;
    double speed = 0.0;
    Localization localization;  ///< heading and orientation right but for noise
  };
  std::vector<Moment> drive(double seconds) const {
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> noise;
    std::vector<Moment> moments;
    constexpr double kStep = 0.002;
    Point2 place(1234.5, -987.0);
    double course = heading, next = 0.0;
    for (double t = 0.0; t < seconds; t += kStep) {
      const double v = speed(t), turn = v * curvature(t) * kStep;
      if (t >= next) {
        next += 1.0 / rate;
        Moment moment;
        moment.t = t;
        moment.speed = v;
        moment.truth = Pose2(place, course + slip(t));
        Point2 seen = place + t * drift + position_noise * Point2(noise(engine), noise(engine));
        for (const auto& [when, jump] : jumps) {
          if (t >= when) seen += jump;
        }
        const double yaw = moment.truth.heading() + heading_noise * noise(engine);
        Localization& message = moment.localization;
        message.stamp = at_seconds(1000.0 + t);
        message.position << seen, 0.0;
        message.heading = normalize_angle(yaw);
        message.map_from_body = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
        message.linear_velocity << v * std::cos(course), v * std::sin(course), 0.0;
        message.angular_velocity_body.z() = v * curvature(t) + (slip(t) - slip(t - kStep)) / kStep;
        moments.push_back(moment);
      }
      place += v * kStep * Point2(std::cos(course + 0.5 * turn), std::sin(course + 0.5 * turn));
      course += turn;
    }
    return moments;
  }
};

}  // namespace relative_map::core::test
