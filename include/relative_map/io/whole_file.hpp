#pragma once

#include <string>

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

/// The file's content; throws std::runtime_error, one sentence, if it is absent, a folder, or unreadable.
std::string read_whole_file(const std::string& path);

}  // namespace relative_map::core
