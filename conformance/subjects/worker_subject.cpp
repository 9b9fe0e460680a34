#include "conformance/subjects/worker_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "conformance/scene/standard_samples.h"

namespace edgecase::conformance {
namespace {

// Mask bytes of one draw: small enough that clearing, drawing and copying them stays in the cache, large enough that
// what a draw costs besides its triangles vanishes. A single larger mask still is one draw.
constexpr std::size_t kPartBytes = std::size_t{2} << 20;

// Far above what a software rasterizer needs for a sample on a loaded machine.
constexpr double kMicrosecondsPerSample = 2;

// The most that a Vulkan device may ask for of where a storage buffer begins.
constexpr std::size_t kAlignment = 256;

std::size_t drawn_bytes(const MaskLayout& layout) { return layout.driver_words() * sizeof(std::uint32_t); }

std::size_t aligned(std::size_t bytes) { return (bytes + kAlignment - 1) / kAlignment * kAlignment; }

// An assembly's triangles share vertices, and are numbered through. What llvmpipe culls depends on what else it clips
// in the same draw.
bool in_one_draw(const Scene& scene) { return scene.assembly || (scene.clip && scene.setting.cull != CullMode::none); }

}  // namespace

tl::expected<std::unique_ptr<Subject>, Error> WorkerSubject::start(const std::string& name, WorkerCommand command) {
  auto worker = WorkerProcess::start(command);
  if (!worker) return tl::unexpected(Error{worker.error().kind, fmt::format("{}: {}", name, worker.error().message)});
  return std::unique_ptr<Subject>(new WorkerSubject(name, std::move(command), std::move(*worker)));
}

WorkerSubject::WorkerSubject(const std::string& name, WorkerCommand command, std::unique_ptr<WorkerProcess> worker)
    : command_(std::move(command)),
      worker_(std::move(worker)),
      viewport_(static_cast<float>(worker_->hello().max_coordinate)),
      max_mask_bytes_(worker_->hello().max_mask_bytes) {
  const WorkerHello& hello = worker_->hello();
  info_.name = name;
  info_.device = hello.device.view();
  info_.rules = hello.rules;
  info_.sample_counts.assign(hello.sample_counts.begin(), hello.sample_counts.begin() + hello.sample_count_number);
  info_.max_target = hello.max_target;
  info_.scissor = hello.scissor;
  info_.cull = hello.cull;
  info_.assembly = hello.assembly;
  info_.clip = hello.clip;
  info_.flipped_viewport = hello.flipped_viewport;
  info_.max_viewport = hello.max_viewport;
  info_.viewport_bound = hello.viewport_bound;
  info_.max_coordinate = hello.max_coordinate;
}

std::optional<std::string> WorkerSubject::refusal(const Scene& scene) const {
  // That every vertex passes the viewport, which reaches as far as max_coordinate, is what is asked of nearly all.
  const bool carried = viewport_.carries(scene.triangles);
  if (auto reason = carried ? refusal_of_setting(scene) : Subject::refusal(scene)) return reason;
  if (!has_standard_samples(scene.setting)) return "sample locations other than the standard ones";
  const std::size_t mask_bytes = drawn_bytes(MaskLayout(scene.setting));
  if (mask_bytes > max_mask_bytes_) {
    return fmt::format("a mask of {} bytes is larger than its largest buffer, {}", mask_bytes, max_mask_bytes_);
  }
  if (scene.assembly && scene.assembly->topology == Topology::list &&
      std::ranges::count(scene.assembly->indices, kRestartIndex) != 0) {
    return "a restart index in a list of triangles";
  }
  if (in_one_draw(scene) && mask_bytes * triangle_count(scene) > max_mask_bytes_) {
    return fmt::format("{} triangles in one draw: their masks exceed its largest buffer, {} bytes",
                       triangle_count(scene), max_mask_bytes_);
  }
  if (carried) return std::nullopt;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    for (std::size_t v = 0; v < 3; ++v) {
      const Position& p = scene.triangles[t][v];
      if (!viewport_.carries(p)) {
        return fmt::format("triangle {}, vertex {}: ({}, {}) does not pass the viewport transform unchanged", t, v, p.x,
                           p.y);
      }
    }
  }
  return std::nullopt;
}

std::size_t WorkerSubject::most_at_once(const Scene& scene) const {
  if (in_one_draw(scene)) return triangle_count(scene);
  const std::size_t mask_bytes = drawn_bytes(MaskLayout(scene.setting));
  return std::max<std::size_t>(1, std::min(kPartBytes, max_mask_bytes_) / mask_bytes);
}

