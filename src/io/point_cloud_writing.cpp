#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/lzf.hpp"
#include "relative_map/io/point_cloud_file.hpp"
#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

constexpr double kFloatLimit = 800.0;  // [m] up to here float32 is good to 0.03 mm

struct Column {
  std::string name;
  bool wide;  ///< float64 instead of float32
  std::function<double(std::size_t)> value;
};

std::vector<Column> columns_of(const PointCloud& cloud) {
  double reach = 0.0;
  for (const Eigen::Vector3d& point : cloud.points) reach = std::max(reach, point.cwiseAbs().maxCoeff());
  const bool wide = reach > kFloatLimit;
  std::vector<Column> columns;
  for (const Eigen::Index axis : {0, 1, 2}) {
    columns.push_back(
        {std::string(1, "xyz"[axis]), wide, [&cloud, axis](std::size_t i) { return cloud.points[i][axis]; }});
  }
  if (cloud.has_intensity())
    columns.push_back({"intensity", false, [&cloud](std::size_t i) { return cloud.intensity[i]; }});
  if (cloud.has_time()) columns.push_back({"time", false, [&cloud](std::size_t i) { return cloud.time[i]; }});
  return columns;
}

void put(double value, bool wide, std::string& bytes) {
  const float narrow = static_cast<float>(value);
  if (wide) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  } else {
    bytes.append(reinterpret_cast<const char*>(&narrow), sizeof(narrow));
  }
}

std::string header_of(const PointCloud& cloud, const std::vector<Column>& columns, const std::string& data) {
  std::string fields = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
  for (const Column& column : columns) {
    fields += " " + column.name;
    sizes += column.wide ? " 8" : " 4";
    types += " F";
    counts += " 1";
  }
  const std::string points = std::to_string(cloud.size());
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + "\n" + sizes + "\n" + types +
         "\n" + counts + "\nWIDTH " + points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points +
         "\nDATA " + data + "\n";
}

std::string ascii_of(const PointCloud& cloud, const std::vector<Column>& columns) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      text.precision(columns[c].wide ? 17 : 9);
      text << (c == 0 ? "" : " ") << columns[c].value(i);
    }
    text << '\n';
  }
  return text.str();
}

std::string compressed_of(const PointCloud& cloud, const std::vector<Column>& columns) {
  std::string bytes;
  for (const Column& column : columns) {
    for (std::size_t i = 0; i < cloud.size(); ++i) put(column.value(i), column.wide, bytes);
  }
  const std::string packed = lzf_packed(bytes);
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max())
    throw std::runtime_error("too many points for a compressed PCD file");
  const std::uint32_t sizes[2] = {static_cast<std::uint32_t>(packed.size()),
                                  static_cast<std::uint32_t>(bytes.size())};
  return std::string(reinterpret_cast<const char*>(sizes), sizeof(sizes)) + packed;
}

}  // namespace

void write_pcd(const std::string& path, const PointCloud& cloud, PcdEncoding encoding) {
  const std::vector<Column> columns = columns_of(cloud);
  if (encoding == PcdEncoding::kAscii) {
    write_whole_file(path, header_of(cloud, columns, "ascii") + ascii_of(cloud, columns));
    return;
  }
  if (encoding == PcdEncoding::kBinaryCompressed) {
    write_whole_file(path, header_of(cloud, columns, "binary_compressed") + compressed_of(cloud, columns));
    return;
  }
  std::string bytes = header_of(cloud, columns, "binary");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (const Column& column : columns) put(column.value(i), column.wide, bytes);
  }
  write_whole_file(path, bytes);
}

void write_kitti(const std::string& path, const PointCloud& cloud) {
  std::string bytes;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (const Eigen::Index axis : {0, 1, 2}) put(cloud.points[i][axis], false, bytes);
    put(cloud.has_intensity() ? cloud.intensity[i] : 0.0, false, bytes);
  }
  write_whole_file(path, bytes);
}

}  // namespace relative_map::core
