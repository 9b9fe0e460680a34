#include "conformance/subjects/vulkan_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <utility>
#include <vulkan/vulkan_raii.hpp>

#include "conformance/scene/mask.h"
#include "conformance/subjects/vulkan_buffers.h"
#include "conformance/subjects/vulkan_pipelines.h"

namespace edgecase::conformance {
namespace {

// As `Layout` in coverage.frag.
struct PushConstants {
  std::uint32_t row_words;  // 32-bit words
  std::uint32_t rows;
  std::uint32_t columns;
};

constexpr vk::BufferUsageFlags kVertexUse = vk::BufferUsageFlagBits::eVertexBuffer;
constexpr vk::BufferUsageFlags kIndexUse = vk::BufferUsageFlagBits::eIndexBuffer;
constexpr vk::BufferUsageFlags kMaskUse =
    vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst;

class VulkanDriver final : public Driver {
 public:
  explicit VulkanDriver(std::unique_ptr<VulkanDevice> opened);

  const SubjectInfo& info() const override { return opened_->info(); }
  std::size_t max_mask_bytes() const override { return opened_->max_storage_bytes(); }
  void use_memory(std::span<std::byte> memory) override;
  tl::expected<double, Error> draw(const Setting& setting, const Primitives& primitives,
                                   std::span<std::uint32_t> masks) override;

 private:
  struct Place {
    vk::Buffer buffer;
    vk::DeviceSize offset = 0;
    friend bool operator==(const Place&, const Place&) = default;
  };
  struct Places {
    Place vertices;
    Place indices;
    Place masks;
    friend bool operator==(const Places&, const Places&) = default;
  };

  // What the command buffer was recorded for.
  struct Recorded {
    Places places;
    Setting setting;
    Viewport viewport;
    Topology topology = Topology::list;
    std::size_t components = 0;
    std::size_t vertices = 0;
    std::size_t indices = 0;
    std::size_t triangles = 0;
    friend bool operator==(const Recorded&, const Recorded&) = default;
  };

  std::optional<Places> shared_places(const Primitives& primitives, std::span<const std::uint32_t> masks) const;
  Places own_places(const Primitives& primitives, std::size_t mask_bytes);
  void record_draw(const Recorded& wanted);
  void record(const Recorded& wanted);

