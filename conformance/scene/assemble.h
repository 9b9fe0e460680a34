// The triangles that a strip, a fan or a list makes of its vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Appends what `vertices`, without restarts, make. Fewer than three make nothing, and nor do vertices left over at the
/// end of a list.
inline void append_primitives(Topology topology, std::span<const Position> vertices, std::vector<Triangle>& triangles) {
  const std::size_t step = topology == Topology::list ? 3 : 1;
  for (std::size_t i = 0; i + 2 < vertices.size(); i += step) {
    std::size_t first = i, second = i + 1;
    if (topology == Topology::strip && i % 2 == 1) first = i + 1, second = i;
    if (topology == Topology::fan) first = 0;
    triangles.push_back({vertices[first], vertices[second], vertices[i + 2]});
  }
}

/// Every triangle of `assembly`, in order. Each index is that of a vertex, or kRestartIndex.
inline std::vector<Triangle> assemble(const Assembly& assembly) {
  std::vector<Triangle> triangles;
  if (assembly.indices.empty()) {
    append_primitives(assembly.topology, assembly.vertices, triangles);
    return triangles;
  }
  std::vector<Position> since_restart;
  for (const std::uint32_t index : assembly.indices) {
    if (index != kRestartIndex) {
      since_restart.push_back(assembly.vertices[index]);
      continue;
    }
    append_primitives(assembly.topology, since_restart, triangles);
    since_restart.clear();
  }
  append_primitives(assembly.topology, since_restart, triangles);
  return triangles;
}

}  // namespace edgecase::conformance
