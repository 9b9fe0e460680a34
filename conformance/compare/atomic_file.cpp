#include "conformance/compare/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <optional>
#include <string>
#include <system_error>

namespace edgecase::conformance {
namespace {

tl::unexpected<Error> cannot_write(const std::filesystem::path& path, int error) {
  return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{}: cannot write: {}", path.string(),
                                                                std::generic_category().message(error))});
}

/// Writes everything; 0 or an errno.
int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

/// Writes everything and closes; 0 or an errno.
int write_and_close(int file, std::string_view bytes, bool to_disk) {
  int error = write_all(file, bytes);
  // Without this a crash of the machine could leave the new name with none of the bytes.
  if (error == 0 && to_disk && ::fsync(file) != 0) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  return error;
}

/// The open descriptor that a path stands for, if it is one of those names. Opening such a name again would give a file
/// offset of its own, and what the program prints would overwrite what is written here.
std::optional<int> descriptor_of(const std::filesystem::path& path) {
  const std::string name = path.string();
  if (name == "/dev/stdout") return STDOUT_FILENO;
  if (name == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    int descriptor = 0;
    if (!name.starts_with(folder)) continue;
    const char* end = name.data() + name.size();
    const auto [last, failed] = std::from_chars(name.data() + folder.size(), end, descriptor);
    if (failed == std::errc() && last == end) return descriptor;
  }
  return std::nullopt;
}

/// The mode of an existing regular file, or what a new one gets.
struct Target {
  bool stream = false;  ///< there, and neither a regular file nor a folder
  std::optional<mode_t> mode;
};

Target look_at(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  if (S_ISREG(status.st_mode)) return {false, status.st_mode & 07777};
  return {!S_ISDIR(status.st_mode), std::nullopt};
}

/// A short name of its own: one made from the file's name could be too long where the file's is not.
std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter = 0;
  return path.parent_path() / fmt::format(".edgecase-{}-{}.tmp", ::getpid(), ++counter);
}

}  // namespace

tl::expected<void, Error> write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  if (const std::optional<int> descriptor = descriptor_of(path)) {
    // What was printed before comes before.
    std::fflush(nullptr);
    const int error = write_all(*descriptor, bytes);
    if (error != 0) return cannot_write(path, error);
    return {};
  }
  const Target existing = look_at(path);
  if (existing.stream) {
    const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    const int error = file < 0 ? errno : write_and_close(file, bytes, false);
    if (error != 0) return cannot_write(path, error);
    return {};
  }
  std::error_code failed;
  std::filesystem::path target = path;
  if (std::filesystem::is_symlink(path, failed)) {
    target = std::filesystem::weakly_canonical(path, failed);
    if (failed) return cannot_write(path, failed.value());
  }
  if (std::filesystem::is_directory(target, failed)) return cannot_write(path, EISDIR);
  const std::filesystem::path temporary = temporary_beside(target);
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return cannot_write(path, errno);
  int error = existing.mode && ::fchmod(file, *existing.mode) != 0 ? errno : 0;
  if (const int written = write_and_close(file, bytes, true); error == 0) error = written;
  if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    return cannot_write(path, error);
  }
  return {};
}

}  // namespace edgecase::conformance
