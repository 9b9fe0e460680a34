#include "conformance/subjects/vulkan_pipelines.h"

#include <array>
#include <utility>

#include "shaders/coverage_frag_colour_primitive_id_spirv.h"
#include "shaders/coverage_frag_colour_spirv.h"
#include "shaders/coverage_frag_primitive_id_spirv.h"
#include "shaders/coverage_frag_spirv.h"
#include "shaders/coverage_vert_primitive_id_spirv.h"
#include "shaders/coverage_vert_spirv.h"

namespace edgecase::conformance {
namespace {

// Per sample count; enough for the sizes that a run alternates between.
constexpr std::size_t kKeptFramebuffers = 64;

vk::ShaderModuleCreateInfo vertex_code(bool primitive_id) {
  if (primitive_id) return {{}, coverage_vert_primitive_id_spirv};
  return {{}, coverage_vert_spirv};
}

vk::ShaderModuleCreateInfo fragment_code(bool primitive_id, bool colour) {
  if (primitive_id && colour) return {{}, coverage_frag_colour_primitive_id_spirv};
  if (primitive_id) return {{}, coverage_frag_primitive_id_spirv};
  if (colour) return {{}, coverage_frag_colour_spirv};
  return {{}, coverage_frag_spirv};
}

vk::PrimitiveTopology to_vulkan(Topology topology) {
  switch (topology) {
    case Topology::list:
      return vk::PrimitiveTopology::eTriangleList;
    case Topology::strip:
      return vk::PrimitiveTopology::eTriangleStrip;
    case Topology::fan:
      return vk::PrimitiveTopology::eTriangleFan;
  }
  return {};
}

vk::CullModeFlags to_vulkan(CullMode cull) {
  switch (cull) {
    case CullMode::none:
      return vk::CullModeFlagBits::eNone;
    case CullMode::front:
      return vk::CullModeFlagBits::eFront;
    case CullMode::back:
      return vk::CullModeFlagBits::eBack;
  }
  return {};
}

}  // namespace

std::uint32_t memory_type(const vk::PhysicalDeviceMemoryProperties& properties, std::uint32_t allowed,
                          std::initializer_list<vk::MemoryPropertyFlags> wanted) {
  for (const vk::MemoryPropertyFlags flags : wanted) {
    for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i) {
      if ((allowed >> i & 1U) != 0 && (properties.memoryTypes[i].propertyFlags & flags) == flags) return i;
    }
  }
  return 0;
}

vk::raii::RenderPass VulkanPipelines::make_render_pass(vk::SampleCountFlagBits samples) const {
  vk::SubpassDescription subpass({}, vk::PipelineBindPoint::eGraphics);
  if (!opened_.colour_target()) return {opened_.device(), vk::RenderPassCreateInfo({}, {}, subpass)};
  const vk::AttachmentDescription colour({}, kColourFormat, samples, vk::AttachmentLoadOp::eDontCare,
                                         vk::AttachmentStoreOp::eDontCare, vk::AttachmentLoadOp::eDontCare,
                                         vk::AttachmentStoreOp::eDontCare, vk::ImageLayout::eUndefined,
                                         vk::ImageLayout::eColorAttachmentOptimal);
  const vk::AttachmentReference reference(0, vk::ImageLayout::eColorAttachmentOptimal);
  subpass.setColorAttachments(reference);
  // The image is written anew by each draw, after the draw before.
  const vk::SubpassDependency order(VK_SUBPASS_EXTERNAL, 0, vk::PipelineStageFlagBits::eColorAttachmentOutput,
                                    vk::PipelineStageFlagBits::eColorAttachmentOutput,
                                    vk::AccessFlagBits::eColorAttachmentWrite,
                                    vk::AccessFlagBits::eColorAttachmentWrite);
  return {opened_.device(), vk::RenderPassCreateInfo({}, colour, subpass, order)};
}

VulkanPipelines::Pass& VulkanPipelines::pass(int samples) {
  if (const auto found = passes_.find(samples); found != passes_.end()) return found->second;
  Pass made;
  made.render_pass = make_render_pass(static_cast<vk::SampleCountFlagBits>(samples));
  return passes_.emplace(samples, std::move(made)).first->second;
}

vk::Pipeline VulkanPipelines::pipeline(const PipelineKey& key) {
  auto found = pipelines_.find(key);
  if (found == pipelines_.end()) found = pipelines_.emplace(key, make_pipeline(key)).first;
  return *found->second;
}

