// Render passes, pipelines and framebuffers of the coverage pass, made when first asked for.
#pragma once

#include <compare>
#include <map>
#include <vulkan/vulkan_raii.hpp>

#include "conformance/scene/scene.h"
#include "conformance/subjects/vulkan_device.h"

namespace edgecase::conformance {

/// Of VulkanSelection::colour_target.
inline constexpr vk::Format kColourFormat = vk::Format::eB8G8R8A8Unorm;

/// What a pipeline is made for.
struct PipelineKey {
  int samples = 1;
  CullMode cull = CullMode::none;
  FrontFace front_face = FrontFace::clockwise;
  Topology topology = Topology::list;
  /// Triangles are numbered by gl_PrimitiveID instead of by threes of vertices.
  bool primitive_id = false;
  /// Of a vertex: as in Primitives.
  std::size_t components = 4;
  auto operator<=>(const PipelineKey&) const = default;
};

class VulkanPipelines {
 public:
  VulkanPipelines(const VulkanDevice& opened, vk::PipelineLayout layout) : opened_(opened), layout_(layout) {}

  vk::RenderPass render_pass(int samples) { return *pass(samples).render_pass; }
  vk::Pipeline pipeline(const PipelineKey& key);
  vk::Framebuffer framebuffer(int samples, const Extent& target);

 private:
  struct Target {
    vk::raii::Image image{nullptr};
    vk::raii::DeviceMemory memory{nullptr};
    vk::raii::ImageView view{nullptr};
    vk::raii::Framebuffer framebuffer{nullptr};
  };
  // What depends on the sample count.
  struct Pass {
    vk::raii::RenderPass render_pass{nullptr};
    std::map<std::pair<int, int>, Target> targets;
  };

  Pass& pass(int samples);
  vk::raii::RenderPass make_render_pass(vk::SampleCountFlagBits samples) const;
  vk::raii::Pipeline make_pipeline(const PipelineKey& key);
  void add_colour_image(vk::SampleCountFlagBits samples, const vk::Extent2D& extent, Target& target) const;

  const VulkanDevice& opened_;
  vk::PipelineLayout layout_;
  std::map<int, Pass> passes_;
  std::map<PipelineKey, vk::raii::Pipeline> pipelines_;
};

/// The first memory type of those `allowed` that has one of the sets of properties `wanted`, tried in their order; 0 if
/// there is none.
std::uint32_t memory_type(const vk::PhysicalDeviceMemoryProperties& properties, std::uint32_t allowed,
                          std::initializer_list<vk::MemoryPropertyFlags> wanted);

}  // namespace edgecase::conformance
