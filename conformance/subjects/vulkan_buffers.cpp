#include "conformance/subjects/vulkan_buffers.h"

#include <cstdint>

#include "conformance/subjects/vulkan_pipelines.h"

namespace edgecase::conformance {
namespace {

using Flag = vk::MemoryPropertyFlagBits;
constexpr vk::MemoryPropertyFlags kCoherent = Flag::eHostVisible | Flag::eHostCoherent;
constexpr auto kHostMemory = vk::ExternalMemoryHandleTypeFlagBits::eHostAllocationEXT;

}  // namespace

MappedBuffer MappedBuffer::make(const VulkanDevice& opened, std::size_t size, vk::BufferUsageFlags usage) {
  const vk::raii::Device& device = opened.device();
  MappedBuffer result;
  result.buffer = vk::raii::Buffer(device, vk::BufferCreateInfo({}, size, usage));
  const vk::MemoryRequirements needs = result.buffer.getMemoryRequirements();
  // Every device has coherent memory; cached by the host where there is such.
  const auto type = memory_type(opened.physical().getMemoryProperties(), needs.memoryTypeBits,
                                {kCoherent | Flag::eHostCached, kCoherent});
  result.memory = vk::raii::DeviceMemory(device, vk::MemoryAllocateInfo(needs.size, type));
  result.buffer.bindMemory(*result.memory, 0);
  result.data = result.memory.mapMemory(0, size);
  result.size = size;
  return result;
}

std::optional<ImportedBuffer> ImportedBuffer::make(const VulkanDevice& opened, std::span<std::byte> host,
                                                   vk::BufferUsageFlags usage) {
  const std::size_t alignment = opened.host_memory_alignment();
  if (alignment == 0 || host.empty() || host.size() > opened.max_storage_bytes()) return std::nullopt;
  if (reinterpret_cast<std::uintptr_t>(host.data()) % alignment != 0 || host.size() % alignment != 0) {
    return std::nullopt;
  }
  const vk::raii::Device& device = opened.device();
  const std::uint32_t importable = device.getMemoryHostPointerPropertiesEXT(kHostMemory, host.data()).memoryTypeBits;
  const vk::ExternalMemoryBufferCreateInfo external(kHostMemory);
  vk::raii::Buffer buffer(device, vk::BufferCreateInfo({}, host.size(), usage).setPNext(&external));
  const vk::MemoryRequirements needs = buffer.getMemoryRequirements();
  const std::uint32_t allowed = needs.memoryTypeBits & importable;
  const vk::PhysicalDeviceMemoryProperties properties = opened.physical().getMemoryProperties();
  const std::uint32_t type = memory_type(properties, allowed, {kCoherent});
  const bool found =
      (allowed >> type & 1U) != 0 && (properties.memoryTypes[type].propertyFlags & kCoherent) == kCoherent;
  if (!found || needs.size > host.size()) return std::nullopt;
  const vk::ImportMemoryHostPointerInfoEXT import(kHostMemory, host.data());
  vk::raii::DeviceMemory memory(device, vk::MemoryAllocateInfo(host.size(), type).setPNext(&import));
  buffer.bindMemory(*memory, 0);
  return ImportedBuffer(host, std::move(memory), std::move(buffer));
}

}  // namespace edgecase::conformance
