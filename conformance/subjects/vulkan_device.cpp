#include "conformance/subjects/vulkan_device.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <mutex>
#include <utility>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "conformance/scene/setting.h"
#include "conformance/subjects/enclosing_viewport.h"
#include "conformance/subjects/vulkan_pipelines.h"

namespace edgecase::conformance {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

// What the validation layer said; its callback may come from any thread.
class Complaints {
 public:
  void add(const char* text) {
    const std::lock_guard lock(mutex_);
    if (!first_) first_ = text;
  }
  std::optional<std::string> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(first_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::optional<std::string> first_;
};

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* complaints) {
  static_cast<Complaints*>(complaints)->add(data->pMessage);
  return VK_FALSE;
}

tl::unexpected<Error> absent(std::string message) {
  return tl::unexpected(Error{ErrorKind::absent, std::move(message)});
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

struct Candidate {
  vk::raii::PhysicalDevice device;
  std::string name;    // "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string driver;  // "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"

  explicit Candidate(vk::raii::PhysicalDevice physical) : device(std::move(physical)) {
    const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
    const auto& driver_properties = chain.get<vk::PhysicalDeviceDriverProperties>();
    name = chain.get<vk::PhysicalDeviceProperties2>().properties.deviceName.data();
    driver = fmt::format("{} {}", driver_properties.driverName.data(), driver_properties.driverInfo.data());
  }
  bool is_called(const std::string& part) const {
    return lower(name).find(lower(part)) != std::string::npos || lower(driver).find(lower(part)) != std::string::npos;
  }
};

// Of images of kColourFormat to draw to. Empty where there are none.
vk::ImageFormatProperties colour_images(const vk::raii::PhysicalDevice& device) {
  try {
    return device.getImageFormatProperties(kColourFormat, vk::ImageType::e2D, vk::ImageTiling::eOptimal,
                                           vk::ImageUsageFlagBits::eColorAttachment);
  } catch (const vk::FormatNotSupportedError&) {
    return {};
  }
}

std::vector<int> sample_counts(const vk::PhysicalDeviceLimits& limits, vk::SampleCountFlags offered) {
  std::vector<int> counts;
  for (const int count : {1, 2, 4, 8, 16}) {
    const bool has = static_cast<bool>(offered & static_cast<vk::SampleCountFlagBits>(count));
    // One sample lies in the pixel's centre in every driver; where several lie is known only of the standard ones.
    if (has && (count == 1 || limits.standardSampleLocations != VK_FALSE)) counts.push_back(count);
  }
  return counts;
}

// A colour image of 16,384 pixels a side would take a gibibyte.
constexpr std::uint32_t kMaxColourTarget = 4096;

SubjectInfo describe(const Candidate& candidate, bool colour_target) {
  const vk::PhysicalDeviceLimits limits = candidate.device.getProperties().limits;
  SubjectInfo info;
  info.device = fmt::format("{}, {}", candidate.name, candidate.driver);
  info.rules.subpixel_bits = static_cast<int>(limits.subPixelPrecisionBits);
  std::uint32_t max_target =
      std::min({limits.maxFramebufferWidth, limits.maxFramebufferHeight, static_cast<std::uint32_t>(kMaxTargetExtent)});
  vk::SampleCountFlags offered = limits.framebufferNoAttachmentsSampleCounts;
  if (colour_target) {
    const vk::ImageFormatProperties images = colour_images(candidate.device);
    max_target = std::min({max_target, images.maxExtent.width, images.maxExtent.height, kMaxColourTarget});
    offered = limits.framebufferColorSampleCounts & images.sampleCounts;
  }
  info.sample_counts = sample_counts(limits, offered);
  info.max_target = static_cast<int>(max_target);
  info.scissor = true;
  info.cull = true;
  // gl_PrimitiveID needs them.
  info.assembly = candidate.device.getFeatures().geometryShader != VK_FALSE;
  info.clip = true;
  info.flipped_viewport = true;
  info.max_viewport = static_cast<float>(std::min(limits.maxViewportDimensions[0], limits.maxViewportDimensions[1]));
  info.viewport_bound = std::min(-limits.viewportBoundsRange[0], limits.viewportBoundsRange[1]);
  // The viewport spans [-half, half]: its size and both its ends are limited.
  const auto extent = static_cast<std::uint32_t>(std::min(info.max_viewport, 2 * info.viewport_bound));
  info.max_coordinate = static_cast<double>(EnclosingViewport::within(extent).half());
  return info;
}

bool has_extension(const vk::raii::PhysicalDevice& physical, std::string_view name) {
  return std::ranges::any_of(physical.enumerateDeviceExtensionProperties(), [&](const vk::ExtensionProperties& e) {
    return std::string_view(e.extensionName.data()) == name;
  });
}

std::optional<std::uint32_t> drawing_family(const vk::raii::PhysicalDevice& physical) {
  const auto families = physical.getQueueFamilyProperties();
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if (families[i].queueFlags & vk::QueueFlagBits::eGraphics) return i;
  }
  return std::nullopt;
}

}  // namespace

struct VulkanDevice::State {
  Complaints complaints;  // outlives the messenger that writes to it
  vk::raii::Context context;
  vk::raii::Instance instance{nullptr};
  vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
  vk::raii::PhysicalDevice physical{nullptr};
  vk::raii::Device device{nullptr};
  std::uint32_t queue_family = 0;
  SubjectInfo info;
  std::size_t max_storage_bytes = 0;
  bool colour_target = false;
  std::size_t host_memory_alignment = 0;

