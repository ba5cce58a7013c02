#pragma once

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace relative_map::core {

/// The JSON objects of a text one after the other, however they are laid out: one a line, several on a line
/// with or without commas, over many lines, or in an array. Holds one of them at a time.
class JsonStream {
 public:
  explicit JsonStream(const std::string& text);

  /// False at the end. Throws std::runtime_error, "line N: ..." with the fault.
  bool next(nlohmann::json& object);
  /// Where the last object began, from 1.
  std::size_t line() const { return line_; }

 private:
  /// The next character that is no blank, not yet taken; EOF at the end.
  int peek();
  void take_separators();
  void count_lines(std::size_t end);
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_at(std::size_t byte);

  const std::string& text_;
  std::istringstream in_;
  bool in_array_ = false, first_ = true;
  std::size_t line_ = 1, line_start_ = 0, counted_ = 0;
};

}  // namespace relative_map::core
