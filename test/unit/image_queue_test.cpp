#include "relative_map/pipeline/paint/image_queue.hpp"

#include <gmock/gmock.h>

#include "support/markers.hpp"
#include "support/vehicles.hpp"

namespace relative_map::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A vehicle that drives straight on at 10 m/s, ten poses a second, with an image at each.
class Drive {
 public:
  std::vector<ImageQueue::Image> tick(LaneMarkers markers, double age = 0.0) {
    seconds_ += 0.1;
    queue.move(test::vehicle_at(Pose2(Point2(speed * seconds_, 0.0), 0.0), seconds_, speed));
    markers.stamp = at_seconds(seconds_ - age);
    queue.add(markers);
    return take();
  }
  std::vector<ImageQueue::Image> take() {
    remarks.clear();
    return queue.take(at_seconds(seconds_), at_seconds(seconds_), PipelineConfig(), remarks);
  }

  ImageQueue queue;
  std::vector<std::string> remarks;
  double speed = 10.0;

 private:
  double seconds_ = 100.0;
};

TEST(ImageQueue, LeavesOutImagesThatAreTooOld) {
  Drive drive;
  for (int i = 0; i < 10; ++i) drive.tick(test::lane_about({0.2}));
  EXPECT_EQ(drive.tick(test::lane_about({0.2}), 0.4).size(), 1u);
  EXPECT_THAT(drive.tick(test::lane_about({0.2}), 0.6), IsEmpty());
}

TEST(ImageQueue, KeepsTheNewestWhereNobodyTakesThem) {
  Drive drive;
  for (int i = 0; i < 10; ++i) drive.tick(test::lane_about({0.2}));
  for (int i = 0; i < 80; ++i) {
    LaneMarkers markers = test::lane_about({0.001 * i});
    markers.stamp = at_seconds(101.0 - 0.001 * (80 - i));
    drive.queue.add(markers);
  }
  const auto images = drive.take();
  ASSERT_EQ(images.size(), 50u);
  EXPECT_EQ(images.back().stamp, at_seconds(100.999));
}

TEST(ImageQueue, KnowsPaintThatStaysTheSameWhereItCannot) {
  const Cubic aslant{0.2, 0.05};  // after 10 m it is half a metre elsewhere
  Drive drive;
  std::vector<ImageQueue::Image> images;
  for (int i = 0; i < 12; ++i) images = drive.tick(test::lane_about(aslant));
  EXPECT_THAT(images, IsEmpty());
  EXPECT_THAT(drive.remarks, ElementsAre(HasSubstr("they are frozen")));
  LaneMarkers other = test::lane_about(aslant);
  other.right.cubic.c0 -= 0.01;
  EXPECT_EQ(drive.tick(other).size(), 1u) << "one side moves: they are not";
}

TEST(ImageQueue, KnowsThatOneSideThatMovesIsNotFrozen) {
  Drive drive;
  for (int i = 0; i < 30; ++i) {
    LaneMarkers markers = test::lane_about({0.2, 0.05});
    markers.right.cubic.c0 += 0.001 * i;
    EXPECT_EQ(drive.tick(markers).size(), 1u) << i;
  }
}

TEST(ImageQueue, TakesPaintThatRunsAlongTheWayOrIsSeenAtRest) {
  Drive along, at_rest;
  at_rest.speed = 0.0;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(along.tick(test::lane_about({0.2})).size(), 1u) << i;
    EXPECT_EQ(at_rest.tick(test::lane_about({0.2, 0.05})).size(), 1u) << i;
  }
}

}  // namespace
}  // namespace relative_map::core
