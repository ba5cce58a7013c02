#include "relative_map/io/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace relative_map::core {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, int error) {
  throw std::runtime_error("cannot write " + path + ": " + std::strerror(error));
}

/// A file that is open for writing, closed in any case.
class OpenFile {
 public:
  OpenFile(const std::string& path, int flags, mode_t mode) : descriptor_(open(path.c_str(), flags, mode)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  /// All of these give 0 or an error number.
  int opened() const { return descriptor_ >= 0 ? 0 : errno; }
  int write(const std::string& content) const {
    std::size_t done = 0;
    while (done < content.size()) {
      const ssize_t written = ::write(descriptor_, content.data() + done, content.size() - done);
      if (written < 0 && errno != EINTR) return errno;
      if (written > 0) done += static_cast<std::size_t>(written);
    }
    return 0;
  }
  int sync() const { return fsync(descriptor_) == 0 ? 0 : errno; }
  int set_mode(mode_t mode) const { return fchmod(descriptor_, mode) == 0 ? 0 : errno; }
  int close() {
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    return result == 0 ? 0 : errno;
  }

 private:
  int descriptor_;
};

/// Where a link leads, also if nothing is there yet.
std::string followed(const std::string& path) {
  std::error_code error;
  const fs::path target = fs::weakly_canonical(path, error);
  return error ? path : target.string();
}

/// Throws if what is at `path` must not be replaced.
void expect_replaceable(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return;
  if (fs::is_directory(status)) fail(path, EISDIR);
  // Renaming would get around a file's own mode.
  if (access(path.c_str(), W_OK) != 0) fail(path, errno);
}

void write_device(const std::string& path, const std::string& content) {
  OpenFile file(path, O_WRONLY, 0);
  int error = file.opened();
  if (error == 0) error = file.write(content);
  if (error == 0) error = file.close();
  if (error != 0) fail(path, error);
}

int write_synced(const std::string& path, const std::string& content) {
  OpenFile file(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  int error = file.opened();
  if (error == 0) error = file.write(content);
  if (error == 0) error = file.sync();
  if (error == 0) error = file.close();
  return error;
}

}  // namespace

bool is_device(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::is_character_file(status) || fs::is_fifo(status);
}

void expect_writable(const std::string& path) {
  if (is_device(path)) {
    if (access(path.c_str(), W_OK) != 0) fail(path, errno);
    return;
  }
  expect_replaceable(path);
  fs::path folder = fs::path(followed(path)).parent_path();
  if (folder.empty()) folder = ".";
  std::error_code error;
  if (access(folder.c_str(), F_OK) != 0) fail(path, errno);
  if (!fs::is_directory(folder, error)) fail(path, ENOTDIR);
  if (access(folder.c_str(), W_OK | X_OK) != 0) fail(path, errno);
}

std::string temporary_name(const std::string& path) {
  return followed(path) + ".tmp." + std::to_string(getpid());
}

void move_into_place(const std::string& temporary, const std::string& path) {
  try {
    expect_replaceable(path);
    {
      const OpenFile file(temporary, O_WRONLY | O_CLOEXEC, 0);
      int error = file.opened();
      struct stat old = {};
      if (error == 0 && stat(path.c_str(), &old) == 0) error = file.set_mode(old.st_mode & 07777);
      if (error == 0) error = file.sync();
      if (error != 0) fail(path, error);
    }
    if (std::rename(temporary.c_str(), followed(path).c_str()) != 0) fail(path, errno);
  } catch (const std::runtime_error&) {
    unlink(temporary.c_str());
    throw;
  }
}

void write_whole_file(const std::string& path, const std::string& content) {
  expect_writable(path);
  if (is_device(path)) return write_device(path, content);
  const std::string temporary = temporary_name(path);
  if (const int error = write_synced(temporary, content); error != 0) {
    unlink(temporary.c_str());
    fail(path, error);
  }
  move_into_place(temporary, path);
}

std::string read_whole_file(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw std::runtime_error(path + ": is a folder, not a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error(path + ": cannot be opened: " + std::strerror(errno));
  std::ostringstream content;
  if (stream.peek() != std::ifstream::traits_type::eof()) content << stream.rdbuf();
  if (stream.bad() || !content) throw std::runtime_error(path + ": reading failed");
  return content.str();
}

}  // namespace relative_map::core
