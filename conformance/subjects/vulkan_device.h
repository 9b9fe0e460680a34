// A Vulkan device chosen by name, and what it says it can do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "conformance/scene/error.h"
#include "conformance/subjects/subject.h"

namespace vk::raii {
class Device;
class PhysicalDevice;
}  // namespace vk::raii

namespace edgecase::conformance {

/// Which of the devices that the loader offers.
struct VulkanSelection {
  /// Part of the device's or driver's name, in any case; empty takes the loader's first.
  std::string name;
  /// With VK_LAYER_KHRONOS_validation and its synchronization checks.
  bool validation = false;
  /// Draws into memory of the driver's own, even if it takes ours.
  bool copy_masks = false;
  /// Draws to a B8G8R8A8 image as well, which nobody reads: drivers take other paths then.
  bool colour_target = false;
};

class VulkanDevice {
 public:
  /// ErrorKind::absent if there is no loader, driver, such device, or validation layer, or if the device lacks what the
  /// coverage pass needs.
  static tl::expected<std::unique_ptr<VulkanDevice>, Error> open(const VulkanSelection& selection);
  ~VulkanDevice();

  const vk::raii::PhysicalDevice& physical() const;
  const vk::raii::Device& device() const;
  /// Of a queue family that draws; the device has one queue of it.
  std::uint32_t queue_family() const;
  /// All but the name, from the driver's own limits.
  const SubjectInfo& info() const;
  std::size_t max_storage_bytes() const;
  bool colour_target() const;
  /// Memory of the host that begins and ends at multiples of it can be imported; 0 if none can.
  std::size_t host_memory_alignment() const;

  /// The first thing that the validation layer complained of since the last call.
  std::optional<std::string> take_complaint();

 private:
  struct State;
  explicit VulkanDevice(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace edgecase::conformance
