// Questions to all coordinates of a list of triangles at once, asked of every batch of every run: their loops are
// written so that compilers turn them into vectors.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Coordinates of eight triangles, in their order.
using CoordinateBlock = std::array<float, 8 * 6>;

/// Calls visit(CoordinateBlock) for eight triangles after another; zeros fill up the last block.
template <class Visit>
void for_each_block(std::span<const Triangle> triangles, Visit visit) {
  static_assert(sizeof(CoordinateBlock) == 8 * sizeof(Triangle));
  for (std::size_t first = 0; first < triangles.size(); first += 8) {
    CoordinateBlock block{};
    std::memcpy(block.data(), &triangles[first], std::min<std::size_t>(8, triangles.size() - first) * sizeof(Triangle));
    visit(block);
  }
}

struct Magnitudes {
  float largest = 0;  ///< NaN if a coordinate is
  float least_above_zero = std::numeric_limits<float>::infinity();
};

/// Magnitudes of binary32 compare as their bit patterns do, infinity and NaN above all others.
inline Magnitudes magnitudes(std::span<const Triangle> triangles) {
  constexpr auto kInfinity = std::bit_cast<std::int32_t>(std::numeric_limits<float>::infinity());
  std::int32_t largest = 0, least = kInfinity;
  for_each_block(triangles, [&](const CoordinateBlock& block) {
    for (const float coordinate : block) {
      const std::int32_t magnitude = std::bit_cast<std::int32_t>(coordinate) & 0x7fffffff;
      largest = std::max(largest, magnitude);
      least = std::min(least, magnitude == 0 ? kInfinity : magnitude);
    }
  });
  return {std::bit_cast<float>(largest), std::bit_cast<float>(least)};
}

}  // namespace edgecase::conformance
