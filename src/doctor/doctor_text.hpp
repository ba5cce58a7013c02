#pragma once

#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include "relative_map/geometry/angles.hpp"

// Numbers in sentences.
namespace relative_map::doctor {

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

inline std::string fixed(double value, int digits) {
  char buffer[350];  // any double fits
  std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
  const std::string number = buffer;
  const bool is_minus_zero =
      number.front() == '-' && number.find_first_of("123456789in") == std::string::npos;
  return is_minus_zero ? number.substr(1) : number;
}

inline std::string degrees(double radians) {
  return fixed(radians * 180.0 / core::kPi, 0) + " degrees";
}

inline std::string distance(double meters) {
  return std::abs(meters) < 1000.0 ? fixed(meters, 1) + " m" : fixed(meters / 1000.0, 1) + " km";
}

inline std::string place(double x, double y) {
  return "(" + fixed(x, 1) + ", " + fixed(y, 1) + ") m";
}

inline std::string quoted(const std::string& word) {
  return "'" + word + "'";
}

/// "a, b and c"
template <class Words>
std::string list(const Words& words) {
  std::string result;
  std::size_t left = words.size();
  for (const std::string& word : words) {
    result += word + (left > 2 ? ", " : left == 2 ? " and " : "");
    --left;
  }
  return result;
}

/// The first few of them: nobody reads a line of a thousand characters.
template <class Words>
std::string some(const Words& words, std::size_t most = 3) {
  if (words.size() <= most) return list(words);
  std::string result;
  std::size_t count = 0;
  for (const std::string& word : words) {
    if (count++ == most) break;
    result += word + ", ";
  }
  return result + "and " + std::to_string(words.size() - most) + " more";
}

}  // namespace relative_map::doctor
