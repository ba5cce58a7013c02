#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace relative_map::core {

// LZF, the compression of binary_compressed PCD files. By hand, since it is two short loops and the library
// for it would be one more package for users to install. The format: a control byte below 32 is followed by
// so many literal bytes and one more; any other has the length of a copy in its upper three bits (7: a byte
// more follows), and with the next byte how far back in the output it begins.

/// The `size` bytes that `packed` stands for; none if it stands for more or fewer, or for no bytes at all.
std::optional<std::string> lzf_unpacked(std::string_view packed, std::size_t size);

/// Never longer than `bytes` by more than one byte in 32.
std::string lzf_packed(std::string_view bytes);

}  // namespace relative_map::core
