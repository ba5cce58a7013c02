// Clouds as files: what is written is read again, and what is no cloud is told in a sentence.
#include "relative_map/io/point_cloud_file.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>
#include <random>

#include "relative_map/io/lzf.hpp"
#include "relative_map/io/whole_file.hpp"
#include "support/temporary_folder.hpp"

namespace relative_map::core {
namespace {

using test::fault_of;
using testing::HasSubstr;

class PointCloudFileTest : public test::TemporaryFolder {
 protected:
  std::string fault(const std::string& name, const std::string& content) {
    const std::string file = write(name, content);
    return fault_of([&] { read_point_cloud(file); });
  }
};

PointCloud random_cloud(std::size_t count, const Eigen::Vector3d& around = Eigen::Vector3d::Zero()) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-50.0, 50.0);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.push_back(around +
                           Eigen::Vector3d(number(random), number(random), std::floor(number(random))));
    cloud.intensity.push_back(std::floor(number(random)));
    cloud.time.push_back(1e-6 * static_cast<double>(i));
  }
  return cloud;
}

std::string header(const std::string& points, const std::string& data, const std::string& fields = "x y z",
                   const std::string& size = "4 4 4", const std::string& type = "F F F") {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\nWIDTH " +
         points + "\nHEIGHT 1\nPOINTS " + points + "\nDATA " + data + "\n";
}

std::string floats(const std::vector<float>& numbers) {
  return std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
}

TEST_F(PointCloudFileTest, EveryEncodingComesBack) {
  for (const Eigen::Vector3d& around :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(587123.0, 4141240.0, 35.0)}) {
    for (const std::size_t count : {0u, 1u, 1000u}) {
      const PointCloud cloud = random_cloud(count, around);
      for (const auto encoding :
           {PcdEncoding::kAscii, PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed}) {
        write_pcd(path("cloud.pcd"), cloud, encoding);
        const CloudFile file = read_point_cloud(path("cloud.pcd"));
        ASSERT_EQ(file.cloud.size(), count);
        EXPECT_EQ(file.dropped, 0u);
        for (std::size_t i = 0; i < count; ++i) {
          ASSERT_LT((file.cloud.points[i] - cloud.points[i]).norm(), 1e-4);
          ASSERT_EQ(file.cloud.intensity[i], cloud.intensity[i]);
          ASSERT_NEAR(file.cloud.time[i], cloud.time[i], 1e-9);
        }
      }
    }
  }
}

TEST_F(PointCloudFileTest, KittiComesBack) {
  const PointCloud cloud = random_cloud(777);
  write_kitti(path("cloud.bin"), cloud);
  const CloudFile file = read_point_cloud(path("cloud.bin"));
  ASSERT_EQ(file.cloud.size(), 777u);
  for (std::size_t i = 0; i < 777; ++i) {
    ASSERT_LT((file.cloud.points[i] - cloud.points[i]).norm(), 1e-5);
    ASSERT_EQ(file.cloud.intensity[i], cloud.intensity[i]);
  }
  EXPECT_FALSE(file.cloud.has_time());
}

TEST_F(PointCloudFileTest, AMillionPointsAreRead) {
  write_pcd(path("cloud.pcd"), random_cloud(1'000'000), PcdEncoding::kBinaryCompressed);
  EXPECT_EQ(read_point_cloud(path("cloud.pcd")).cloud.size(), 1'000'000u);
}

TEST_F(PointCloudFileTest, PointsThatAreNoneAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const std::string bytes = floats({1, 2, 3, nan, 2, 3, 1, inf, 3, 1e30f, 0, 0, 4, 5, 6});
  const CloudFile file = read_point_cloud(write("a.pcd", header("5", "binary") + bytes));
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.dropped, 3u);
  EXPECT_EQ(file.cloud.points[1], Eigen::Vector3d(4, 5, 6));
  const CloudFile text =
      read_point_cloud(write("b.pcd", header("2", "ascii") + "nan nan nan\n1 2.5 -3e-1\n"));
  ASSERT_EQ(text.cloud.size(), 1u);
  EXPECT_EQ(text.cloud.points[0], Eigen::Vector3d(1, 2.5, -0.3));
}

TEST_F(PointCloudFileTest, FieldsOfAnyTypeAndOrder) {
  // Ouster's: t is an integer in ns; padding, and fields that nobody asked for, in between.
  std::string point(4 + 2 + 4 + 8 + 8 + 1, '\0');
  const auto place = [&](std::size_t at, auto value) { std::memcpy(&point[at], &value, sizeof(value)); };
  place(0, std::uint32_t{50'000'000});
  place(4, std::uint16_t{77});
  place(6, 1.5f);
  place(10, 2.5);
  place(18, -3.5);
  const std::string head = header("1", "binary", "t intensity x y z pad", "4 2 4 8 8 1", "U U F F F U");
  const CloudFile file = read_point_cloud(write("a.pcd", head + point));
  ASSERT_EQ(file.cloud.size(), 1u);
  EXPECT_EQ(file.cloud.points[0], Eigen::Vector3d(1.5, 2.5, -3.5));
  EXPECT_EQ(file.cloud.intensity[0], 77.0);
  EXPECT_NEAR(file.cloud.time[0], 0.05, 1e-12);
}

