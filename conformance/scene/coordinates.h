// Questions to all coordinates of a list of triangles at once, asked of every batch of every run: their loops are
// written so that compilers turn them into vectors.
#pragma once

#include <bit>
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
inline bool all_within(std::span<const Triangle> triangles, float most, float least = 0) {
  // Magnitudes of binary32 compare as their bit patterns do, infinity and NaN above all others. A difference of two is
  // negative where the first is less.
  const auto low = std::bit_cast<std::int32_t>(least), high = std::bit_cast<std::int32_t>(most);
  if (high < 0) return triangles.empty();
  return all_without(triangles, [low, high](float coordinate) {
    const std::int32_t magnitude = std::bit_cast<std::int32_t>(coordinate) & 0x7fffffff;
    const std::int32_t above = high - magnitude;
    const std::int32_t below_but_not_0 = (magnitude - low) & ~(magnitude - 1);
    return static_cast<std::uint32_t>(above | below_but_not_0) & 0x80000000;
  });
}

}  // namespace edgecase::conformance
