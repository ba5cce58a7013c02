#include "relative_map/prediction/features/history_features.hpp"

namespace relative_map::core {

HistoryFeatures history_features(const RoadUser& user) {
  HistoryFeatures features;
  features.positions.setZero();
  features.steps.setZero();
  const auto& history = user.history();
  const PastPosition& newest = history.back();
  const Pose2 frame(newest.position, user.theta());
  std::size_t next = history.size() - 1;  // the oldest sight that is not older than asked for
  for (int i = 0; i < kHistorySteps; ++i) {
    const double age = kPredictionStep * i;
    const auto age_of = [&](std::size_t k) { return to_seconds(newest.stamp - history[k].stamp); };
    while (next > 0 && age_of(next) < age - 1e-6) --next;
    if (age_of(next) < age - 1e-6) break;  // it was not seen so long ago
    Point2 position = history[next].position;
    if (next + 1 < history.size()) {
      const double older = age_of(next), newer = age_of(next + 1);
      const double share = older > newer ? (age - newer) / (older - newer) : 1.0;
      position = history[next + 1].position + share * (position - history[next + 1].position);
    }
    features.positions.row(i) = frame.to_local(position).transpose();
    if (i > 0) features.steps.row(i) = features.positions.row(i - 1) - features.positions.row(i);
    ++features.given;
  }
  return features;
}

}  // namespace relative_map::core
