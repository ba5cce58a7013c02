#include "relative_map/io/traffic_scene.hpp"

#include <gmock/gmock.h>

#include "support/temporary_folder.hpp"

namespace relative_map::core::test {
namespace {

using testing::HasSubstr;

class Scene : public TemporaryFolder {
 protected:
  std::string fault() {
    return fault_of([&] { read_traffic_scene(folder_.string()); });
  }
};

TEST_F(Scene, IsReadByItsColumnsNames) {
  write("tracks.csv", "t,id,type,x,y,ego,heading\n0.1,b,VEHICLE,1,2,0,0.5\n0,a,PEDESTRIAN,3,4,1,\n");
  write("lanes.json",
        R"({"lanes": [{"id": "1", "type": "BIKE", "center": [[0, 0], [10, 0]], "left": [[0, 1], [10, 1]],
                       "right": null, "succ": ["2"], "left_nb": "3", "left_same_dir": false, "right_nb": "4"}]})");
  const TrafficScene scene = read_traffic_scene(folder_.string());
  ASSERT_EQ(scene.samples.size(), 2u);
  EXPECT_EQ(scene.names.at(scene.samples[0].seen.id), "a");
  EXPECT_TRUE(scene.samples[0].ego);
  EXPECT_TRUE(std::isnan(scene.samples[0].seen.heading));
  EXPECT_EQ(scene.samples[1].seen.type, RoadUserType::kVehicle);
  EXPECT_EQ(scene.samples[1].seen.position, Point2(1.0, 2.0));
  ASSERT_EQ(scene.lanes.lanes.size(), 1u);
  EXPECT_EQ(scene.lanes.lanes[0].use, LaneUse::kBicycles);
  EXPECT_NEAR(scene.lanes.lanes[0].left_width, 1.0, 1e-9);
  EXPECT_EQ(scene.lanes.lanes[0].right_width, 0.0);
  EXPECT_EQ(scene.lanes.lanes[0].left_neighbor, "");  // of the other direction
  EXPECT_EQ(scene.lanes.lanes[0].right_neighbor, "4");
}

TEST_F(Scene, NeedsNoLanes) {
  write("tracks.csv", "id,type,t,x,y\n1,PEDESTRIAN,0.0,8.46,3.59\n");
  EXPECT_EQ(read_traffic_scene(folder_.string()).lanes.lanes.size(), 0u);
}

TEST_F(Scene, FaultsAreNamedWithTheirPlace) {
  EXPECT_THAT(fault(), HasSubstr("tracks.csv: can't be read"));
  write("tracks.csv", "id,type,t,x\n");
  EXPECT_THAT(fault(), HasSubstr("no column 'y'"));
  write("tracks.csv", "id,type,t,x,y\n1,VEHICLE,0,1\n");
  EXPECT_THAT(fault(), HasSubstr("line 2: has 4 cells"));
  write("tracks.csv", "id,type,t,x,y\n1,VEHICLE,0,1,no\n");
  EXPECT_THAT(fault(), HasSubstr("line 2: 'no' in column 'y' is no number"));
  write("tracks.csv", "id,type,t,x,y\n1,VEHICLE,never,1,2\n");
  EXPECT_THAT(fault(), HasSubstr("line 2"));
  write("tracks.csv", "id,type,t,x,y\n1,VEHICLE,0,1,2\n");
  write("lanes.json", "{\"lanes\": [{}]}");
  EXPECT_THAT(fault(), HasSubstr("lanes.json: is not what it should be"));
  EXPECT_THAT(fault_of([&] { read_traffic_scene(path("nowhere")); }), HasSubstr("is no folder"));
}

}  // namespace
}  // namespace relative_map::core::test
