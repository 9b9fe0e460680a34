// How llvmpipe sees a triangle in window positions: on its grid, as three edge functions, in pixels. Shared by the
// models of where it deviates from the rules. In the order of operations of Mesa's lp_setup_tri.c.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "conformance/scene/scene.h"

namespace edgecase::conformance::llvmpipe {

inline constexpr int kTile = 64;  ///< pixels; it bins by tiles
inline constexpr int kSubpixelBits = 8;
inline constexpr std::int64_t kPixel = std::int64_t{1} << kSubpixelBits;

struct Point {
  std::int64_t x = 0;
  std::int64_t y = 0;
};
using Points = std::array<Point, 3>;

/// In subpixels. Nothing where no grid point stands for a vertex.
std::optional<Points> snapped_points(const Setting& setting, const Triangle& triangle);

/// Twice the area, greater than 0 if clockwise on the screen.
std::int64_t area_of(const Points& points);
/// Whether the setting culls a triangle of that area; one without any is.
bool is_culled(const Setting& setting, std::int64_t area);

/// An edge function, in square subpixels.
struct Edge {
  std::int64_t c = 0;  ///< at the first centre of the block, or its corner if multisampled; greater than 0 is inside
  std::int64_t a = 0;  ///< c >> 8 from column to column
  std::int64_t b = 0;  ///< c >> 8 from row to row

  Edge at(std::int64_t columns, std::int64_t rows) const { return {c + (a * columns + b * rows) * kPixel, a, b}; }
};

/// From the target's first pixel on; the 1 that makes top and left edges inside is in c.
std::array<Edge, 3> edges_of(const Setting& setting, const Points& points);

/// c at a sample of the pixel that `edge` is at.
inline std::int64_t value_at(const Setting& setting, const Edge& edge, int sample) {
  if (setting.samples() == 1) return edge.c;
  constexpr std::int64_t kSampleUnit = kPixel >> kSampleGridBits;
  const SampleLocation& location = setting.sample_locations[static_cast<std::size_t>(sample)];
  return edge.c + (edge.a * location.x + edge.b * location.y) * kSampleUnit;
}

/// Pixels first to last, both included.
struct Box {
  std::int64_t left, top, right, bottom;

  bool empty() const { return left > right || top > bottom; }
  friend Box intersection(const Box& a, const Box& b) {
    return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
  }
};

/// From the first pixel that the triangle reaches to the last.
Box box_of(const Setting& setting, const Points& points);
/// The scissor's part of the target, or the target.
Box scissor_of(const Setting& setting);

}  // namespace edgecase::conformance::llvmpipe