  void create_instance(bool validation);
  tl::expected<void, Error> choose(const VulkanSelection& selection);
  tl::expected<void, Error> create_device(bool copy_masks);
};

void VulkanDevice::State::create_instance(bool validation) {
  const vk::ApplicationInfo application("edgecase", 1, nullptr, 0, VK_API_VERSION_1_2);
  vk::InstanceCreateInfo create({}, &application);
  if (!validation) {
    instance = vk::raii::Instance(context, create);
    return;
  }
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  const vk::DebugUtilsMessengerCreateInfoEXT listen({}, Severity::eWarning | Severity::eError,
                                                    Type::eValidation | Type::ePerformance, &on_message, &complaints);
  const auto synchronization = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const vk::ValidationFeaturesEXT features(synchronization, {}, &listen);
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  create.setPEnabledLayerNames(kValidationLayer).setPEnabledExtensionNames(extension).setPNext(&features);
  instance = vk::raii::Instance(context, create);
  messenger = vk::raii::DebugUtilsMessengerEXT(instance, listen);
}

tl::expected<void, Error> VulkanDevice::State::choose(const VulkanSelection& selection) {
  const std::string& name = selection.name;
  std::vector<Candidate> candidates;
  for (vk::raii::PhysicalDevice& offered : vk::raii::PhysicalDevices(instance)) {
    if (offered.getProperties().apiVersion >= VK_API_VERSION_1_2) candidates.emplace_back(std::move(offered));
  }
  const auto found =
      std::ranges::find_if(candidates, [&](const Candidate& c) { return name.empty() || c.is_called(name); });
  if (found == candidates.end()) {
    std::vector<std::string> names;
    for (const Candidate& c : candidates) names.push_back(c.name);
    return absent(fmt::format("no Vulkan 1.2 device is called \"{}\"; the loader offers: {}", name,
                              names.empty() ? "none" : fmt::format("{}", fmt::join(names, "; "))));
  }
  info = describe(*found, selection.colour_target);
  colour_target = selection.colour_target;
  const auto properties =
      found->device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceMaintenance3Properties>();
  max_storage_bytes =
      std::min<std::size_t>(properties.get<vk::PhysicalDeviceProperties2>().properties.limits.maxStorageBufferRange,
                            properties.get<vk::PhysicalDeviceMaintenance3Properties>().maxMemoryAllocationSize);
  physical = std::move(found->device);
  return {};
}

tl::expected<void, Error> VulkanDevice::State::create_device(bool copy_masks) {
  const auto family = drawing_family(physical);
  if (!family || physical.getFeatures().fragmentStoresAndAtomics == VK_FALSE || info.sample_counts.empty()) {
    return absent(
        fmt::format("the device {} cannot draw without attachments or write from fragment shaders", info.device));
  }
  queue_family = *family;
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue({}, queue_family, 1, &priority);
  vk::PhysicalDeviceFeatures features;
  features.fragmentStoresAndAtomics = VK_TRUE;
  features.geometryShader = info.assembly ? VK_TRUE : VK_FALSE;
  vk::DeviceCreateInfo create({}, queue, {}, {}, &features);
  static constexpr const char* kHostMemory = VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME;
  if (!copy_masks && has_extension(physical, kHostMemory)) {
    using Properties = vk::PhysicalDeviceExternalMemoryHostPropertiesEXT;
    const auto chain = physical.getProperties2<vk::PhysicalDeviceProperties2, Properties>();
    host_memory_alignment = chain.get<Properties>().minImportedHostPointerAlignment;
    create.setPEnabledExtensionNames(kHostMemory);
  }
  device = vk::raii::Device(physical, create);
  return {};
}

tl::expected<std::unique_ptr<VulkanDevice>, Error> VulkanDevice::open(const VulkanSelection& selection) {
  std::unique_ptr<State> state;
  try {
    state = std::make_unique<State>();
  } catch (const std::exception&) {
    return absent("no Vulkan loader, libvulkan.so.1; the Debian package libvulkan1 brings it");
  }
  try {
    state->create_instance(selection.validation);
    if (auto chosen = state->choose(selection); !chosen) return tl::unexpected(chosen.error());
    if (auto created = state->create_device(selection.copy_masks); !created) return tl::unexpected(created.error());
  } catch (const vk::LayerNotPresentError&) {
    return absent(
        fmt::format("no Vulkan layer {}; the Debian package vulkan-validationlayers brings it", kValidationLayer));
  } catch (const vk::IncompatibleDriverError&) {
    return absent("Vulkan's loader finds no driver");
  } catch (const vk::SystemError& error) {
    return tl::unexpected(Error{ErrorKind::subject, fmt::format("Vulkan cannot be set up: {}", error.what())});
  }
  return std::unique_ptr<VulkanDevice>(new VulkanDevice(std::move(state)));
}

VulkanDevice::VulkanDevice(std::unique_ptr<State> state) : state_(std::move(state)) {}
VulkanDevice::~VulkanDevice() = default;

const vk::raii::PhysicalDevice& VulkanDevice::physical() const { return state_->physical; }
const vk::raii::Device& VulkanDevice::device() const { return state_->device; }
std::uint32_t VulkanDevice::queue_family() const { return state_->queue_family; }
const SubjectInfo& VulkanDevice::info() const { return state_->info; }
std::size_t VulkanDevice::max_storage_bytes() const { return state_->max_storage_bytes; }
std::size_t VulkanDevice::host_memory_alignment() const { return state_->host_memory_alignment; }
bool VulkanDevice::colour_target() const { return state_->colour_target; }
std::optional<std::string> VulkanDevice::take_complaint() { return state_->complaints.take(); }

}  // namespace edgecase::conformance
