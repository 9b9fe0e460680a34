// A stamp of 4x4 pixels swept over the triangle, row of stamps by row of stamps.
//
// After Juan Pineda, "A parallel algorithm for polygon rasterization", SIGGRAPH 1988, and the comparison in Michael
// Abrash, "Rasterization on Larrabee", 2009. In a row of stamps, an edge with the inside to its right (a > 0) rejects
// the stamps up to some column, one with the inside to its left (a < 0) those from some column on, a horizontal one
// none or all. What no edge rejects is therefore one run of stamps: where the last row's run began is where to look for
// this one's beginning, and the run is left at the first stamp that is rejected. The bounding box is never searched.
//
// Exact: stamps stay within four pixels of the box (setup.h); the sixteen pixels are tested one by one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rasterizer/family/coarse_fine.h"
#include "rasterizer/family/setup.h"

namespace edgecase::rasterizer::family {

template <class F, class Sink>
constexpr void cover_stamp(const FixedTriangle<F>& triangle, const Target& target, Sink&& sink) {
  constexpr int kStamp = 4;
  const auto setup = set_up<F>(triangle, target, kStamp);
  if (!setup) return;

  using Values = std::array<std::int64_t, 3>;  // of the edges at the stamp's top-left pixel
  Values corner, to_largest;
  for (std::size_t e = 0; e < 3; ++e) {
    corner[e] = setup->edges[e].c;
    to_largest[e] = setup->edges[e].to_largest(kStamp);
  }
  const auto move = [&](Values& values, int columns) {
    for (std::size_t e = 0; e < 3; ++e) values[e] += columns * setup->edges[e].a;
  };
  const auto left_of_the_run = [&](const Values& values) {
    for (std::size_t e = 0; e < 3; ++e) {
      if (setup->edges[e].a > 0 && values[e] + to_largest[e] < 0) return true;
    }
    return false;
  };
  const auto right_of_the_run = [&](const Values& values) {
    for (std::size_t e = 0; e < 3; ++e) {
      if (setup->edges[e].a <= 0 && values[e] + to_largest[e] < 0) return true;
    }
    return false;
  };

  int start = setup->left;  // `corner` is at (start, y)
  for (int y = setup->top; y < setup->bottom; y += kStamp) {
    for (; start > setup->left && !left_of_the_run(corner); start -= kStamp) move(corner, -kStamp);
    for (; start < setup->right && left_of_the_run(corner); start += kStamp) move(corner, kStamp);
    Values values = corner;
    for (int x = start; x < setup->right && !right_of_the_run(values); x += kStamp) {
      cover_block<kStamp>(*setup, values, x, y, sink);
      move(values, kStamp);
    }
    for (std::size_t e = 0; e < 3; ++e) corner[e] += kStamp * setup->edges[e].b;
  }
}

}  // namespace edgecase::rasterizer::family
