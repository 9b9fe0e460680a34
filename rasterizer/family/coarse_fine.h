// Coarse, then fine: 8x8 blocks by bounds of the edge functions, then the pixels of those blocks that are left.
//
// After Fabian Giesen, "A trip through the graphics pipeline 2011, part 6"
// (https://fgiesen.wordpress.com/2011/07/06/a-trip-through-the-graphics-pipeline-2011-part-6/), the hardware's scheme:
// an edge function is linear, so its largest value in a block is at one of the block's corners, and which one depends
// on the signs of a and b alone. If it is negative there, no pixel of the block is inside (trivial reject); if the
// smallest, at the opposite corner, is not negative for any edge, all are (trivial accept). A block that is neither may
// still have no pixel inside: the bounds know false positives, never false negatives.
//
// Exact: corners are pixels, at most a block away from the box (setup.h); nothing is rounded.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "rasterizer/family/setup.h"

namespace edgecase::rasterizer::family {

/// The pixels of the block whose top-left pixel has the edges' values `corner`.
template <int Size, class Sink>
constexpr void cover_block(const Setup& setup, const std::array<std::int64_t, 3>& corner, int x, int y, Sink& sink) {
  for (int row = 0; row < std::min(Size, setup.bottom - y); ++row) {
    std::uint64_t pixels = 0;
    for (int column = 0; column < Size; ++column) {
      std::int64_t value = 0;
      for (std::size_t e = 0; e < 3; ++e) value |= corner[e] + setup.edges[e].a * column + setup.edges[e].b * row;
      pixels |= std::uint64_t{value >= 0} << column;
    }
    emit(y + row, x, pixels, setup.right, sink);
  }
}

template <class F, class Sink>
constexpr void cover_coarse_fine(const FixedTriangle<F>& triangle, const Target& target, Sink&& sink) {
  constexpr int kBlock = 8;
  const auto setup = set_up<F>(triangle, target, kBlock);
  if (!setup) return;

  std::array<std::int64_t, 3> to_largest, to_smallest;
  for (std::size_t e = 0; e < 3; ++e) {
    to_largest[e] = setup->edges[e].to_largest(kBlock);
    to_smallest[e] = setup->edges[e].to_smallest(kBlock);
  }
  for (int y = setup->top; y < setup->bottom; y += kBlock) {
    for (int x = setup->left; x < setup->right; x += kBlock) {
      std::array<std::int64_t, 3> corner;
      std::int64_t largest = 0, smallest = 0;
      for (std::size_t e = 0; e < 3; ++e) {
        corner[e] = setup->edges[e].at(x - setup->left, y - setup->top);
        largest |= corner[e] + to_largest[e];
        smallest |= corner[e] + to_smallest[e];
      }
      if (largest < 0) continue;
      if (smallest >= 0) {
        emit_block(x, y, kBlock, setup->right, setup->bottom, sink);
      } else {
        cover_block<kBlock>(*setup, corner, x, y, sink);
      }
    }
  }
}

}  // namespace edgecase::rasterizer::family