  std::unique_ptr<VulkanDevice> opened_;
  const vk::raii::Device& device_;
  vk::raii::Queue queue_;
  vk::raii::DescriptorSetLayout set_layout_;
  vk::raii::PipelineLayout pipeline_layout_{nullptr};
  vk::raii::DescriptorPool descriptor_pool_{nullptr};
  vk::raii::DescriptorSet descriptor_set_{nullptr};
  vk::raii::CommandPool command_pool_;
  vk::raii::CommandBuffer commands_{nullptr};
  vk::raii::Fence finished_;
  std::optional<VulkanPipelines> pipelines_;
  MappedBuffer vertices_;
  MappedBuffer indices_;
  MappedBuffer masks_;
  std::optional<ImportedBuffer> shared_;
  std::optional<Recorded> recorded_;
};

constexpr auto kBinding =
    vk::DescriptorSetLayoutBinding(0, vk::DescriptorType::eStorageBuffer, 1, vk::ShaderStageFlagBits::eFragment);

VulkanDriver::VulkanDriver(std::unique_ptr<VulkanDevice> opened)
    : opened_(std::move(opened)),
      device_(opened_->device()),
      queue_(device_, opened_->queue_family(), 0),
      set_layout_(device_, vk::DescriptorSetLayoutCreateInfo({}, kBinding)),
      command_pool_(device_, {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, opened_->queue_family()}),
      finished_(device_, vk::FenceCreateInfo{}) {
  const vk::PushConstantRange push(vk::ShaderStageFlagBits::eFragment, 0, sizeof(PushConstants));
  pipeline_layout_ = vk::raii::PipelineLayout(device_, vk::PipelineLayoutCreateInfo({}, *set_layout_, push));
  pipelines_.emplace(*opened_, *pipeline_layout_);
  const vk::DescriptorPoolSize pool_size(vk::DescriptorType::eStorageBuffer, 1);
  const auto may_free = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet;
  descriptor_pool_ = vk::raii::DescriptorPool(device_, vk::DescriptorPoolCreateInfo(may_free, 1, pool_size));
  descriptor_set_ = std::move(vk::raii::DescriptorSets(device_, {*descriptor_pool_, *set_layout_}).front());
  commands_ =
      std::move(vk::raii::CommandBuffers(device_, {*command_pool_, vk::CommandBufferLevel::ePrimary, 1}).front());
}

void VulkanDriver::use_memory(std::span<std::byte> memory) {
  recorded_.reset();
  shared_.reset();
  try {
    shared_ = ImportedBuffer::make(*opened_, memory, kVertexUse | kIndexUse | kMaskUse);
  } catch (const vk::SystemError&) {  // a device may say so of any memory: then masks are copied
  }
}

std::optional<VulkanDriver::Places> VulkanDriver::shared_places(const Primitives& primitives,
                                                                std::span<const std::uint32_t> masks) const {
  if (!shared_) return std::nullopt;
  const auto vertices = shared_->offset_of(primitives.coordinates), indices = shared_->offset_of(primitives.indices);
  const auto first_mask = shared_->offset_of(masks);
  if (!vertices || !indices || !first_mask) return std::nullopt;
  const vk::Buffer buffer = shared_->buffer();
  return Places{{buffer, *vertices}, {buffer, *indices}, {buffer, *first_mask}};
}

// Buffers double in size, so that equal and smaller batches allocate nothing.
VulkanDriver::Places VulkanDriver::own_places(const Primitives& primitives, std::size_t mask_bytes) {
  const auto reserve = [&](MappedBuffer& buffer, std::size_t bytes, vk::BufferUsageFlags use, std::size_t most) {
    if (buffer.size >= bytes) return;
    recorded_.reset();
    buffer = MappedBuffer::make(*opened_, std::min(std::bit_ceil(bytes), most), use);
  };
  reserve(vertices_, primitives.coordinates.size_bytes(), kVertexUse, SIZE_MAX);
  reserve(indices_, primitives.indices.size_bytes(), kIndexUse, SIZE_MAX);
  reserve(masks_, mask_bytes, kMaskUse, opened_->max_storage_bytes());
  return {{*vertices_.buffer, 0}, {*indices_.buffer, 0}, {*masks_.buffer, 0}};
}

void VulkanDriver::record_draw(const Recorded& wanted) {
  const Setting& setting = wanted.setting;
  const MaskLayout layout(setting);
  const bool plain_list = wanted.topology == Topology::list && wanted.indices == 0;
  const auto pipeline = pipelines_->pipeline({layout.samples, setting.cull, setting.front_face, wanted.topology,
                                              /*primitive_id=*/!plain_list, wanted.components});
  const auto rect = [](const Rect& r) {
    return vk::Rect2D({r.x, r.y}, {static_cast<std::uint32_t>(r.width), static_cast<std::uint32_t>(r.height)});
  };
  const Viewport& viewport = wanted.viewport;
  const PushConstants push{static_cast<std::uint32_t>(layout.driver_row_words()),
                           static_cast<std::uint32_t>(layout.target.height),
                           static_cast<std::uint32_t>(layout.target.width)};
  const auto render_pass = pipelines_->render_pass(layout.samples);
  const auto framebuffer = pipelines_->framebuffer(layout.samples, layout.target);
  commands_.beginRenderPass({render_pass, framebuffer, rect({0, 0, layout.target.width, layout.target.height})},
                            vk::SubpassContents::eInline);
  commands_.bindPipeline(vk::PipelineBindPoint::eGraphics, pipeline);
  commands_.setViewport(0, vk::Viewport(viewport.x, viewport.y, viewport.width, viewport.height, 0, 1));
  commands_.setScissor(0, rect(drawn_rectangle(setting)));
  commands_.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *pipeline_layout_, 0, *descriptor_set_, {});
  commands_.pushConstants<PushConstants>(*pipeline_layout_, vk::ShaderStageFlagBits::eFragment, 0, push);
  commands_.bindVertexBuffers(0, wanted.places.vertices.buffer, wanted.places.vertices.offset);
  if (wanted.indices == 0) {
    commands_.draw(static_cast<std::uint32_t>(wanted.vertices), 1, 0, 0);
  } else {
    commands_.bindIndexBuffer(wanted.places.indices.buffer, wanted.places.indices.offset, vk::IndexType::eUint32);
    commands_.drawIndexed(static_cast<std::uint32_t>(wanted.indices), 1, 0, 0, 0);
  }
  commands_.endRenderPass();
}

void VulkanDriver::record(const Recorded& wanted) {
  if (recorded_ == wanted) return;
  using Access = vk::AccessFlagBits;
  using Stage = vk::PipelineStageFlagBits;
  recorded_.reset();
  commands_.reset();
  const auto& [buffer, offset] = wanted.places.masks;
  const vk::DeviceSize bytes = MaskLayout(wanted.setting).driver_words() * sizeof(std::uint32_t) * wanted.triangles;
  const vk::DescriptorBufferInfo masks(buffer, offset, bytes);
  device_.updateDescriptorSets(
      vk::WriteDescriptorSet(*descriptor_set_, 0, 0, vk::DescriptorType::eStorageBuffer, {}, masks), {});
  commands_.begin(vk::CommandBufferBeginInfo{});
  commands_.fillBuffer(buffer, offset, bytes, 0);
  // Of indexed vertices it is not known which are read: in memory that is shared they may be taken for what was
  // cleared.
  const vk::MemoryBarrier cleared(Access::eTransferWrite, Access::eShaderRead | Access::eShaderWrite |
                                                              Access::eVertexAttributeRead | Access::eIndexRead);
  commands_.pipelineBarrier(Stage::eTransfer, Stage::eFragmentShader | Stage::eVertexInput, {}, cleared, {}, {});
  record_draw(wanted);
  const vk::MemoryBarrier drawn(Access::eShaderWrite, Access::eHostRead);
  commands_.pipelineBarrier(Stage::eFragmentShader, Stage::eHost, {}, drawn, {}, {});
  commands_.end();
  recorded_ = wanted;
}

tl::expected<double, Error> VulkanDriver::draw(const Setting& setting, const Primitives& primitives,
                                               std::span<std::uint32_t> masks) {
  double seconds = 0;
  if (primitives.triangles == 0) return seconds;
  try {
    const auto shared = shared_places(primitives, masks);
    const Places places = shared ? *shared : own_places(primitives, masks.size_bytes());
    record({places, setting, primitives.viewport, primitives.topology, primitives.components, primitives.vertices(),
            primitives.indices.size(), primitives.triangles});
    if (!shared) {
      std::ranges::copy(primitives.coordinates, static_cast<float*>(vertices_.data));
      std::ranges::copy(primitives.indices, static_cast<std::uint32_t*>(indices_.data));
    }
    const auto start = std::chrono::steady_clock::now();
    queue_.submit(vk::SubmitInfo({}, {}, *commands_), *finished_);
    // No limit here: the program watches the time, and ends the process.
    if (device_.waitForFences(*finished_, VK_TRUE, UINT64_MAX) != vk::Result::eSuccess) {
      return tl::unexpected(Error{ErrorKind::subject, "the draw did not finish"});
    }
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    device_.resetFences(*finished_);
    if (!shared) std::memcpy(masks.data(), masks_.data, masks.size_bytes());
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
