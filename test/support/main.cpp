#include <gtest/gtest.h>

// Not gtest_main: its name and its place differ between Debian's catkin and Noetic's.
int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
