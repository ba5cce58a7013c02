#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace relative_map::core {

/// Puts `content` where `path` is, whole or not at all: it goes to a file beside it, onto the disk, and only
/// then to its name. A link is followed, the mode of a file that is replaced is kept, and a device or pipe is
/// written to directly. Throws std::runtime_error, one sentence with the path and the fault; what was there
/// is then untouched.
void write_whole_file(const std::string& path, const std::string& content);

/// Throws as write_whole_file() would if nothing could be written to `path`, and writes nothing: to be asked
/// before long work.
void expect_writable(const std::string& path);

/// Whether a device or pipe is at `path`.
bool is_device(const std::string& path);

/// A name beside `path` for what will be renamed to it, that no other process takes.
std::string temporary_name(const std::string& path);

/// Moves a finished file, synced to the disk, to `path`, with the same guarantees. Removes it on failure.
void move_into_place(const std::string& temporary, const std::string& path);

/// Throws if `path` is one of `inputs`, by whatever name or link: a result must not take the place of what it
/// was made of.
void expect_not_among(const std::string& path, const std::vector<std::string>& inputs);

/// A regular file that is open for reading, and nothing else: a pipe could let the caller wait for ever, and
/// a device give bytes without end. Opening never waits. Throws std::runtime_error, one sentence with the
/// path.
class RegularFile {
 public:
  explicit RegularFile(const std::string& path);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  /// Throws if there are more than `most` bytes, or reading fails.
  std::string content(std::size_t most) const;
  /// The first `count` bytes, or all if there are fewer.
  std::string start(std::size_t count) const;

 private:
  std::string path_;
  int descriptor_;
};

/// A line of 500 km with a point each half metre, and all of its fields.
constexpr std::size_t kLargestFile = std::size_t{160} << 20;  // [bytes]

/// The content of a regular file; throws as RegularFile does.
std::string read_whole_file(const std::string& path, std::size_t most = kLargestFile);

}  // namespace relative_map::core
