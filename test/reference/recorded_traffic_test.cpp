// Prediction of recorded traffic, held against the line through the last moment. The whole figures are those
// of prediction_benchmark; here stands what must never break.
#include <gmock/gmock.h>

#include <filesystem>
#include <map>
#include <random>

#include "reference/reference_data.hpp"
#include "relative_map/io/traffic_scene.hpp"
#include "relative_map/prediction/prediction_check.hpp"
#include "relative_map/prediction/road_user_prediction.hpp"

namespace relative_map::core::test {
namespace {

namespace fs = std::filesystem;

constexpr int kFuture = 50;  // steps of 0.1 s
constexpr int kPast = 10;

struct Means {
  double ours = 0.0, line = 0.0;
  int count = 0, far_off = 0;
};

std::vector<fs::path> scenes() {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::recursive_directory_iterator(*reference_folder() + "/traffic")) {
    if (entry.path().filename() == "lanes.json") folders.push_back(entry.path().parent_path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

/// Plays a scene with noise on the positions and compares at each full second.
class Judge {
 public:
  Judge(const fs::path& folder, double noise, std::map<std::string, Means>& means)
      : scene_(read_traffic_scene(folder.string())),
        source_(folder.parent_path().filename().string()),
        means_(means) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0.0, 1.0);
    for (const SceneSample& sample : scene_.samples) {
      const double dx = normal(random), dy = normal(random);
      const int step = static_cast<int>(std::lround(seconds_since_epoch(sample.stamp) * 10.0));
      truth_[sample.seen.id][step] = sample.seen.position;
      SeenRoadUser seen = sample.seen;
      seen.position += noise * Point2(dx, dy);
      seen.velocity.setConstant(kNotGiven);
      if (!sample.ego) frames_[step].push_back(seen);
      if (!sample.ego) noisy_[seen.id][step] = seen.position;
    }
  }

  void run() {
    RoadUserPrediction prediction{PredictionConfig{}};
    const LaneView lanes(scene_.lanes);
    const EgoVehicle ego;
    for (const auto& [step, users] : frames_) {
      prediction.see({at_seconds(0.1 * step), users}, ego);
      if (step % 10 != 0) continue;
      const Prediction result = prediction.predict(at_seconds(0.1 * step), ego, lanes);
      EXPECT_TRUE(check_prediction(result).empty()) << check_prediction(result).front().what;
      for (const PredictedRoadUser& user : result.users) compare(step, user);
    }
  }

 private:
  void compare(int step, const PredictedRoadUser& user) {
    const auto& track = truth_.at(user.seen.id);
    for (int i = step - kPast; i <= step + kFuture; ++i) {
      if (track.count(i) == 0) return;
    }
    if ((track.at(step) - track.at(step - kPast)).norm() <= 1.0) return;
    Means& means =
        means_[source_ + (user.seen.type == RoadUserType::kPedestrian ? " pedestrians" : " others")];
    // The line through the last second, by least squares.
    Point2 middle = Point2::Zero(), slope = Point2::Zero();
    double squares = 0.0;
    for (int i = -kPast; i <= 0; ++i) middle += noisy_.at(user.seen.id).at(step + i) / (kPast + 1.0);
    for (int i = -kPast; i <= 0; ++i) {
      const double t = 0.1 * (i + 0.5 * kPast);
      slope += t * noisy_.at(user.seen.id).at(step + i);
      squares += t * t;
    }
    slope /= squares;
    const TrajectoryPoint& last = user.trajectories.front().points[kFuture];
    const Point2 truth = track.at(step + kFuture);
    means.ours += (last.position - truth).norm();
    means.line += (middle + (0.05 * kPast + 0.1 * kFuture) * slope - truth).norm();
    ++means.count;
    const Point2 along(std::cos(last.theta), std::sin(last.theta)), error = truth - last.position;
    means.far_off += std::abs(error.dot(along)) > 3.0 * last.sigma_along ||
                     std::abs(cross(along, error)) > 3.0 * last.sigma_across;
  }

  TrafficScene scene_;
  std::string source_;
  std::map<std::string, Means>& means_;
  std::map<int, std::map<int, Point2>> truth_, noisy_;
  std::map<int, std::vector<SeenRoadUser>> frames_;
};

TEST(RecordedTraffic, NoSourceIsPredictedWorseThanByALine) {
  REQUIRE_REFERENCE_DATA();
  for (const double noise : {0.0, 0.2}) {
    std::map<std::string, Means> means;
    for (const fs::path& folder : scenes()) Judge(folder, noise, means).run();
    ASSERT_GE(means.size(), 4u);
    int count = 0, far_off = 0;
    for (const auto& [kind, mean] : means) {
      count += mean.count;
      far_off += mean.far_off;
      if (mean.count < 50) continue;  // too few to tell
      EXPECT_LT(mean.ours, 1.02 * mean.line)
          << kind << ", noise " << noise << ": FDE at 5 s " << mean.ours / mean.count << " m against "
          << mean.line / mean.count;
    }
    EXPECT_LT(far_off, 0.015 * count);
  }
}

}  // namespace
}  // namespace relative_map::core::test
