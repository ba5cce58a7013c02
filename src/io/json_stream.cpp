#include "json_stream.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace relative_map::core {

namespace {

constexpr char kRecordSeparator = '\x1E';  // RFC 8142, GeoJSON text sequences

bool is_blank(int c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\v' || c == '\f' || c == kRecordSeparator;
}

}  // namespace

JsonStream::JsonStream(const std::string& text) : text_(text), in_(text) {}

int JsonStream::peek() {
  while (is_blank(in_.peek())) in_.get();
  return in_.peek();
}

/// Between two objects a comma may stand; in an array it must.
void JsonStream::take_separators() {
  if (!first_ && in_array_) {
    const int c = peek();
    if (c == ']') {
      in_.get();
      in_array_ = false;
    } else if (c == ',') {
      in_.get();
    } else {
      fail_at(static_cast<std::size_t>(in_.tellg()));
    }
  } else if (!first_ && peek() == ',') {
    in_.get();
  }
  if (!in_array_ && peek() == '[') {
    in_.get();
    in_array_ = true;
    if (peek() == ']') {
      in_.get();
      in_array_ = false;
    }
  }
}

bool JsonStream::next(nlohmann::json& object) {
  take_separators();
  first_ = false;
  const int c = peek();
  if (c == std::istringstream::traits_type::eof()) {
    if (in_array_) fail_at(text_.size());
    return false;
  }
  const auto start = static_cast<std::size_t>(in_.tellg());
  count_lines(start);
  if (c != '{') {
    if (std::strchr("\"-0123456789tfn[", c) != nullptr) fail("not a JSON object");
    fail_at(start);
  }
  try {
    in_ >> object;
  } catch (const nlohmann::json::parse_error& fault) {
    fail_at(std::min(start + std::max<std::size_t>(fault.byte, 1) - 1, text_.size()));
  } catch (const nlohmann::json::exception&) {  // a number that no double can hold
    fail("not valid JSON: a number is out of range");
  }
  return true;
}

void JsonStream::count_lines(std::size_t end) {
  for (; counted_ < end; ++counted_) {
    if (text_[counted_] != '\n') continue;
    ++line_;
    line_start_ = counted_ + 1;
  }
}

void JsonStream::fail(const std::string& what) const {
  throw std::runtime_error("line " + std::to_string(line_) + ": " + what);
}

void JsonStream::fail_at(std::size_t byte) {
  count_lines(byte);
  fail("not valid JSON near column " + std::to_string(byte - line_start_ + 1));
}

}  // namespace relative_map::core
