// Scene: triangles in window pixels, and which of them form watertight meshes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "conformance/scene/setting.h"

namespace edgecase::conformance {

/// A window position in pixels, y down; (0, 0) is the top-left corner of the target's top-left pixel.
struct Position {
  float x = 0;
  float y = 0;
  friend bool operator==(const Position&, const Position&) = default;
};

/// Three window positions in the order in which they are drawn. Either winding is drawn unless the setting culls it.
using Triangle = std::array<Position, 3>;

/// Consecutive triangles `first` .. `first + count - 1` of a scene that cover a region without gap or overlap, all
/// wound the same way, sharing whole edges with bitwise equal end points.
struct Mesh {
  std::size_t first = 0;
  std::size_t count = 0;
  friend bool operator==(const Mesh&, const Mesh&) = default;
};

/// A position before clipping, perspective division and the viewport transform.
struct ClipPosition {
  float x = 0;
  float y = 0;
  float z = 0;
  float w = 1;
  friend bool operator==(const ClipPosition&, const ClipPosition&) = default;
};

using ClipTriangle = std::array<ClipPosition, 3>;

/// The viewport transform in Vulkan's terms: x = -1 lies at `x`, +1 at `x + width`, likewise y; a negative height
/// flips. Pixels; any finite values with a width above 0 and a height other than 0.
struct Viewport {
  float x = 0;
  float y = 0;
  float width = 0;
  float height = 0;
  friend bool operator==(const Viewport&, const Viewport&) = default;
};

/// Geometry that the rasterizer under test has to clip and transform itself. Depth runs from 0 to w, as in Vulkan.
struct ClipGeometry {
  Viewport viewport;
  std::vector<ClipTriangle> triangles;
  friend bool operator==(const ClipGeometry&, const ClipGeometry&) = default;
};

enum class Topology { list, strip, fan };

/// Ends one strip or fan and begins the next, in Assembly::indices.
inline constexpr std::uint32_t kRestartIndex = 0xffffffff;

/// How triangles are handed to a rasterizer that assembles them itself. Odd triangles of a strip have their first two
/// vertices swapped, so that all face the same way; triangle i of a fan is (0, i + 1, i + 2).
struct Assembly {
  Topology topology = Topology::list;
  std::vector<Position> vertices;
  /// Vertex numbers or kRestartIndex; empty draws the vertices in their order.
  std::vector<std::uint32_t> indices;
  friend bool operator==(const Assembly&, const Assembly&) = default;
};

/// Plain data; see triangle_count. Every position is finite; every mesh range lies inside the triangles there are.
struct Scene {
  Setting setting;
  Rules rules;
  std::vector<Triangle> triangles;
  std::vector<Mesh> meshes;
  /// If present, `triangles` is what it assembles to, in order, and a subject is fed the assembly.
  std::optional<Assembly> assembly{};
  /// If present, `triangles` is empty, and `meshes` are ranges of these, which projection leaves watertight: a subject
  /// is fed this, and what it covers depends on its clipper.
  std::optional<ClipGeometry> clip{};
};

/// Triangles of the scene, however they are given.
inline std::size_t triangle_count(const Scene& scene) {
  return scene.clip ? scene.clip->triangles.size() : scene.triangles.size();
}

}  // namespace edgecase::conformance