tl::expected<void, Error> WorkerSubject::draw(const Scene& scene, MaskBatch& masks) {
  const std::size_t triangles = triangle_count(scene);
  const std::size_t part = most_at_once(scene);
  masks.reset(MaskLayout(scene.setting), triangles);
  for (std::size_t first = 0; first < triangles; first += part) {
    const auto drawn = draw_part(scene, first, std::min(part, triangles - first));
    if (!drawn) return tl::unexpected(drawn.error());
    drawn->copy_to(masks[first].data());
  }
  return {};
}

tl::expected<DrawnMasks, Error> WorkerSubject::draw_in_place(const Scene& scene, MaskBatch& scratch) {
  const std::size_t triangles = triangle_count(scene);
  if (triangles == 0 || triangles > most_at_once(scene)) return Subject::draw_in_place(scene, scratch);
  return draw_part(scene, 0, triangles);
}

tl::expected<DrawRequest, Error> WorkerSubject::lay_out(const Scene& scene, std::size_t first, std::size_t count) {
  const MaskLayout layout(scene.setting);
  DrawRequest request;
  request.width = layout.target.width;
  request.height = layout.target.height;
  request.samples = layout.samples;
  request.has_scissor = scene.setting.scissor.has_value();
  request.scissor = scene.setting.scissor.value_or(Rect{});
  request.cull = scene.setting.cull;
  request.front_face = scene.setting.front_face;
  const float half = viewport_.half();
  request.viewport = scene.clip ? scene.clip->viewport : Viewport{-half, -half, 2 * half, 2 * half};
  request.topology = scene.assembly ? scene.assembly->topology : Topology::list;
  request.triangles = count;
  request.vertices = scene.assembly ? scene.assembly->vertices.size() : 3 * count;
  request.indices = scene.assembly ? scene.assembly->indices.size() : 0;
  request.components = scene.clip ? 4 : 2;
  request.indices_offset = aligned(request.vertices * request.components * sizeof(float));
  request.masks_offset = request.indices_offset + aligned(request.indices * sizeof(std::uint32_t));
  SharedMemory& memory = worker_->memory();
  if (auto grown = memory.grow(request.masks_offset + drawn_bytes(layout) * count); !grown) {
    return tl::unexpected(grown.error());
  }
  request.memory_bytes = memory.size();

  auto* position = reinterpret_cast<Position*>(memory.data());
  const auto add = [&](const Position& p) { *position++ = {viewport_.ndc(p.x), viewport_.ndc(p.y)}; };
  if (scene.clip) {
    auto* vertex = reinterpret_cast<ClipPosition*>(memory.data());
    for (std::size_t t = first; t < first + count; ++t) {
      vertex = std::ranges::copy(scene.clip->triangles[t], vertex).out;
    }
  } else if (scene.assembly) {
    std::ranges::for_each(scene.assembly->vertices, add);
    std::ranges::copy(scene.assembly->indices,
                      reinterpret_cast<std::uint32_t*>(memory.data() + request.indices_offset));
  } else {
    for (std::size_t t = first; t < first + count; ++t) std::ranges::for_each(scene.triangles[t], add);
  }
  return request;
}

tl::expected<DrawnMasks, Error> WorkerSubject::draw_part(const Scene& scene, std::size_t first, std::size_t count) {
  const auto failure = [&](ErrorKind kind, std::string_view what) {
    return tl::unexpected(Error{kind, fmt::format("{}: {}", info_.name, what)});
  };
  if (!worker_) {
    auto restarted = WorkerProcess::start(command_);
    if (!restarted) return failure(restarted.error().kind, restarted.error().message);
    worker_ = std::move(*restarted);
  }
  const auto request = lay_out(scene, first, count);
  if (!request) return failure(request.error().kind, request.error().message);
  const MaskLayout layout(scene.setting);
  const auto drawing = std::chrono::milliseconds(
      static_cast<std::int64_t>(static_cast<double>(layout.sample_count() * count) * kMicrosecondsPerSample / 1000));
  const auto reply = worker_->draw(*request, command_.time_limit + drawing);
  if (!reply) {
    worker_.reset();
    return failure(reply.error().kind, fmt::format("drawing triangles {} to {} of {}, the driver {}", first,
                                                   first + count - 1, triangle_count(scene), reply.error().message));
  }
  if (!reply->status.ok) {
    worker_.reset();  // A driver that refused what it said it could do is not trusted with the next draw.
    return failure(reply->status.kind, reply->status.message.view());
  }
  driver_seconds_ += reply->driver_seconds;
  const std::byte* masks = worker_->memory().data() + request->masks_offset;
  if (layout.has_short_rows()) {
    return DrawnMasks(layout, {reinterpret_cast<const std::uint32_t*>(masks), layout.driver_words() * count});
  }
  return MaskBatchView(layout.words(), {reinterpret_cast<const std::uint64_t*>(masks), layout.words() * count});
}

}  // namespace edgecase::conformance
