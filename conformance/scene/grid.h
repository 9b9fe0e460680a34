// Positions that need no snapping, because they lie on the subpixel grid.
#pragma once

#include <cstdint>
#include <optional>

#include "conformance/scene/explanation.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// `position` in units of 1/scale px, scale = 2^subpixel_bits, if it lies on that grid and within 2^22 units of the
/// origin: then every way of snapping leaves it where it is, half a pixel subtracted first or not, because binary32
/// holds all whole numbers of up to 24 bits.
inline std::optional<GridPoint> on_grid(const Position& position, double scale) {
  constexpr double kReach = 1 << 22;
  const double x = static_cast<double>(position.x) * scale;  // exact: a power of two
  const double y = static_cast<double>(position.y) * scale;
  if (!(x >= -kReach && x <= kReach && y >= -kReach && y <= kReach)) return std::nullopt;
  const GridPoint point{static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)};
  if (static_cast<double>(point.x) != x || static_cast<double>(point.y) != y) return std::nullopt;
  return point;
}

}  // namespace edgecase::conformance
