#include "conformance/subjects/vulkan_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <map>
#include <utility>
#include <vulkan/vulkan_raii.hpp>

#include "conformance/scene/mask.h"
#include "conformance/subjects/enclosing_viewport.h"
#include "shaders/coverage_frag_spirv.h"
#include "shaders/coverage_vert_spirv.h"

namespace edgecase::conformance {
namespace {

// As `Layout` in coverage.frag.
struct PushConstants {
  std::uint32_t row_words;  // 32-bit words
  std::uint32_t rows;
};

// Per sample count; enough for the sizes that a run alternates between.
constexpr std::size_t kKeptFramebuffers = 64;

// A buffer in coherent memory that stays mapped.
struct MappedBuffer {
  vk::raii::Buffer buffer{nullptr};
  vk::raii::DeviceMemory memory{nullptr};
  void* data = nullptr;
  std::size_t size = 0;
};

// Host-visible and coherent memory, which every device has, and cached by the host where there is such.
std::uint32_t mappable_type(const vk::PhysicalDeviceMemoryProperties& properties, std::uint32_t allowed) {
  using Flag = vk::MemoryPropertyFlagBits;
  const vk::MemoryPropertyFlags needed = Flag::eHostVisible | Flag::eHostCoherent;
  for (const auto wanted : {needed | Flag::eHostCached, needed}) {
    for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i) {
      if ((allowed >> i & 1U) != 0 && (properties.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
  }
  return 0;
}

class VulkanDriver final : public Driver {
 public:
  explicit VulkanDriver(std::unique_ptr<VulkanDevice> opened);

  const SubjectInfo& info() const override { return opened_->info(); }
  std::size_t max_mask_bytes() const override { return opened_->max_storage_bytes(); }
  tl::expected<double, Error> draw(const Setting& setting, std::span<const Triangle> triangles,
                                   std::span<std::uint64_t> masks) override;

 private:
  // What depends on the sample count, and the framebuffers of that count.
  struct Pass {
    vk::raii::RenderPass render_pass{nullptr};
    vk::raii::Pipeline pipeline{nullptr};
    std::map<std::pair<int, int>, vk::raii::Framebuffer> framebuffers;
  };
  // What the command buffer was recorded for.
  struct Recorded {
    MaskLayout layout{Setting{}};
    std::size_t triangles = 0;
    friend bool operator==(const Recorded&, const Recorded&) = default;
  };

  MappedBuffer make_buffer(std::size_t size, vk::BufferUsageFlags usage) const;
  void reserve(std::size_t vertex_bytes, std::size_t mask_bytes);
  vk::raii::Pipeline make_pipeline(vk::SampleCountFlagBits samples, vk::RenderPass render_pass) const;
  Pass& pass_for(int samples);
  vk::Framebuffer framebuffer_for(const MaskLayout& layout);
  void record(const Recorded& wanted);

  std::unique_ptr<VulkanDevice> opened_;
  const vk::raii::Device& device_;
  EnclosingViewport viewport_;
  vk::raii::Queue queue_;
  vk::raii::DescriptorSetLayout set_layout_;
  vk::raii::PipelineLayout pipeline_layout_{nullptr};
  vk::raii::DescriptorPool descriptor_pool_{nullptr};
  vk::raii::DescriptorSet descriptor_set_{nullptr};
  vk::raii::CommandPool command_pool_;
  vk::raii::CommandBuffer commands_{nullptr};
  vk::raii::Fence finished_;
  std::map<int, Pass> passes_;
  MappedBuffer vertices_;
  MappedBuffer masks_;
  std::optional<Recorded> recorded_;
};

constexpr auto kBinding =
    vk::DescriptorSetLayoutBinding(0, vk::DescriptorType::eStorageBuffer, 1, vk::ShaderStageFlagBits::eFragment);

VulkanDriver::VulkanDriver(std::unique_ptr<VulkanDevice> opened)
    : opened_(std::move(opened)),
      device_(opened_->device()),
      viewport_(static_cast<float>(opened_->info().max_coordinate)),
      queue_(device_, opened_->queue_family(), 0),
      set_layout_(device_, vk::DescriptorSetLayoutCreateInfo({}, kBinding)),
      command_pool_(device_, {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, opened_->queue_family()}),
      finished_(device_, vk::FenceCreateInfo{}) {
  const vk::PushConstantRange push(vk::ShaderStageFlagBits::eFragment, 0, sizeof(PushConstants));
  pipeline_layout_ = vk::raii::PipelineLayout(device_, vk::PipelineLayoutCreateInfo({}, *set_layout_, push));
  const vk::DescriptorPoolSize pool_size(vk::DescriptorType::eStorageBuffer, 1);
  const auto may_free = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet;
  descriptor_pool_ = vk::raii::DescriptorPool(device_, vk::DescriptorPoolCreateInfo(may_free, 1, pool_size));
  descriptor_set_ = std::move(vk::raii::DescriptorSets(device_, {*descriptor_pool_, *set_layout_}).front());
  commands_ =
      std::move(vk::raii::CommandBuffers(device_, {*command_pool_, vk::CommandBufferLevel::ePrimary, 1}).front());
}

MappedBuffer VulkanDriver::make_buffer(std::size_t size, vk::BufferUsageFlags usage) const {
  MappedBuffer result;
  result.buffer = vk::raii::Buffer(device_, vk::BufferCreateInfo({}, size, usage));
  const vk::MemoryRequirements needs = result.buffer.getMemoryRequirements();
  const auto type = mappable_type(opened_->physical().getMemoryProperties(), needs.memoryTypeBits);
  result.memory = vk::raii::DeviceMemory(device_, vk::MemoryAllocateInfo(needs.size, type));
  result.buffer.bindMemory(*result.memory, 0);
  result.data = result.memory.mapMemory(0, size);
  result.size = size;
  return result;
}

// Buffers double in size, so that equal and smaller batches allocate nothing.
void VulkanDriver::reserve(std::size_t vertex_bytes, std::size_t mask_bytes) {
  using Usage = vk::BufferUsageFlagBits;
  if (vertices_.size < vertex_bytes) {
    vertices_ = make_buffer(std::bit_ceil(vertex_bytes), Usage::eVertexBuffer);
    recorded_.reset();
  }
  if (masks_.size < mask_bytes) {
    const std::size_t size = std::min(std::bit_ceil(mask_bytes), opened_->max_storage_bytes());
    masks_ = make_buffer(size, Usage::eStorageBuffer | Usage::eTransferDst);
    const vk::DescriptorBufferInfo whole(*masks_.buffer, 0, VK_WHOLE_SIZE);
    const vk::WriteDescriptorSet write(*descriptor_set_, 0, 0, vk::DescriptorType::eStorageBuffer, {}, whole);
    device_.updateDescriptorSets(write, {});
    recorded_.reset();
  }
}

vk::raii::Pipeline VulkanDriver::make_pipeline(vk::SampleCountFlagBits samples, vk::RenderPass render_pass) const {
  using Stage = vk::ShaderStageFlagBits;
  const vk::raii::ShaderModule vertex(device_, vk::ShaderModuleCreateInfo({}, coverage_vert_spirv));
  const vk::raii::ShaderModule fragment(device_, vk::ShaderModuleCreateInfo({}, coverage_frag_spirv));
  const auto count = static_cast<std::uint32_t>(samples);
  const vk::SpecializationMapEntry entry(0, 0, sizeof count);
  const vk::SpecializationInfo constants(1, &entry, sizeof count, &count);
  const std::array stages{vk::PipelineShaderStageCreateInfo({}, Stage::eVertex, *vertex, "main"),
                          vk::PipelineShaderStageCreateInfo({}, Stage::eFragment, *fragment, "main", &constants)};

  const vk::VertexInputBindingDescription binding(0, sizeof(Position), vk::VertexInputRate::eVertex);
  const vk::VertexInputAttributeDescription position(0, 0, vk::Format::eR32G32Sfloat, 0);
  const vk::PipelineVertexInputStateCreateInfo input({}, binding, position);
  const vk::PipelineInputAssemblyStateCreateInfo assembly({}, vk::PrimitiveTopology::eTriangleList);
  const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
  vk::PipelineRasterizationStateCreateInfo raster;
  raster.cullMode = vk::CullModeFlagBits::eNone;
  raster.lineWidth = 1;
  const vk::PipelineMultisampleStateCreateInfo multisample({}, samples);
  const std::array dynamic{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo dynamic_state({}, dynamic);
  vk::GraphicsPipelineCreateInfo create({}, stages, &input, &assembly, nullptr, &viewport, &raster, &multisample);
  create.setPDynamicState(&dynamic_state).setLayout(*pipeline_layout_).setRenderPass(render_pass);
  return {device_, nullptr, create};
}

VulkanDriver::Pass& VulkanDriver::pass_for(int samples) {
  if (const auto found = passes_.find(samples); found != passes_.end()) return found->second;
  Pass pass;
  const vk::SubpassDescription subpass({}, vk::PipelineBindPoint::eGraphics);
  pass.render_pass = vk::raii::RenderPass(device_, vk::RenderPassCreateInfo({}, {}, subpass));
  pass.pipeline = make_pipeline(static_cast<vk::SampleCountFlagBits>(samples), *pass.render_pass);
  return passes_.emplace(samples, std::move(pass)).first->second;
}

vk::Framebuffer VulkanDriver::framebuffer_for(const MaskLayout& layout) {
  Pass& pass = pass_for(layout.samples);
  const std::pair key(layout.target.width, layout.target.height);
  auto found = pass.framebuffers.find(key);
  if (found == pass.framebuffers.end()) {
    if (pass.framebuffers.size() == kKeptFramebuffers) pass.framebuffers.clear();
    const vk::FramebufferCreateInfo create({}, *pass.render_pass, {}, static_cast<std::uint32_t>(key.first),
                                           static_cast<std::uint32_t>(key.second), 1);
    found = pass.framebuffers.emplace(key, vk::raii::Framebuffer(device_, create)).first;
  }
  return *found->second;
}

void VulkanDriver::record(const Recorded& wanted) {
  if (recorded_ == wanted) return;
  using Access = vk::AccessFlagBits;
  using Stage = vk::PipelineStageFlagBits;
  const MaskLayout& layout = wanted.layout;
  const Pass& pass = pass_for(layout.samples);
  const vk::Framebuffer framebuffer = framebuffer_for(layout);
  const vk::Rect2D target(
      {}, {static_cast<std::uint32_t>(layout.target.width), static_cast<std::uint32_t>(layout.target.height)});
  const float half = viewport_.half();
  const PushConstants push{static_cast<std::uint32_t>(layout.row_words() * 2),
                           static_cast<std::uint32_t>(layout.target.height)};

  recorded_.reset();
  commands_.reset();
  commands_.begin(vk::CommandBufferBeginInfo{});
  commands_.fillBuffer(*masks_.buffer, 0, layout.words() * sizeof(std::uint64_t) * wanted.triangles, 0);
  const vk::MemoryBarrier cleared(Access::eTransferWrite, Access::eShaderRead | Access::eShaderWrite);
  commands_.pipelineBarrier(Stage::eTransfer, Stage::eFragmentShader, {}, cleared, {}, {});
  commands_.beginRenderPass({*pass.render_pass, framebuffer, target}, vk::SubpassContents::eInline);
  commands_.bindPipeline(vk::PipelineBindPoint::eGraphics, *pass.pipeline);
  commands_.setViewport(0, vk::Viewport(-half, -half, 2 * half, 2 * half, 0, 1));
  commands_.setScissor(0, target);
  commands_.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *pipeline_layout_, 0, *descriptor_set_, {});
  commands_.pushConstants<PushConstants>(*pipeline_layout_, vk::ShaderStageFlagBits::eFragment, 0, push);
  commands_.bindVertexBuffers(0, *vertices_.buffer, vk::DeviceSize{0});
  commands_.draw(static_cast<std::uint32_t>(3 * wanted.triangles), 1, 0, 0);
  commands_.endRenderPass();
  const vk::MemoryBarrier drawn(Access::eShaderWrite, Access::eHostRead);
  commands_.pipelineBarrier(Stage::eFragmentShader, Stage::eHost, {}, drawn, {}, {});
  commands_.end();
  recorded_ = wanted;
}

tl::expected<double, Error> VulkanDriver::draw(const Setting& setting, std::span<const Triangle> triangles,
                                               std::span<std::uint64_t> masks) {
  double seconds = 0;
  try {
    reserve(triangles.size_bytes(), masks.size_bytes());
    record({MaskLayout(setting), triangles.size()});
    auto* vertex = static_cast<Position*>(vertices_.data);
    for (const Triangle& triangle : triangles) {
      for (const Position& p : triangle) *vertex++ = {viewport_.ndc(p.x), viewport_.ndc(p.y)};
    }
    const auto start = std::chrono::steady_clock::now();
    queue_.submit(vk::SubmitInfo({}, {}, *commands_), *finished_);
    // No limit here: the program watches the time, and ends the process.
    if (device_.waitForFences(*finished_, VK_TRUE, UINT64_MAX) != vk::Result::eSuccess) {
      return tl::unexpected(Error{ErrorKind::subject, "the draw did not finish"});
    }
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    device_.resetFences(*finished_);
    std::memcpy(masks.data(), masks_.data, masks.size_bytes());
  } catch (const vk::SystemError& error) {
    return tl::unexpected(Error{ErrorKind::subject, fmt::format("Vulkan refused a draw: {}", error.what())});
  }
  if (const auto complaint = opened_->take_complaint()) {
    return tl::unexpected(Error{ErrorKind::subject, fmt::format("the validation layer says: {}", *complaint)});
  }
  return seconds;
}

}  // namespace

tl::expected<std::unique_ptr<Driver>, Error> open_vulkan_driver(const VulkanSelection& selection) {
  auto device = VulkanDevice::open(selection);
  if (!device) return tl::unexpected(device.error());
  try {
    return std::unique_ptr<Driver>(new VulkanDriver(std::move(*device)));
  } catch (const vk::SystemError& error) {
    return tl::unexpected(Error{ErrorKind::subject, fmt::format("Vulkan cannot be set up: {}", error.what())});
  }
}

}  // namespace edgecase::conformance
