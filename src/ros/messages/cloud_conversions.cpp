#include "relative_map/ros/messages/cloud_conversions.hpp"

#include <array>
#include <cmath>
#include <cstring>

namespace relative_map {

namespace {

using sensor_msgs::PointField;

constexpr double kAbsoluteTime = 1e6;  // [s] larger ones are stamps, not offsets
constexpr double kFarthest = 1e8;      // [m] no point of a vehicle's sensor, nor of a map

template <class Number>
double value_of(const std::uint8_t* memory) {
  Number number;
  std::memcpy(&number, memory, sizeof(number));
  return static_cast<double>(number);
}

std::size_t size_of(const PointField& field) {
  switch (field.datatype) {
    case PointField::INT8:
    case PointField::UINT8:
      return 1;
    case PointField::INT16:
    case PointField::UINT16:
      return 2;
    case PointField::INT32:
    case PointField::UINT32:
    case PointField::FLOAT32:
      return 4;
    case PointField::FLOAT64:
      return 8;
    default:
      return 0;
  }
}

double value_in(const PointField& field, const std::uint8_t* point) {
  const std::uint8_t* memory = point + field.offset;
  switch (field.datatype) {
    case PointField::INT8:
      return value_of<std::int8_t>(memory);
    case PointField::UINT8:
      return value_of<std::uint8_t>(memory);
    case PointField::INT16:
      return value_of<std::int16_t>(memory);
    case PointField::UINT16:
      return value_of<std::uint16_t>(memory);
    case PointField::INT32:
      return value_of<std::int32_t>(memory);
    case PointField::UINT32:
      return value_of<std::uint32_t>(memory);
    case PointField::FLOAT32:
      return value_of<float>(memory);
    default:
      return value_of<double>(memory);
  }
}

struct Fields {
  std::array<const PointField*, 3> xyz = {};
  const PointField* intensity = nullptr;
  const PointField* time = nullptr;
};

std::string fault_in(const sensor_msgs::PointCloud2& message, Fields& fields) {
  if (message.is_bigendian) return "the cloud is big-endian, which is not read";
  for (const PointField& field : message.fields) {
    const std::size_t size = size_of(field);
    if (size == 0 || field.offset + size > message.point_step) continue;
    if (field.name == "x") fields.xyz[0] = &field;
    if (field.name == "y") fields.xyz[1] = &field;
    if (field.name == "z") fields.xyz[2] = &field;
    if (field.name == "intensity") fields.intensity = &field;
    if (field.name == "time" || field.name == "t" || field.name == "timestamp" ||
        field.name == "offset_time") {
      fields.time = &field;
    }
  }
  for (const PointField* field : fields.xyz) {
    if (field == nullptr) return "the cloud has no usable fields x, y and z";
  }
  const std::size_t row = std::size_t{message.width} * message.point_step;
  if (message.height > 0 && row > 0 &&
      (message.row_step < row ||
       (message.height - 1) * std::size_t{message.row_step} + row > message.data.size())) {
    return "the cloud has fewer bytes than its size says";
  }
  return "";
}

}  // namespace

core::PointCloud to_core(const sensor_msgs::PointCloud2& message, std::string& fault) {
  core::PointCloud cloud;
  Fields fields;
  fault = fault_in(message, fields);
  if (!fault.empty()) return cloud;
  for (std::uint32_t row = 0; row < message.height; ++row) {
    for (std::uint32_t column = 0; column < message.width; ++column) {
      const std::uint8_t* point = message.data.data() + std::size_t{row} * message.row_step +
                                  std::size_t{column} * message.point_step;
      const Eigen::Vector3d place(value_in(*fields.xyz[0], point), value_in(*fields.xyz[1], point),
                                  value_in(*fields.xyz[2], point));
      double time = fields.time != nullptr ? value_in(*fields.time, point) : 0.0;
      if (!place.allFinite() || place.cwiseAbs().maxCoeff() > kFarthest || !std::isfinite(time)) continue;
      cloud.points.push_back(place);
      if (fields.intensity != nullptr) {
        const double intensity = value_in(*fields.intensity, point);
        cloud.intensity.push_back(std::isfinite(intensity) ? intensity : 0.0);
      }
      if (fields.time == nullptr) continue;
      if (fields.time->datatype < PointField::FLOAT32) time *= 1e-9;
      if (std::abs(time) > kAbsoluteTime) time -= message.header.stamp.toSec();
      cloud.time.push_back(time);
    }
  }
  return cloud;
}

}  // namespace relative_map
