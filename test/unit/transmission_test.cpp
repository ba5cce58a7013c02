// Messages arrive as late and as seldom as they are asked to.
#include "relative_map/simulation/transmission.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace relative_map::core {
namespace {

using std::chrono::milliseconds;

TEST(Transmission, ByDefaultAMessageArrivesAtOnceAndOnce) {
  Transmission transmission(TransmissionParam(), 1, 1);
  for (int i = 0; i < 100; ++i) {
    const Time stamp(milliseconds(20) * i);
    EXPECT_EQ(transmission.arrivals(stamp), std::vector<Time>{stamp});
  }
}

TEST(Transmission, SharesAreWhatIsAskedFor) {
  TransmissionParam param;
  param.lost = 0.05;
  param.repeated = 0.1;
  Transmission transmission(param, 1, 1);
  int lost = 0, repeated = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto arrivals = transmission.arrivals(Time(milliseconds(20) * i));
    if (arrivals.empty()) ++lost;
    if (arrivals.size() == 2) ++repeated;
  }
  EXPECT_NEAR(lost / 20000.0, 0.05, 0.005);
  EXPECT_NEAR(repeated / 20000.0, 0.095, 0.007);
}

TEST(Transmission, UnsteadyLatencyKeepsTheOrderAndOnlyLateOnesAreOvertaken) {
  TransmissionParam param;
  param.min_latency = 0.06;
  param.max_latency = 0.25;
  const auto overtaken = [&] {
    Transmission transmission(param, 3, 1);
    Time last{};
    int count = 0;
    for (int i = 0; i < 5000; ++i) {
      const Time stamp(milliseconds(50) * i), arrival = transmission.arrivals(stamp).front();
      EXPECT_GE(arrival, stamp + milliseconds(60));
      EXPECT_LE(arrival, stamp + milliseconds(250) + from_seconds(param.late_by));
      if (arrival < last) ++count;
      last = std::max(last, arrival);
    }
    return count;
  };
  EXPECT_EQ(overtaken(), 0);
  param.late = 0.05;
  param.late_by = 0.5;
  EXPECT_GT(overtaken(), 100);
}

}  // namespace
}  // namespace relative_map::core
