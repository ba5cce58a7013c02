#include "relative_map/prediction/road_user_store.hpp"

#include <gmock/gmock.h>

#include "support/traffic.hpp"

namespace relative_map::core::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

SeenRoadUsers frame(double t, std::vector<SeenRoadUser> users) {
  return {at_seconds(100.0 + t), std::move(users)};
}

class Store : public testing::Test {
 protected:
  void add(double t, std::vector<SeenRoadUser> users) { store_.add(frame(t, std::move(users)), {0.0, 0.0}); }
  const RoadUser& user(int id, double t) {
    for (const RoadUser* user : store_.present(at_seconds(100.0 + t))) {
      if (user->seen().id == id) return *user;
    }
    throw std::runtime_error("not there");
  }
  std::size_t present(double t) { return store_.present(at_seconds(100.0 + t)).size(); }

  RoadUserStore store_{RoadUserStoreParam{}, MotionFilterParam{}};
};

TEST_F(Store, FollowsARoadUserByItsId) {
  for (int i = 0; i <= 20; ++i) add(0.1 * i, {seen(7, 1.2 * i, 3.0)});
  EXPECT_NEAR(user(7, 2.0).speed(), 12.0, 0.2);
  EXPECT_NEAR(user(7, 2.0).theta(), 0.0, 0.02);
  EXPECT_FALSE(user(7, 2.0).still());
}

TEST_F(Store, AnOriginIsAPlaceLikeAnyOther) {
  for (int i = -10; i <= 0; ++i) add(2.0 + 0.1 * i, {seen(1, 1.0 * i, 0.0)});
  EXPECT_NEAR(user(1, 2.0).filter().position().x(), 0.0, 0.05);
  EXPECT_EQ(user(1, 2.0).history().size(), 11u);
}

TEST_F(Store, AFrameThatIsNotNewerIsDropped) {
  add(1.0, {seen(1, 0.0, 0.0)});
  add(1.0, {seen(1, 50.0, 0.0)});
  EXPECT_THAT(store_.remarks(), testing::ElementsAre(HasSubstr("not newer")));
  add(0.5, {seen(1, 50.0, 0.0), seen(2, 0.0, 0.0)});
  EXPECT_EQ(present(1.0), 1u);
  EXPECT_EQ(user(1, 1.0).seen().position.x(), 0.0);
}

TEST_F(Store, TimeThatRunsOnFromAnEarlierStampIsANewBeginning) {
  for (int i = 0; i <= 30; ++i) add(5.0 + 0.1 * i, {seen(1, 1.0 * i, 0.0)});
  for (int i = 0; i <= 10; ++i) add(1.0 + 0.1 * i, {seen(2, 1.0 * i, 0.0)});
  EXPECT_EQ(present(2.0), 1u);
  EXPECT_EQ(user(2, 2.0).seen().id, 2);
}

TEST_F(Store, AStampThatJumpsForgetsAll) {
  for (const double jump : {-50.0, 50.0}) {
    store_.clear();
    add(60.0, {seen(1, 0.0, 0.0)});
    add(60.0 + jump, {seen(2, 0.0, 0.0)});
    EXPECT_EQ(store_.size(), 1u);
    EXPECT_THAT(store_.remarks(), testing::ElementsAre(HasSubstr("jumped")));
  }
}

TEST_F(Store, WhatIsNoLongerSeenAges) {
  add(0.0, {seen(1, 0.0, 0.0)});
  add(0.4, {});
  EXPECT_EQ(present(0.4), 1u);
  EXPECT_EQ(present(0.6), 0u);
  EXPECT_EQ(store_.size(), 1u);
  add(3.5, {});
  EXPECT_EQ(store_.size(), 0u);
}

TEST_F(Store, ABoxThatIsTurnedByHalfATurnIsTheSameOne) {
  for (int i = 0; i <= 20; ++i) add(0.1 * i, {seen(1, 5.0, 5.0, i % 2 == 0 ? 0.4 : 0.4 - kPi)});
  EXPECT_NEAR(user(1, 2.0).theta(), 0.4, 1e-6);
  for (int i = 0; i <= 20; ++i) add(3.0 + 0.1 * i, {seen(2, 1.0 * i, 0.0, i % 2 == 0 ? 0.0 : kPi)});
  EXPECT_NEAR(user(2, 5.0).theta(), 0.0, 0.02);
}

