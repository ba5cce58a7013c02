#include "relative_map/io/lzf.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace relative_map::core {

namespace {

constexpr std::size_t kLongestLiteral = 32;
constexpr std::size_t kShortestCopy = 3;
constexpr std::size_t kLongestCopy = 264;  // 7 + 255, and the two that every copy has
constexpr std::size_t kFarthest = 8192;    // 13 bits

std::uint8_t byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<std::uint8_t>(bytes[i]);
}

void put_literals(std::string_view bytes, std::string& packed) {
  while (!bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), kLongestLiteral);
    packed.push_back(static_cast<char>(count - 1));
    packed.append(bytes.substr(0, count));
    bytes.remove_prefix(count);
  }
}

void put_copy(std::size_t length, std::size_t back, std::string& packed) {
  const std::size_t offset = back - 1;
  const std::size_t more = length - 2;
  const auto high = static_cast<std::uint8_t>(offset >> 8);
  if (more < 7) {
    packed.push_back(static_cast<char>((more << 5) | high));
  } else {
    packed.push_back(static_cast<char>((7u << 5) | high));
    packed.push_back(static_cast<char>(more - 7));
  }
  packed.push_back(static_cast<char>(offset & 0xff));
}

}  // namespace

std::optional<std::string> lzf_unpacked(std::string_view packed, std::size_t size) {
  std::string bytes;
  bytes.reserve(size);
  std::size_t i = 0;
  while (i < packed.size()) {
    const std::size_t control = byte_at(packed, i++);
    if (control < 32) {
      const std::size_t count = control + 1;
      if (count > packed.size() - i || count > size - bytes.size()) return std::nullopt;
      bytes.append(packed.substr(i, count));
      i += count;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) {
      if (i >= packed.size()) return std::nullopt;
      length += byte_at(packed, i++);
    }
    length += 2;
    if (i >= packed.size()) return std::nullopt;
    const std::size_t back = ((control & 31) << 8) + byte_at(packed, i++) + 1;
    if (back > bytes.size() || length > size - bytes.size()) return std::nullopt;
    // Byte by byte: a copy may reach into what it has just written.
    for (std::size_t k = 0; k < length; ++k) bytes.push_back(bytes[bytes.size() - back]);
  }
  if (bytes.size() != size) return std::nullopt;
  return bytes;
}

std::string lzf_packed(std::string_view bytes) {
  constexpr std::size_t kTable = 1 << 14;
  constexpr std::size_t kNowhere = ~std::size_t{0};
  std::vector<std::size_t> last_seen(kTable, kNowhere);
  std::string packed;
  std::size_t literals_from = 0;
  std::size_t i = 0;
  while (i + kShortestCopy <= bytes.size()) {
    const std::uint32_t three =
        byte_at(bytes, i) | (byte_at(bytes, i + 1) << 8) | (byte_at(bytes, i + 2) << 16);
    std::size_t& seen = last_seen[(three * 2654435761u) >> 18];
    const std::size_t candidate = seen;
    seen = i;
    std::size_t length = 0;
    if (candidate != kNowhere && i - candidate <= kFarthest) {
      const std::size_t most = std::min(kLongestCopy, bytes.size() - i);
      while (length < most && bytes[candidate + length] == bytes[i + length]) ++length;
    }
    if (length < kShortestCopy) {
      ++i;
      continue;
    }
    put_literals(bytes.substr(literals_from, i - literals_from), packed);
    put_copy(length, i - candidate, packed);
    i += length;
    literals_from = i;
  }
  put_literals(bytes.substr(literals_from), packed);
  return packed;
}

}  // namespace relative_map::core
