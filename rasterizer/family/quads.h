// Quads: two by two pixels at a time, the unit in which hardware shades.
//
// After Fabian Giesen, "A trip through the graphics pipeline 2011, part 6" and "part 8"
// (https://fgiesen.wordpress.com/2011/07/06/a-trip-through-the-graphics-pipeline-2011-part-6/): quads exist for the
// derivatives of texture coordinates, and a rasterizer that finds all four pixels of one together hands over complete
// ones. Lane k of an edge is its value at the quad's pixel in column k % 2, row k / 2.
//
// Exact: the lanes hold values of edge functions at pixels less than two columns and rows from the box (setup.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "rasterizer/family/setup.h"

namespace edgecase::rasterizer::family {

template <class F, class Sink>
constexpr void cover_quads(const FixedTriangle<F>& triangle, const Target& target, Sink&& sink) {
  using Quad = std::array<std::int64_t, 4>;
  const auto setup = set_up<F>(triangle, target, 2);
  if (!setup) return;

  std::array<Quad, 3> row;
  for (std::size_t e = 0; e < 3; ++e) {
    for (int k = 0; k < 4; ++k) row[e][static_cast<std::size_t>(k)] = setup->edges[e].at(k % 2, k / 2);
  }
  for (int y = setup->top; y < setup->bottom; y += 2) {
    std::array<Quad, 3> value = row;
    for (int x = setup->left; x < setup->right;) {
      const int first = x;
      std::array<std::uint64_t, 2> pixels{};
      for (const int end = std::min((x / 64 + 1) * 64, setup->right); x < end; x += 2) {
        for (std::size_t k = 0; k < 4; ++k) {
          const bool inside = (value[0][k] | value[1][k] | value[2][k]) >= 0;
          pixels[k / 2] |= std::uint64_t{inside} << (x - first + static_cast<int>(k % 2));
        }
        for (std::size_t e = 0; e < 3; ++e) {
          for (std::int64_t& lane : value[e]) lane += 2 * setup->edges[e].a;
        }
      }
      emit(y, first, pixels[0], setup->right, sink);
      if (y + 1 < setup->bottom) emit(y + 1, first, pixels[1], setup->right, sink);
    }
    for (std::size_t e = 0; e < 3; ++e) {
      for (std::int64_t& lane : row[e]) lane += 2 * setup->edges[e].b;
    }
  }
}

}  // namespace edgecase::rasterizer::family
