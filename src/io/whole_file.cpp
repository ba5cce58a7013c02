#include "relative_map/io/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
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

/// So that power loss does not take the new name back.
void sync_folder(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  const OpenFile file(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY | O_CLOEXEC, 0);
  if (file.opened() == 0) file.sync();  // not every file system can; the file itself is there
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
    sync_folder(followed(path));
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

void expect_not_among(const std::string& path, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code error;
    if (is_device(input)) continue;
    if (input != path && !fs::equivalent(input, path, error)) continue;
    throw std::runtime_error("cannot write " + path + ": it is read from as " + input +
                             ": name another file for the result");
  }
}

RegularFile::RegularFile(const std::string& path) : path_(path) {
  // Without waiting: a pipe that nobody writes to would be waited for for ever.
  descriptor_ = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor_ < 0) throw std::runtime_error(path + ": cannot be opened: " + std::strerror(errno));
  struct stat found = {};
  std::string fault;
  if (fstat(descriptor_, &found) != 0) {
    fault = std::string("cannot be looked at: ") + std::strerror(errno);
  } else if (S_ISDIR(found.st_mode)) {
    fault = "is a folder, not a file";
  } else if (!S_ISREG(found.st_mode)) {
    fault = "is a pipe, a device or a socket: only files are read";
  }
  if (fault.empty()) return;
  ::close(descriptor_);
  throw std::runtime_error(path + ": " + fault);
}

RegularFile::~RegularFile() {
  ::close(descriptor_);
}

std::string RegularFile::content(std::size_t most) const {
  std::string content;
  std::vector<char> part(1 << 16);
  for (;;) {
    const ssize_t count = ::read(descriptor_, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw std::runtime_error(path_ + ": reading failed: " + std::strerror(errno));
    if (count == 0) return content;
    // What the file system says of the size need not hold: a file may grow, and those in /proc say 0.
    content.append(part.data(), static_cast<std::size_t>(count));
    if (content.size() > most) {
      throw std::runtime_error(path_ + ": is larger than " + std::to_string(most >> 20) +
                               " MiB, and is not read");
    }
  }
}

std::string RegularFile::start(std::size_t count) const {
  std::string bytes(count, '\0');
  const ssize_t got = pread(descriptor_, bytes.data(), count, 0);
  bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return bytes;
}

std::string read_whole_file(const std::string& path, std::size_t most) {
  return RegularFile(path).content(most);
}

}  // namespace relative_map::core
