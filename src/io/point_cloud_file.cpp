#include "relative_map/io/point_cloud_file.hpp"

#include <locale.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "pcd_header.hpp"
#include "relative_map/io/lzf.hpp"
#include "relative_map/io/text.hpp"
#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

constexpr std::size_t kLargestCloud = std::size_t{2} << 30;  // [bytes]
constexpr double kFarthest = 1e8;                            // [m] no map has its origin so far away
constexpr double kAbsoluteTime = 1e6;                        // [s] larger ones are stamps, not offsets

/// Which columns are what; null: there is none.
struct Columns {
  std::array<const PcdField*, 3> xyz = {};
  const PcdField* intensity = nullptr;
  const PcdField* time = nullptr;
};

Columns columns_of(const PcdHeader& header) {
  Columns columns;
  for (const PcdField& field : header.fields) {
    if (field.count == 0) continue;
    const std::string name = lower(field.name);
    if (name == "x") columns.xyz[0] = &field;
    if (name == "y") columns.xyz[1] = &field;
    if (name == "z") columns.xyz[2] = &field;
    if (name == "intensity" || (name == "i" && !columns.intensity)) columns.intensity = &field;
    if (name == "time" || name == "t" || name == "timestamp") columns.time = &field;
  }
  for (const PcdField* field : columns.xyz) {
    if (field == nullptr) throw std::runtime_error("is no usable PCD file: it lacks x, y or z");
  }
  return columns;
}

/// Takes points one by one, and leaves out those that are none.
class Collector {
 public:
  Collector(const Columns& columns, std::size_t points) : columns_(columns) {
    file_.cloud.points.reserve(points);
  }

  /// `value` gives the number in a field.
  template <class Value>
  void take(const Value& value) {
    const Eigen::Vector3d point(value(*columns_.xyz[0]), value(*columns_.xyz[1]), value(*columns_.xyz[2]));
    const double time = columns_.time != nullptr ? value(*columns_.time) : 0.0;
    if (!point.allFinite() || point.cwiseAbs().maxCoeff() > kFarthest || !std::isfinite(time)) {
      ++file_.dropped;
      return;
    }
    file_.cloud.points.push_back(point);
    if (columns_.intensity != nullptr) {
      const double intensity = value(*columns_.intensity);
      file_.cloud.intensity.push_back(std::isfinite(intensity) ? intensity : 0.0);
    }
    if (columns_.time != nullptr) file_.cloud.time.push_back(columns_.time->type == 'F' ? time : 1e-9 * time);
  }

  CloudFile finish() {
    std::vector<double>& time = file_.cloud.time;
    if (!time.empty()) {
      const double first = *std::min_element(time.begin(), time.end());
      if (std::abs(first) > kAbsoluteTime) {
        for (double& t : time) t -= first;
      }
    }
    return std::move(file_);
  }

 private:
  Columns columns_;
  CloudFile file_;
};

[[noreturn]] void cut_off(std::size_t needed, std::size_t there) {
  throw std::runtime_error("is cut off, or its header is wrong: its points need " + std::to_string(needed) +
                           " bytes, and there are " + std::to_string(there));
}

CloudFile read_ascii(const PcdHeader& header, const Columns& columns, const std::string& content) {
  // Each value takes a digit and a blank at least: a header can't make us reserve more than the file is long.
  if (header.points * header.columns * 2 > content.size() - header.length + 1) {
    cut_off(header.points * header.columns * 2, content.size() - header.length);
  }
  const std::unique_ptr<std::remove_pointer_t<locale_t>, void (*)(locale_t)> plain(
      newlocale(LC_ALL_MASK, "C", nullptr), freelocale);
  Collector collector(columns, header.points);
  std::vector<double> values(header.columns);
  const char* place = content.c_str() + header.length;
  for (std::size_t i = 0; i < header.points; ++i) {
    for (double& value : values) {
      char* end = nullptr;
      value = strtod_l(place, &end, plain.get());
      const bool whole = end != place && (*end == '\0' || std::strchr(" \t\r\n", *end) != nullptr);
      if (!whole) {
        throw std::runtime_error("is cut off, or no numbers: point " + std::to_string(i + 1) + " of " +
                                 std::to_string(header.points) + " can't be read");
      }
      place = end;
    }
    collector.take([&](const PcdField& field) { return values[field.column]; });
  }
  return collector.finish();
}