TEST_F(PointCloudFileTest, FilesThatAreCutOffAnywhereAreTold) {
  const PointCloud cloud = random_cloud(50);
  for (const auto encoding : {PcdEncoding::kAscii, PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed}) {
    write_pcd(path("whole.pcd"), cloud, encoding);
    const std::string whole = read_whole_file(path("whole.pcd"));
    for (std::size_t length = 0; length + 12 < whole.size(); length += 7) {
      const std::string said = fault("cut.pcd", whole.substr(0, length));
      ASSERT_THAT(said, HasSubstr("cut.pcd: ")) << length << " of " << whole.size();
    }
  }
  EXPECT_THAT(fault("cut.bin", std::string(33, 'a')), HasSubstr("no whole number of points"));
}

TEST_F(PointCloudFileTest, HeadersThatLieAreTold) {
  const std::string bytes = floats({1, 2, 3});
  EXPECT_THAT(fault("a.pcd", header("2", "binary") + bytes), HasSubstr("cut off"));
  EXPECT_THAT(fault("a.pcd", header("399999999", "binary") + bytes), HasSubstr("cut off"));
  EXPECT_THAT(fault("a.pcd", header("399999999", "ascii") + "1 2 3\n"), HasSubstr("cut off"));
  EXPECT_THAT(fault("a.pcd", header("99999999999999999999", "binary") + bytes), HasSubstr("no number up to"));
  EXPECT_THAT(fault("a.pcd", header("-1", "binary") + bytes), HasSubstr("WIDTH"));
  EXPECT_THAT(fault("a.pcd", header("1", "binary", "x y z", "4 4") + bytes), HasSubstr("SIZE"));
  EXPECT_THAT(fault("a.pcd", header("1", "binary", "x y z", "4 4 3") + bytes), HasSubstr("3 bytes"));
  EXPECT_THAT(fault("a.pcd", header("1", "binary", "x y z", "4 4 4", "F F Q") + bytes), HasSubstr("type Q"));
  EXPECT_THAT(fault("a.pcd", header("1", "binary", "x y w") + bytes), HasSubstr("lacks x, y or z"));
  EXPECT_THAT(fault("a.pcd", header("1", "zipped") + bytes), HasSubstr("zipped"));
  EXPECT_THAT(fault("a.pcd", header("1", "ascii") + "1 2 three\n"), HasSubstr("point 1 of 1"));
  EXPECT_THAT(fault("a.pcd", header("1", "ascii") + "1 2,5 3\n"), HasSubstr("point 1 of 1"));
  EXPECT_THAT(fault("a.pcd", "solid cube"), HasSubstr("does not begin like one"));
  EXPECT_THAT(fault("a.ply", "ply"), HasSubstr("neither"));
  std::string lie = header("1", "binary_compressed");
  const std::uint32_t sizes[2] = {4, 4000000000u};
  lie += std::string(reinterpret_cast<const char*>(sizes), 8) + "abcd";
  EXPECT_THAT(fault("a.pcd", lie), HasSubstr("wrong header"));
  EXPECT_THAT(fault_of([&] { read_point_cloud(path("none.pcd")); }), HasSubstr("none.pcd: cannot be opened"));
}

TEST_F(PointCloudFileTest, DamagedFilesNeverCrash) {
  std::mt19937 random(11);
  for (const auto encoding : {PcdEncoding::kAscii, PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed}) {
    write_pcd(path("whole.pcd"), random_cloud(40), encoding);
    const std::string whole = read_whole_file(path("whole.pcd"));
    for (int i = 0; i < 300; ++i) {
      std::string damaged = whole;
      for (int k = 0; k < 4; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
      fault("damaged.pcd", damaged);  // a cloud or a sentence, and either is right
    }
  }
}

TEST(Lzf, ComesBack) {
  std::mt19937 random(5);
  for (const std::size_t size : {0u, 1u, 3u, 31u, 32u, 33u, 264u, 9000u, 100000u}) {
    for (const unsigned letters : {1u, 3u, 256u}) {
      std::string bytes(size, 'a');
      for (char& byte : bytes) byte = static_cast<char>(random() % letters);
      const std::string packed = lzf_packed(bytes);
      ASSERT_LE(packed.size(), bytes.size() + bytes.size() / 32 + 1);
      ASSERT_EQ(lzf_unpacked(packed, size), bytes);
      if (size > 0) {
        ASSERT_FALSE(lzf_unpacked(packed, size - 1));
      }
      ASSERT_FALSE(lzf_unpacked(packed, size + 1));
    }
  }
}

TEST(Lzf, UnpacksWhatTheFormatSays) {
  // Three literals, then a copy of 2 + 4 bytes from 3 back: it overlaps what it writes.
  const std::string packed = std::string("\x02") + "abc" + std::string("\x80\x02", 2);
  EXPECT_EQ(lzf_unpacked(packed, 9), "abcabcabc");
  EXPECT_FALSE(lzf_unpacked(std::string("\x80\x02", 2), 6)) << "from before the beginning";
}

}  // namespace
}  // namespace relative_map::core
