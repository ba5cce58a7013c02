#include "relative_map/prediction/network.hpp"

#include <gmock/gmock.h>

#include "relative_map/prediction/evaluators/mlp_evaluator.hpp"
#include "support/traffic.hpp"

namespace relative_map::core::test {
namespace {

using testing::HasSubstr;

// By hand: ((3 - 1) / 2, (5 - 1) / 4) = (1, 1); hidden (1 + 2 + 0.5, relu(-1 - 1 + 0)) = (3.5, 0); 2 * 3.5 -
// 1 = 6.
const char* const kDense = R"(relative_map_network 1   # by hand
features 2 a b
mean 1 1
deviation 2 4
dense 2 2 relu
1 2 0.5
-1 -1 0
dense 2 1 linear
2 7 -1
golden_input 3 5
golden_output 6
)";

std::string fault_of(const std::string& text) {
  try {
    Network::parse(text, "weights.txt", {"a", "b"});
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "";
}

std::string with(const std::string& old_part, const std::string& new_part) {
  std::string text = kDense;
  return text.replace(text.find(old_part), old_part.size(), new_part);
}

TEST(Network, DenseLayersAreAsComputedByHand) {
  const Network network = Network::parse(kDense, "weights.txt", {"a", "b"});
  EXPECT_EQ(network.outputs(), 1);
  EXPECT_NEAR(network.run(Eigen::Vector2d(3.0, 5.0))[0], 6.0, 1e-12);
  EXPECT_NEAR(network.run(Eigen::Vector2d(1.0, 1.0))[0], 0.0, 1e-12);
  // (0, -2): hidden (-3.5 -> 0, 2).
  EXPECT_NEAR(network.run(Eigen::Vector2d(1.0, -7.0))[0], 13.0, 1e-12);
}

TEST(Network, AConvolutionGoesOverEachChannel) {
  // Two channels of four values, kernel 2, stride 2: sums of the first channel's pairs less the second's
  // first ones.
  const Network network = Network::parse(
      "relative_map_network 1 features 8 a b c d e f g h mean 0 0 0 0 0 0 0 0 deviation 1 1 1 1 1 1 1 1\n"
      "conv1d 2 1 2 2 linear  1 1 -1 0 0.25\n"
      "golden_input 1 2 3 4 5 6 7 8 golden_output -1.75 0.25",
      "weights.txt", {"a", "b", "c", "d", "e", "f", "g", "h"});
  Eigen::VectorXd input(8);
  input << 0, 0, 1, 0, 0, 0, 0, 9;
  EXPECT_NEAR(network.run(input)[0], 0.25, 1e-12);
  EXPECT_NEAR(network.run(input)[1], 1.25, 1e-12);
}

TEST(Network, ActivationsAreWhatTheirNamesSay) {
  for (const auto& [name, expected] :
       std::map<std::string, std::string>{{"tanh", "0.9640276"}, {"sigmoid", "0.8807971"}, {"relu", "2"}}) {
    const Network network =
        Network::parse("relative_map_network 1 features 1 a mean 0 deviation 1 dense 1 1 " + name +
                           " 1 0 golden_input 2 golden_output " + expected,
                       "weights.txt", {"a"});
    EXPECT_NEAR(network.run(Eigen::VectorXd::Constant(1, 2.0))[0], std::stod(expected), 1e-6) << name;
  }
}

TEST(Network, WhatDoesNotFitIsRefusedByName) {
  EXPECT_THAT(fault_of(with("golden_output 6", "golden_output 6.01")),
              HasSubstr("weights.txt: the network is refused: its golden"));
  EXPECT_THAT(fault_of(with("a b", "b a")), HasSubstr("its feature 1 is 'b'"));
  EXPECT_THAT(fault_of(with("deviation 2 4", "deviation 2 0")), HasSubstr("not above 0"));
  EXPECT_THAT(fault_of(with("dense 2 1", "dense 3 1")), HasSubstr("takes 3 values, and gets 2"));
  EXPECT_THAT(fault_of(with("0.5", "nan")), HasSubstr("'nan' in a bias is no number"));
  EXPECT_THAT(fault_of(with("relu", "softplus")), HasSubstr("'softplus' is no activation"));
  EXPECT_THAT(fault_of(with("golden_output 6\n", "golden_output")),
              HasSubstr("it ends where golden_output is due"));
  EXPECT_THAT(fault_of(with("dense 2 2", "dense 2 99999999")), HasSubstr("not fit"));
  EXPECT_THAT(fault_of(std::string(kDense) + "more"), HasSubstr("after its end"));
  EXPECT_THAT(fault_of(""), HasSubstr("it ends"));
  EXPECT_EQ(fault_of(kDense), "");
}

TEST(MlpEvaluator, SetsOddsFromItsNetwork) {
  // Logit = -|offset| as relu(-x) + relu(x), by hand; the other features have no weight.
  std::string text = "relative_map_network 1 features 9";
  for (const std::string& feature : way_features()) text += " " + feature;
  text +=
      " mean 0 0 0 0 0 0 0 0 0 deviation 1 1 1 1 1 1 1 1 1 dense 9 2 relu 1 0 0 0 0 0 0 0 0 0 -1 0 0 0 0 0 0 "
      "0 0 0";
  text += " dense 2 1 linear -1 -1 0 golden_input -2 0 0 0 0 0 0 0 0 golden_output -2";
  const auto network = std::make_shared<const Network>(Network::parse(text, "weights.txt", way_features()));
  PredictionConfig config;
  config.vehicle.on_lane.evaluator = "mlp";
  config.network = "weights.txt";
  EXPECT_THROW(RoadUserPrediction{config}, std::invalid_argument);
  RoadUserPrediction prediction(config, network);
  const LaneView lanes(two_lanes());
  EgoVehicle ego;
  for (int i = 0; i <= 20; ++i) prediction.see({at_seconds(0.1 * i), {seen(1, 20.0 + i, 1.0)}}, ego);
  const Prediction result = prediction.predict(at_seconds(2.0), ego, lanes);
  // exp(-1) against exp(-2.5)
  EXPECT_NEAR(probability_of(user_of(result, 1), "right"), 1.0 / (1.0 + std::exp(-1.5)), 0.02);
}

}  // namespace
}  // namespace relative_map::core::test