CloudFile read_binary(const PcdHeader& header, const Columns& columns, const std::string& content) {
  const std::size_t needed = header.points * header.point_size;
  if (needed > content.size() - header.length) cut_off(needed, content.size() - header.length);
  Collector collector(columns, header.points);
  const char* place = content.data() + header.length;
  for (std::size_t i = 0; i < header.points; ++i, place += header.point_size) {
    collector.take([&](const PcdField& field) { return pcd_value(field, place + field.offset); });
  }
  return collector.finish();
}

CloudFile read_compressed(const PcdHeader& header, const Columns& columns, const std::string& content) {
  const std::size_t there = content.size() - header.length;
  if (header.points == 0) return {};
  std::array<std::uint32_t, 2> sizes = {};  // packed, unpacked [bytes]
  if (there < sizeof(sizes)) cut_off(sizeof(sizes), there);
  std::memcpy(sizes.data(), content.data() + header.length, sizeof(sizes));
  if (sizes[0] > there - sizeof(sizes)) cut_off(sizes[0], there - sizeof(sizes));
  const std::size_t needed = header.points * header.point_size;
  if (sizes[1] != needed) {
    throw std::runtime_error("has a wrong header: its points need " + std::to_string(needed) +
                             " bytes, and the compressed part says " + std::to_string(sizes[1]));
  }
  // A copy of 264 bytes takes three: no honest file promises more.
  if (needed > std::size_t{sizes[0]} * 88) cut_off(needed / 88, sizes[0]);
  const auto unpacked =
      lzf_unpacked(std::string_view(content).substr(header.length + sizeof(sizes), sizes[0]), needed);
  if (!unpacked) throw std::runtime_error("is damaged: its compressed part can't be unpacked");
  // All values of a field stand together, in the order of the points.
  Collector collector(columns, header.points);
  for (std::size_t i = 0; i < header.points; ++i) {
    collector.take([&](const PcdField& field) {
      return pcd_value(field, unpacked->data() + field.offset * header.points + i * field.size * field.count);
    });
  }
  return collector.finish();
}

CloudFile read_pcd(const std::string& content) {
  const PcdHeader header = parse_pcd_header(content);
  const Columns columns = columns_of(header);
  if (header.data == "ascii") return read_ascii(header, columns, content);
  if (header.data == "binary") return read_binary(header, columns, content);
  return read_compressed(header, columns, content);
}

CloudFile read_kitti(const std::string& content) {
  PcdHeader header;
  header.point_size = 16;
  if (content.size() % header.point_size != 0) {
    throw std::runtime_error("is cut off, or not KITTI's: " + std::to_string(content.size()) +
                             " bytes are no whole number of points of 16 bytes");
  }
  header.points = content.size() / header.point_size;
  header.fields = {{"x", 4, 'F', 1, 0, 0},
                   {"y", 4, 'F', 1, 4, 1},
                   {"z", 4, 'F', 1, 8, 2},
                   {"intensity", 4, 'F', 1, 12, 3}};
  CloudFile file = read_binary(header, columns_of(header), content);
  // Any bytes are numbers: what is mostly no point is another kind of file.
  if (file.dropped > header.points / 2) {
    throw std::runtime_error("is not KITTI's: most of its bytes are no points");
  }
  return file;
}

bool looks_like_pcd(const std::string& content) {
  return content.compare(0, 1, "#") == 0 || content.compare(0, 7, "VERSION") == 0 ||
         content.compare(0, 6, "FIELDS") == 0;
}

}  // namespace

CloudFile read_point_cloud(const std::string& path) {
  const std::string ending = lower(std::filesystem::path(path).extension().string());
  if (ending != ".pcd" && ending != ".bin") {
    throw std::runtime_error(path + ": is neither a .pcd nor a .bin file");
  }
  const std::string content = read_whole_file(path, kLargestCloud);
  try {
    if (ending == ".bin") return read_kitti(content);
    if (!looks_like_pcd(content)) throw std::runtime_error("is no PCD file: it does not begin like one");
    return read_pcd(content);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": " + fault.what());
  }
}

}  // namespace relative_map::core
