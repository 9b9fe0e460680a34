// Questions to all coordinates of a list of triangles at once, asked of every batch of every run: in vectors, or in
// loops that compilers turn into them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Whether fault(coordinate), a number, is 0 for all of them.
template <class Fault>
bool all_without(std::span<const Triangle> triangles, Fault fault) {
  static_assert(sizeof(Triangle) == 6 * sizeof(float));
  const auto* bytes = reinterpret_cast<const std::byte*>(triangles.data());
  std::uint32_t found = 0;
  for (std::size_t i = 0; i < triangles.size_bytes(); i += sizeof(float)) {
    float coordinate;
    std::memcpy(&coordinate, bytes + i, sizeof coordinate);
    found |= fault(coordinate);
  }
  return found == 0;
}

/// Whether the magnitude of every coordinate is 0 or from `least` to `most`, none of them NaN. Not if `most` is below
/// 0.
bool all_within(std::span<const Triangle> triangles, float most, float least = 0);

}  // namespace edgecase::conformance
