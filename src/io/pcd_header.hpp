#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace relative_map::core {

/// One column of a PCD file.
struct PcdField {
  std::string name;
  std::size_t size = 4;    ///< [bytes] of one value: 1, 2, 4 or 8
  char type = 'F';         ///< I, U or F
  std::size_t count = 1;   ///< values a point
  std::size_t offset = 0;  ///< [bytes] in a point
  std::size_t column = 0;  ///< of its first value in a line of ascii
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::size_t point_size = 0;  ///< [bytes]
  std::size_t columns = 0;     ///< values a point
  std::string data;            ///< ascii, binary or binary_compressed
  std::size_t length = 0;      ///< [bytes] of the header itself
};

/// Throws std::runtime_error, a sentence without the path.
PcdHeader parse_pcd_header(std::string_view content);

/// One value out of memory of at least `field.size` bytes.
double pcd_value(const PcdField& field, const char* memory);

}  // namespace relative_map::core