vk::raii::Pipeline VulkanPipelines::make_pipeline(const PipelineKey& key) {
  using Stage = vk::ShaderStageFlagBits;
  const vk::raii::Device& device = opened_.device();
  const vk::raii::ShaderModule vertex(device, vertex_code(key.primitive_id));
  const vk::raii::ShaderModule fragment(device, fragment_code(key.primitive_id, opened_.colour_target()));
  const auto count = static_cast<std::uint32_t>(key.samples);
  const vk::SpecializationMapEntry entry(0, 0, sizeof count);
  const vk::SpecializationInfo constants(1, &entry, sizeof count, &count);
  const std::array stages{vk::PipelineShaderStageCreateInfo({}, Stage::eVertex, *vertex, "main"),
                          vk::PipelineShaderStageCreateInfo({}, Stage::eFragment, *fragment, "main", &constants)};

  const vk::VertexInputBindingDescription binding(0, static_cast<std::uint32_t>(key.components * sizeof(float)),
                                                  vk::VertexInputRate::eVertex);
  // Where a format lacks components, z is 0 and w is 1.
  const vk::Format format = key.components == 2 ? vk::Format::eR32G32Sfloat : vk::Format::eR32G32B32A32Sfloat;
  const vk::VertexInputAttributeDescription position(0, 0, format, 0);
  const vk::PipelineVertexInputStateCreateInfo input({}, binding, position);
  const vk::PipelineInputAssemblyStateCreateInfo assembly({}, to_vulkan(key.topology),
                                                          key.topology == Topology::list ? VK_FALSE : VK_TRUE);
  const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
  vk::PipelineRasterizationStateCreateInfo raster;
  raster.cullMode = to_vulkan(key.cull);
  raster.frontFace =
      key.front_face == FrontFace::clockwise ? vk::FrontFace::eClockwise : vk::FrontFace::eCounterClockwise;
  raster.lineWidth = 1;
  const vk::PipelineMultisampleStateCreateInfo multisample({}, static_cast<vk::SampleCountFlagBits>(key.samples));
  using Channel = vk::ColorComponentFlagBits;
  vk::PipelineColorBlendAttachmentState written;
  // Not alpha: with all four channels llvmpipe takes a triangle that covers a whole tile of 64x64 pixels to hide
  // whatever was drawn there before, and never runs those fragments, which are to note their coverage.
  written.colorWriteMask = Channel::eR | Channel::eG | Channel::eB;
  vk::PipelineColorBlendStateCreateInfo blend;
  if (opened_.colour_target()) blend.setAttachments(written);
  const std::array dynamic{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo dynamic_state({}, dynamic);
  vk::GraphicsPipelineCreateInfo create({}, stages, &input, &assembly, nullptr, &viewport, &raster, &multisample);
  create.setPColorBlendState(&blend).setPDynamicState(&dynamic_state).setLayout(layout_);
  create.setRenderPass(render_pass(key.samples));
  return {device, nullptr, create};
}

void VulkanPipelines::add_colour_image(vk::SampleCountFlagBits samples, const vk::Extent2D& extent,
                                       Target& target) const {
  const vk::raii::Device& device = opened_.device();
  const vk::ImageCreateInfo create({}, vk::ImageType::e2D, kColourFormat, {extent.width, extent.height, 1}, 1, 1,
                                   samples, vk::ImageTiling::eOptimal, vk::ImageUsageFlagBits::eColorAttachment);
  target.image = vk::raii::Image(device, create);
  const vk::MemoryRequirements needs = target.image.getMemoryRequirements();
  const auto type = memory_type(opened_.physical().getMemoryProperties(), needs.memoryTypeBits,
                                {vk::MemoryPropertyFlagBits::eDeviceLocal, vk::MemoryPropertyFlags{}});
  target.memory = vk::raii::DeviceMemory(device, vk::MemoryAllocateInfo(needs.size, type));
  target.image.bindMemory(*target.memory, 0);
  const vk::ImageSubresourceRange whole(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1);
  target.view = vk::raii::ImageView(
      device, vk::ImageViewCreateInfo({}, *target.image, vk::ImageViewType::e2D, kColourFormat, {}, whole));
}

vk::Framebuffer VulkanPipelines::framebuffer(int samples, const Extent& target) {
  Pass& used = pass(samples);
  const std::pair key(target.width, target.height);
  if (const auto found = used.targets.find(key); found != used.targets.end()) return *found->second.framebuffer;
  if (used.targets.size() == kKeptFramebuffers) used.targets.clear();
  const vk::Extent2D extent(static_cast<std::uint32_t>(target.width), static_cast<std::uint32_t>(target.height));
  Target made;
  vk::FramebufferCreateInfo create({}, *used.render_pass, {}, extent.width, extent.height, 1);
  if (opened_.colour_target()) {
    add_colour_image(static_cast<vk::SampleCountFlagBits>(samples), extent, made);
    create.setAttachments(*made.view);
  }
  made.framebuffer = vk::raii::Framebuffer(opened_.device(), create);
  return *used.targets.emplace(key, std::move(made)).first->second.framebuffer;
}

}  // namespace edgecase::conformance
