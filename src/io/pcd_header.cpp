#include "pcd_header.hpp"

#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/text.hpp"

namespace relative_map::core {

namespace {

constexpr std::size_t kMostPoints = 400'000'000;  // more than any memory holds
constexpr std::size_t kMostFields = 256;

[[noreturn]] void refuse(const std::string& why) {
  throw std::runtime_error("is no usable PCD file: " + why);
}

std::size_t whole_number(const std::string& word, const std::string& of, std::size_t most) {
  const std::optional<double> number = parse_number(word);
  if (!number || *number < 0.0 || *number > static_cast<double>(most) || *number != std::size_t(*number)) {
    refuse(of + " says '" + word.substr(0, 40) + "', which is no number up to " + std::to_string(most));
  }
  return static_cast<std::size_t>(*number);
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// The words behind the key, one for each field.
const std::vector<std::string>& one_each(const std::vector<std::string>& words, std::size_t fields) {
  if (words.size() != fields + 1) {
    refuse(words[0] + " has " + std::to_string(words.size() - 1) + " entries, but there are " +
           std::to_string(fields) + " fields");
  }
  return words;
}

void settle(PcdHeader& header) {
  for (PcdField& field : header.fields) {
    const bool known = field.type == 'F'
                           ? field.size == 4 || field.size == 8
                           : (field.type == 'I' || field.type == 'U') &&
                                 (field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8);
    if (!known) {
      refuse("field '" + field.name + "' has the type " + field.type + " of " + std::to_string(field.size) +
             " bytes, which does not exist");
    }
    field.offset = header.point_size;
    field.column = header.columns;
    header.point_size += field.size * field.count;
    header.columns += field.count;
  }
}

template <class Number>
double value_of(const char* memory) {
  Number number;
  std::memcpy(&number, memory, sizeof(number));
  return static_cast<double>(number);
}

}  // namespace

PcdHeader parse_pcd_header(std::string_view content) {
  PcdHeader header;
  std::size_t width = 0, height = 1;
  bool has_points = false, has_width = false;
  while (header.data.empty()) {
    const std::size_t end = content.find('\n', header.length);
    if (end == std::string_view::npos || end - header.length > 65536) refuse("its header has no end");
    const std::vector<std::string> words =
        words_of(std::string(content.substr(header.length, end - header.length)));
    header.length = end + 1;
    if (words.empty() || words[0][0] == '#') continue;
    const std::string& key = words[0];
    if (key == "FIELDS" || key == "COLUMNS") {
      if (words.size() > kMostFields || !header.fields.empty()) refuse("its FIELDS make no sense");
      for (std::size_t i = 1; i < words.size(); ++i) header.fields.emplace_back().name = words[i];
    } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
      one_each(words, header.fields.size());
      for (std::size_t i = 1; i < words.size(); ++i) {
        PcdField& field = header.fields[i - 1];
        if (key == "SIZE") field.size = whole_number(words[i], key, 8);
        if (key == "TYPE") field.type = words[i][0];
        if (key == "COUNT") field.count = whole_number(words[i], key, 65536);
      }
    } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS" || key == "DATA") {
      if (words.size() != 2) refuse(key + " needs one value");
      if (key == "DATA") {
        header.data = words[1];
      } else {
        const std::size_t number = whole_number(words[1], key, kMostPoints);
        (key == "POINTS" ? header.points : key == "WIDTH" ? width : height) = number;
        has_points = has_points || key == "POINTS";
        has_width = has_width || key == "WIDTH";
      }
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      refuse("its header has the line '" + key.substr(0, 40) + "'");
    }
  }
  if (header.fields.empty()) refuse("it has no FIELDS");
  if (!has_points && !has_width) refuse("it does not say how many points it has");
  if (!has_points) header.points = width * height;
  if (has_width && width * height != header.points) {
    refuse("POINTS is " + std::to_string(header.points) + ", but WIDTH times HEIGHT is " +
           std::to_string(width * height));
  }
  if (header.points > kMostPoints) refuse("it says that it has " + std::to_string(header.points) + " points");
  if (header.data != "ascii" && header.data != "binary" && header.data != "binary_compressed") {
    refuse("its DATA is '" + header.data.substr(0, 40) + "', not ascii, binary or binary_compressed");
  }
  settle(header);
  return header;
}

double pcd_value(const PcdField& field, const char* memory) {
  if (field.type == 'F') return field.size == 4 ? value_of<float>(memory) : value_of<double>(memory);
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? value_of<std::int8_t>(memory) : value_of<std::uint8_t>(memory);
    case 2:
      return is_signed ? value_of<std::int16_t>(memory) : value_of<std::uint16_t>(memory);
    case 4:
      return is_signed ? value_of<std::int32_t>(memory) : value_of<std::uint32_t>(memory);
    default:
      return is_signed ? value_of<std::int64_t>(memory) : value_of<std::uint64_t>(memory);
  }
}

}  // namespace relative_map::core
