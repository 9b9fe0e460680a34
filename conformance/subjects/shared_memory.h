// A growing piece of memory that two processes see.
#pragma once

#include <cstddef>
#include <tl/expected.hpp>

#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// An anonymous memory file and this process's mapping of it. Move-only.
class SharedMemory {
 public:
  SharedMemory() = default;
  /// Takes over a descriptor that another process made.
  explicit SharedMemory(int descriptor) : descriptor_(descriptor) {}
  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  ~SharedMemory();

  static tl::expected<SharedMemory, Error> create();

  /// Makes the file at least `bytes` long, for both processes. The content up to the old length stays.
  tl::expected<void, Error> grow(std::size_t bytes);

  /// Maps the first `bytes` of a file that the other process has grown; does nothing if they are mapped already.
  tl::expected<void, Error> map(std::size_t bytes);

  int descriptor() const { return descriptor_; }
  std::size_t size() const { return size_; }
  std::byte* data() const { return data_; }

 private:
  void release();

  int descriptor_ = -1;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace edgecase::conformance
