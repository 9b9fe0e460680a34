#include "conformance/subjects/shared_memory.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <utility>

namespace edgecase::conformance {
namespace {

tl::unexpected<Error> failure(const char* what, std::size_t bytes) {
  return tl::unexpected(Error{
      ErrorKind::subject, fmt::format("cannot {} {} bytes of shared memory: {}", what, bytes, std::strerror(errno))});
}

// A multiple of any page's size.
constexpr std::size_t kLeastBytes = std::size_t{1} << 16;

}  // namespace

SharedMemory::SharedMemory(SharedMemory&& other) noexcept { *this = std::move(other); }

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
  if (this != &other) {
    release();
    descriptor_ = std::exchange(other.descriptor_, -1);
    data_ = std::exchange(other.data_, nullptr);
    size_ = std::exchange(other.size_, 0);
  }
  return *this;
}

SharedMemory::~SharedMemory() { release(); }

void SharedMemory::release() {
  if (data_ != nullptr) munmap(data_, size_);
  if (descriptor_ >= 0) close(descriptor_);
  data_ = nullptr;
  descriptor_ = -1;
  size_ = 0;
}

tl::expected<SharedMemory, Error> SharedMemory::create() {
  const int descriptor = memfd_create("edgecase-worker", MFD_CLOEXEC);
  if (descriptor < 0) return failure("create", 0);
  return SharedMemory(descriptor);
}

tl::expected<void, Error> SharedMemory::grow(std::size_t bytes) {
  if (bytes <= size_) return {};
  const std::size_t rounded = std::bit_ceil(std::max(bytes, kLeastBytes));
  if (ftruncate(descriptor_, static_cast<off_t>(rounded)) != 0) return failure("reserve", rounded);
  return map(rounded);
}

tl::expected<void, Error> SharedMemory::map(std::size_t bytes) {
  if (bytes <= size_) return {};
  if (data_ != nullptr) munmap(data_, size_);
  data_ = nullptr;
  size_ = 0;
  void* mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (mapped == MAP_FAILED) return failure("map", bytes);
  data_ = static_cast<std::byte*>(mapped);
  size_ = bytes;
  return {};
}

}  // namespace edgecase::conformance
