// Buffers that this process sees: a driver's own memory, mapped, and memory of ours that a driver works in.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vulkan/vulkan_raii.hpp>

#include "conformance/subjects/vulkan_device.h"

namespace edgecase::conformance {

/// A buffer in coherent memory that stays mapped.
struct MappedBuffer {
  vk::raii::DeviceMemory memory{nullptr};
  vk::raii::Buffer buffer{nullptr};
  void* data = nullptr;
  std::size_t size = 0;

  static MappedBuffer make(const VulkanDevice& opened, std::size_t size, vk::BufferUsageFlags usage);
};

/// A buffer of which the memory is ours (VK_EXT_external_memory_host): what is drawn need not be copied out of it.
class ImportedBuffer {
 public:
  /// Nothing if the device does not take that memory.
  static std::optional<ImportedBuffer> make(const VulkanDevice& opened, std::span<std::byte> host,
                                            vk::BufferUsageFlags usage);

  vk::Buffer buffer() const { return *buffer_; }
  /// Where `part` begins in the buffer; nothing if it does not lie in it.
  template <class Element>
  std::optional<vk::DeviceSize> offset_of(std::span<Element> part) const {
    const auto bytes = std::as_bytes(part);
    const std::byte* const end = host_.data() + host_.size();
    if (bytes.data() < host_.data() || bytes.data() + bytes.size() > end) return std::nullopt;
    return static_cast<vk::DeviceSize>(bytes.data() - host_.data());
  }

 private:
  ImportedBuffer(std::span<std::byte> host, vk::raii::DeviceMemory memory, vk::raii::Buffer buffer)
      : host_(host), memory_(std::move(memory)), buffer_(std::move(buffer)) {}

  std::span<std::byte> host_;
  vk::raii::DeviceMemory memory_;
  vk::raii::Buffer buffer_;
};

}  // namespace edgecase::conformance
