#include "relative_map/tools/bridged_gaps.hpp"

#include <gmock/gmock.h>

#include "relative_map/tools/line_edit.hpp"
#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::recording;
using test::straight;

/// 200 m along x, with nothing between 50 and 114 m.
RecordedLine with_gap() {
  RecordedLine line = recording(straight({}, 200.0, 0.5));
  line.points.erase(line.points.begin() + 101, line.points.begin() + 228);
  return line;
}

TEST(BridgedGaps, AreThoseThatWereResampled) {
  const RecordedLine line = with_gap();
  const std::vector<BridgedGap> gaps = gaps_of(line, 5.0);
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_NEAR(length_of(gaps[0]), 64.0, 1e-6);
  EXPECT_TRUE(gaps_of(line, 70.0).empty());
  EXPECT_TRUE(still_bridged(gaps, line, kBesideGap).empty());  // it is open, and shows by itself
  const RecordedLine even = make_recorded(resample(make_editable(line), 0.5));
  ASSERT_EQ(still_bridged(gaps, even, kBesideGap).size(), 1u);
  EXPECT_NEAR(still_bridged(gaps, even, kBesideGap)[0].from_x, 50.0, 0.5);
}

TEST(BridgedGaps, GoAlongWithWhatIsMadeOfALine) {
  const std::vector<BridgedGap> gaps = gaps_of(with_gap(), 5.0);
  const EditableLine even = resample(make_editable(with_gap()), 0.5);
  const auto left = still_bridged(gaps, make_recorded(offset(even, 20.0)), 20.0 + kBesideGap);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_NEAR(left[0].from_y, 20.0, 1e-6);
  EXPECT_EQ(still_bridged(gaps, make_recorded(reverse(even)), kBesideGap).size(), 1u);
  EXPECT_TRUE(still_bridged(gaps, make_recorded(cut(even, 130.0, 200.0)), kBesideGap).empty());
}

}  // namespace
}  // namespace relative_map::core