TEST_F(Store, ATypeThatFlickersIsTheSameRoadUser) {
  for (int i = 0; i <= 20; ++i) {
    add(0.1 * i, {seen(1, 1.0 * i, 0.0, 0.0, i % 4 == 3 ? RoadUserType::kBicycle : RoadUserType::kVehicle)});
  }
  EXPECT_EQ(user(1, 2.0).type(), RoadUserType::kVehicle);
  EXPECT_NEAR(user(1, 2.0).speed(), 10.0, 0.3);
  for (int i = 21; i <= 60; ++i) add(0.1 * i, {seen(1, 1.0 * i, 0.0, 0.0, RoadUserType::kBicycle)});
  EXPECT_EQ(user(1, 6.0).type(), RoadUserType::kBicycle);
}

TEST_F(Store, TwoThatSwapTheirIdsStartAnew) {
  for (int i = 0; i <= 20; ++i) add(0.1 * i, {seen(1, 1.0 * i, 0.0), seen(2, -1.0 * i, 40.0, kPi)});
  add(2.1, {seen(2, 21.0, 0.0), seen(1, -21.0, 40.0, kPi)});
  EXPECT_EQ(user(1, 2.1).history().size(), 1u);
  EXPECT_NEAR(user(1, 2.1).filter().position().y(), 40.0, 0.1);
}

TEST_F(Store, OfTwoWithOneIdTheExpectedOneStays) {
  for (int i = 0; i <= 10; ++i) add(0.1 * i, {seen(1, 1.0 * i, 0.0)});
  add(1.1, {seen(1, 300.0, 0.0), seen(1, 11.0, 0.0)});
  EXPECT_NEAR(user(1, 1.1).filter().position().x(), 11.0, 0.5);
  EXPECT_THAT(store_.remarks(), testing::ElementsAre(HasSubstr("id that is there already")));
}

TEST_F(Store, WhatCannotBeIsLeftOut) {
  SeenRoadUser lost = seen(1, kNotGiven, 0.0), fast = seen(2, 0.0, 0.0), flat = seen(3, 5.0, 5.0);
  fast.velocity = {1000.0, 0.0};
  flat.length = -3.0;
  flat.width = kNotGiven;
  add(0.0, {lost, fast, flat});
  EXPECT_EQ(present(0.0), 2u);
  EXPECT_THAT(store_.remarks(), testing::ElementsAre(HasSubstr("without a place")));
  EXPECT_LT(user(2, 0.0).speed(), 1.0);
  EXPECT_EQ(user(3, 0.0).seen().length, 0.0);
  EXPECT_EQ(user(3, 0.0).seen().width, 0.0);
}

TEST_F(Store, NothingDrivesAtAThousandMetresASecond) {
  for (int i = 0; i <= 20; ++i) {
    add(0.1 * i, {seen(1, 100.0 * i, 0.0)});
    EXPECT_LE(user(1, 0.1 * i).speed(), RoadUserStoreParam{}.max_speed);
  }
}

TEST_F(Store, OfTenThousandTheNearestAreKept) {
  std::vector<SeenRoadUser> many;
  for (int i = 0; i < 10000; ++i) many.push_back(seen(i, 10000.0 - i, 0.0));
  add(0.0, many);
  EXPECT_EQ(store_.size(), 300u);
  EXPECT_NO_THROW(user(9999, 0.0));
  EXPECT_THAT(store_.remarks(), testing::ElementsAre(HasSubstr("too many")));
}

TEST_F(Store, MemoryDoesNotGrow) {
  for (int i = 0; i <= 2000; ++i) add(0.01 * i, {seen(1, 0.1 * i, 0.0), seen(100 + i, 0.0, 50.0)});
  EXPECT_LE(user(1, 20.0).history().size(), 200u);
  EXPECT_LE(store_.size(), 302u + 1u);
}

TEST_F(Store, ADropoutIsCarriedOver) {
  for (int i = 0; i <= 20; ++i) {
    if (i % 5 == 4) {
      add(0.1 * i, {});
    } else {
      add(0.1 * i, {seen(1, 1.0 * i, 0.0)});
    }
  }
  EXPECT_NEAR(user(1, 2.0).speed(), 10.0, 0.3);
  EXPECT_THAT(store_.remarks(), IsEmpty());
}

}  // namespace
}  // namespace relative_map::core::test
