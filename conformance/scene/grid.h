// Positions that need no snapping, because they lie on the subpixel grid.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "conformance/scene/coordinates.h"
#include "conformance/scene/explanation.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Every way of snapping leaves a point of the grid within this many units of the origin where it is, half a pixel
/// subtracted first or not, because binary32 holds all whole numbers of up to 24 bits.
inline constexpr float kGridReach = 1 << 22;

/// `position`, which lies on the grid, in units of 1/scale px, scale = 2^subpixel_bits.
inline GridPoint grid_point(const Position& position, float scale) {
  return {static_cast<std::int32_t>(position.x * scale), static_cast<std::int32_t>(position.y * scale)};
}

/// Whether every vertex lies on the grid within kGridReach. May say no because of a coordinate -0, which is rare.
inline bool all_on_grid(std::span<const Triangle> triangles, float scale) {
  return all_without(triangles, [scale](float coordinate) {
    // What is out of reach becomes 0, which is another pattern than its own.
    constexpr auto kReach = std::bit_cast<std::uint32_t>(kGridReach);
    const auto scaled = std::bit_cast<std::uint32_t>(coordinate * scale);
    const std::uint32_t in_reach = (scaled & 0x7fffffff) < kReach ? ~std::uint32_t{0} : 0;
    const auto whole = static_cast<std::int32_t>(std::bit_cast<float>(scaled & in_reach));
    return std::bit_cast<std::uint32_t>(static_cast<float>(whole)) ^ scaled;
  });
}

}  // namespace edgecase::conformance
