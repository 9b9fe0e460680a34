#include "conformance/compare/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>

namespace edgecase::conformance {
namespace {

tl::unexpected<Error> cannot_write(const std::filesystem::path& path, int error) {
  return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{}: cannot write: {}", path.string(),
                                                                std::generic_category().message(error))});
}

/// Writes everything and closes; 0 or an errno.
int write_and_close(int file, std::string_view bytes, bool to_disk) {
  int error = 0;
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      error = errno;
      break;
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  // Without this a crash of the machine could leave the new name with none of the bytes.
  if (error == 0 && to_disk && ::fsync(file) != 0) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  return error;
}

bool is_stream(const std::filesystem::path& path) {
  struct stat status {};
  const bool there = ::stat(path.c_str(), &status) == 0;
  return (there && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) || path.string().starts_with("/dev/");
}

std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter = 0;
  return path.parent_path() / fmt::format(".{}.{}.{}.tmp", path.filename().string(), ::getpid(), ++counter);
}

}  // namespace

tl::expected<void, Error> write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  if (is_stream(path)) {
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
  int error = write_and_close(file, bytes, true);
  if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    return cannot_write(path, error);
  }
  return {};
}

}  // namespace edgecase::conformance
