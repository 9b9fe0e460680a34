// Scene: triangles in window pixels, and which of them form watertight meshes.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "conformance/scene/setting.h"

namespace edgecase::conformance {

/// A window position in pixels, y down; (0, 0) is the top-left corner of the target's top-left pixel.
struct Position {
  float x = 0;
  float y = 0;
  friend bool operator==(const Position&, const Position&) = default;
};

/// Three window positions in the order in which they are drawn. Either winding is drawn: nothing is culled.
using Triangle = std::array<Position, 3>;

/// Consecutive triangles `first` .. `first + count - 1` of a scene that cover a region without gap or overlap, all wound
/// the same way, sharing whole edges with bitwise equal end points.
struct Mesh {
  std::size_t first = 0;
  std::size_t count = 0;
  friend bool operator==(const Mesh&, const Mesh&) = default;
};

/// Plain data. Every position is finite; every mesh range lies inside `triangles`.
struct Scene {
  Setting setting;
  Rules rules;
  std::vector<Triangle> triangles;
  std::vector<Mesh> meshes;
};

}  // namespace edgecase::conformance
