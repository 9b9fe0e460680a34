// Driver: a rasterizer behind a graphics interface, as the worker process sees it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tl/expected.hpp>

#include "conformance/scene/error.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// What one draw gives to a driver, in the graphics interface's own terms.
struct Primitives {
  /// A negative height only where SubjectInfo::flipped_viewport says so.
  Viewport viewport;
  /// Of each vertex so many as `components`: x, y, z and w in clip space; or x and y only, and z is 0 and w is 1.
  std::span<const float> coordinates;
  std::size_t components = 4;
  Topology topology = Topology::list;
  /// Vertex numbers or kRestartIndex; empty draws the vertices in their order.
  std::span<const std::uint32_t> indices;
  /// How many triangles that makes.
  std::size_t triangles = 0;

  std::size_t vertices() const { return coordinates.size() / components; }
  ClipPosition vertex(std::size_t i) const {
    const float* c = coordinates.data() + i * components;
    return components == 2 ? ClipPosition{c[0], c[1], 0, 1} : ClipPosition{c[0], c[1], c[2], c[3]};
  }
  /// Whether triangle i simply is vertices 3 * i to 3 * i + 2.
  bool plain_list() const { return topology == Topology::list && indices.empty(); }
};

/// The part of a scissor that lies on the target; all of the target without one. An empty rectangle is at (0, 0).
inline Rect drawn_rectangle(const Setting& setting) {
  const Extent target = setting.target;
  if (!setting.scissor) return {0, 0, target.width, target.height};
  const Rect& s = *setting.scissor;
  const auto end = [](int from, int size, int limit) {
    return static_cast<int>(std::clamp<std::int64_t>(std::int64_t{from} + size, 0, limit));
  };
  const int x = std::clamp(s.x, 0, target.width);
  const int y = std::clamp(s.y, 0, target.height);
  const int width = end(s.x, s.width, target.width) - x;
  const int height = end(s.y, s.height, target.height) - y;
  if (width <= 0 || height <= 0) return {};
  return {x, y, width, height};
}

/// One instance lives in one worker process, and is used from one thread.
class Driver {
 public:
  virtual ~Driver() = default;

  /// `max_coordinate` is the half extent of the EnclosingViewport through which window positions reach the driver.
  virtual const SubjectInfo& info() const = 0;

  /// The most mask bytes that one draw may ask for; at least one triangle's at usual targets.
  virtual std::size_t max_mask_bytes() const = 0;

  /// The memory in which the vertices, indices and masks of all later draws lie, until the next call; none before the
  /// first. A driver may work in it in place. The one before is there until the call returns.
  virtual void use_memory(std::span<std::byte>) {}

  /// Draws each triangle into its own mask: `masks` holds primitives.triangles masks of MaskLayout(setting), in
  /// driver_words() each and at most max_mask_bytes(), and every word of it is written. `setting` has standard sample
  /// locations, a sample count and a target that info() allows. Returns the seconds that the driver took from
  /// submission to the end of the draw.
  virtual tl::expected<double, Error> draw(const Setting& setting, const Primitives& primitives,
                                           std::span<std::uint32_t> masks) = 0;
};

}  // namespace edgecase::conformance
