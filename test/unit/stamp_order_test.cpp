#include "relative_map/pipeline/motion/stamp_order.hpp"

#include <gmock/gmock.h>

namespace relative_map::core {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kMaxAge = 0.5;  // [s]

/// An input at some rate, and the clock by which its messages come.
struct Input {
  double period = 0.1;    ///< [s]
  double latency = 0.02;  ///< [s]
  double now = 1000.0;    ///< [s]
  double offset = 0.0;    ///< [s] of the sender's clock
  StampOrder order{"localization"};

  StampOrder::Verdict with_stamp(double stamp) {
    return order.judge(at_seconds(stamp), at_seconds(now), kMaxAge);
  }
  StampOrder::Verdict next() {
    now += period;
    return with_stamp(now - latency + offset);
  }
  /// How many of the next messages are taken.
  int taken(int messages) {
    int count = 0;
    for (int i = 0; i < messages; ++i) count += next().take;
    return count;
  }
  /// A stray one between two of them.
  void expect_dropped(double stamp, const std::string& words) {
    EXPECT_EQ(taken(5), 5);
    const StampOrder::Verdict verdict = with_stamp(stamp);
    EXPECT_FALSE(verdict.take) << stamp;
    EXPECT_FALSE(verdict.went_back);
    EXPECT_THAT(verdict.remark, HasSubstr("localization: header.stamp is " + words));
    EXPECT_THAT(verdict.remark, HasSubstr(": dropped"));
    for (int i = 0; i < 5; ++i) {
      const StampOrder::Verdict after = next();
      EXPECT_TRUE(after.take && !after.went_back) << stamp;
      EXPECT_THAT(after.remark, IsEmpty());
    }
  }
};

TEST(StampOrder, AStrayMessageIsDroppedAndTold) {
  for (const double period : {0.01, 0.1, 0.25}) {
    Input input;
    input.period = period;
    input.expect_dropped(input.now + 5 * period - 0.02, "that of the message before");
    input.expect_dropped(input.now - 0.6, "");
    input.expect_dropped(input.now + 0.4 + 5 * period, "0.42 s further ahead than those before");
    input.expect_dropped(0.5, "");
    input.expect_dropped(2e9, "");
    input.expect_dropped(input.now + 5 * period + 0.7, "0.7 s in the future");
  }
}

TEST(StampOrder, AStrayMessageMayComeTwiceOrThrice) {
  Input input;
  for (const double stray : {0.0, 1.0, 2e9, 990.0, 999.9}) {
    for (const int times : {2, 3, 20}) {
      EXPECT_EQ(input.taken(3), 3);
      for (int i = 0; i < times; ++i) EXPECT_FALSE(input.with_stamp(stray).take) << stray;
      EXPECT_EQ(input.taken(3), 3) << stray;
    }
  }
}

TEST(StampOrder, ABurstOfLateOnesIsNoTimeThatWentBack) {
  Input input;
  EXPECT_EQ(input.taken(10), 10);
  for (int i = 0; i < 15; ++i) {
    const StampOrder::Verdict verdict = input.with_stamp(input.now - 0.3 + 0.01 * i);
    EXPECT_FALSE(verdict.take || verdict.went_back);
  }
  EXPECT_EQ(input.taken(10), 10);
}

TEST(StampOrder, TimeHasGoneBackWhereSeveralInOrderSaySo) {
  for (const double period : {0.01, 0.1, 0.25}) {
    for (const double back : {0.3 + 2.0 * period, 60.0}) {
      Input input;
      input.period = period;
      EXPECT_EQ(input.taken(10), 10);
      input.offset = -back;
      int dropped = 0;
      StampOrder::Verdict verdict = input.next();
      for (; !verdict.take && dropped < 100; ++dropped) verdict = input.next();
      EXPECT_TRUE(verdict.went_back) << period << " " << back;
      EXPECT_THAT(verdict.remark, HasSubstr("time has gone back"));
      EXPECT_GE(dropped, 2);
      EXPECT_LE(dropped * period, 0.51);
      EXPECT_EQ(input.taken(20), 20);
    }
  }
}

TEST(StampOrder, TwoSendersAreNoTimeThatGoesToAndFro) {
  Input input;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(input.next().take);
    for (int j = 0; j < 10; ++j) EXPECT_FALSE(input.with_stamp(input.now - 0.3 + 0.01 * j).went_back);
  }
}

TEST(StampOrder, AClockThatIsAheadAllTheTimeIsTakenUpToTheLimit) {
  Input input;
  input.offset = 0.4;
  EXPECT_EQ(input.taken(20), 20);
  Input too_far;
  too_far.offset = 0.6;
  EXPECT_EQ(too_far.taken(20), 0);
  EXPECT_TRUE(too_far.next().of_the_future);
}

TEST(StampOrder, AClockThatIsSetForwardIsFollowed) {
  Input input;
  EXPECT_EQ(input.taken(20), 20);
  input.offset = 0.3;
  EXPECT_EQ(input.taken(20), 18);
  EXPECT_FALSE(input.next().went_back);
}

TEST(StampOrder, ASimulatedClockMayTickSlowly) {
  StampOrder order("chassis");
  for (int i = 0; i < 200; ++i) {
    const double stamp = 0.02 * i, tick = 0.2 * std::floor(stamp / 0.2);
    EXPECT_TRUE(order.judge(at_seconds(100.0 + stamp), at_seconds(100.0 + tick), kMaxAge).take) << i;
  }
}

TEST(StampOrder, WithoutReceiptNothingIsOfTheFuture) {
  StampOrder order("localization");
  EXPECT_TRUE(order.judge(at_seconds(10.0), std::nullopt, kMaxAge).take);
  EXPECT_TRUE(order.judge(at_seconds(60.0), std::nullopt, kMaxAge).take);
  EXPECT_FALSE(order.judge(at_seconds(59.0), std::nullopt, kMaxAge).take);
}

TEST(StampOrder, AClockThatIsCorrectedALittleDoesNotGoBack) {
  EXPECT_FALSE(goes_back(at_seconds(10.0), at_seconds(9.6)));
  EXPECT_FALSE(goes_back(at_seconds(10.0), at_seconds(100.0)));
  EXPECT_TRUE(goes_back(at_seconds(10.0), at_seconds(9.4)));
}

}  // namespace
}  // namespace relative_map::core
