#include "relative_map/prediction/selection_table.hpp"

#include <gmock/gmock.h>

#include "support/traffic.hpp"

namespace relative_map::core::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(SelectionTable, PresetsServeEverybodyEverywhere) {
  for (const std::string preset : {"default", "navi"}) {
    PredictionConfig config;
    config.selection = preset;
    const SelectionTable table(config);
    for (const RoadUserType type :
         {RoadUserType::kUnknown, RoadUserType::kUnknownMovable, RoadUserType::kPedestrian,
          RoadUserType::kUnknownUnmovable, RoadUserType::kBicycle, RoadUserType::kVehicle}) {
      for (const Surrounding where :
           {Surrounding::kOnLane, Surrounding::kOffLane, Surrounding::kInteractive}) {
        EXPECT_NE(table.find(type, where).predictor, "") << preset;
        EXPECT_NE(table.find(type, where).evaluator, "") << preset;
      }
    }
    EXPECT_EQ(table.find(RoadUserType::kVehicle, Surrounding::kOnLane).predictor,
              preset == "navi" ? "single_lane" : "move_sequence");
  }
}

TEST(SelectionTable, ARowThatIsSetTakesThePlaceOfThePresets) {
  PredictionConfig config;
  config.vehicle.interactive_predictor = "interaction";
  config.bicycle.on_lane = {"cost", "lane_sequence"};
  config.pedestrian.off_lane.predictor = "regional";
  ASSERT_THAT(config.validate(), IsEmpty());
  const SelectionTable table(config);
  EXPECT_EQ(table.find(RoadUserType::kVehicle, Surrounding::kInteractive).predictor, "interaction");
  EXPECT_EQ(table.find(RoadUserType::kVehicle, Surrounding::kOnLane).predictor, "move_sequence");
  EXPECT_EQ(table.find(RoadUserType::kBicycle, Surrounding::kOnLane).evaluator, "cost");
  EXPECT_EQ(table.find(RoadUserType::kBicycle, Surrounding::kOnLane).predictor, "lane_sequence");
  // What is set for the lane holds for those that interact on it, too.
  EXPECT_EQ(table.find(RoadUserType::kBicycle, Surrounding::kInteractive).predictor, "lane_sequence");
  EXPECT_EQ(table.find(RoadUserType::kPedestrian, Surrounding::kOffLane).predictor, "regional");
  EXPECT_EQ(table.find(RoadUserType::kUnknown, Surrounding::kOffLane).predictor, "free_move");
}

TEST(SelectionTable, ARowIsWhatPredicts) {
  PredictionConfig config;
  config.pedestrian.off_lane.predictor = "regional";
  Watch usual, regional(config);
  const Traffic walks = [](double t) {
    return std::vector<SeenRoadUser>{seen(1, 1.3 * t, 0.0, 0.0, RoadUserType::kPedestrian)};
  };
  usual.watch(walks, 0.0, 2.0);
  regional.watch(walks, 0.0, 2.0);
  EXPECT_EQ(user_of(usual.predict(), 1).trajectories.size(), 1u);
  EXPECT_EQ(user_of(regional.predict(), 1).trajectories.size(), 3u);
}

TEST(SelectionTable, WhatCannotBeRunIsRefusedAndSaysWhatIsMissing) {
  for (const std::string name : {"semantic_lstm", "vectornet", "jointly", "multi_agent", "junction_map"}) {
    PredictionConfig config;
    config.vehicle.on_lane.evaluator = name;
    EXPECT_THAT(config.validate(), Contains(AllOf(HasSubstr("services/vehicle/on_lane/evaluator is '" + name),
                                                  HasSubstr("weights"))));
    EXPECT_THROW(RoadUserPrediction{config}, std::invalid_argument);
  }
  PredictionConfig config;
  config.unknown.off_lane = {"guess", "dream"};
  config.bicycle.on_lane.evaluator = "mlp";
  EXPECT_THAT(config.validate(), Contains(HasSubstr("services/unknown/off_lane/evaluator is 'guess'")));
  EXPECT_THAT(config.validate(), Contains(HasSubstr("services/unknown/off_lane/predictor is 'dream'")));
  EXPECT_THAT(config.validate(), Contains(HasSubstr("network names no file")));
}

}  // namespace
}  // namespace relative_map::core::test
