// Four pixels of a row at a time, in the lanes of a vector.
//
// After Fabian Giesen, "Optimizing the basic rasterizer", 2013
// (https://fgiesen.wordpress.com/2013/02/10/optimizing-the-basic-rasterizer/): lane k holds the edge's value k pixels
// to the right; a step right adds 4a to each lane, a step down b. Written as loops over arrays, which the compiler
// turns into vectors of whatever the target has.
//
// Exact: the lanes hold values of edge functions at pixels less than four columns from the box, and these fit
// (setup.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "rasterizer/family/setup.h"

namespace edgecase::rasterizer::family {

template <class F, class Sink>
constexpr void cover_lanes4(const FixedTriangle<F>& triangle, const Target& target, Sink&& sink) {
  constexpr int kLanes = 4;
  using Lanes = std::array<std::int64_t, kLanes>;
  const auto setup = set_up<F>(triangle, target, kLanes);
  if (!setup) return;

  std::array<Lanes, 3> row;
  for (std::size_t e = 0; e < 3; ++e) {
    for (int k = 0; k < kLanes; ++k) row[e][static_cast<std::size_t>(k)] = setup->edges[e].at(k, 0);
  }
  for (int y = setup->top; y < setup->bottom; ++y) {
    std::array<Lanes, 3> value = row;
    for (int x = setup->left; x < setup->right;) {
      const int first = x;
      std::uint64_t pixels = 0;
      for (const int end = std::min((x / 64 + 1) * 64, setup->right); x < end; x += kLanes) {
        for (std::size_t k = 0; k < kLanes; ++k) {
          const bool inside = (value[0][k] | value[1][k] | value[2][k]) >= 0;
          pixels |= std::uint64_t{inside} << (x - first + static_cast<int>(k));
        }
        for (std::size_t e = 0; e < 3; ++e) {
          for (std::int64_t& lane : value[e]) lane += kLanes * setup->edges[e].a;
        }
      }
      emit(y, first, pixels, setup->right, sink);
    }
    for (std::size_t e = 0; e < 3; ++e) {
      for (std::int64_t& lane : row[e]) lane += setup->edges[e].b;
    }
  }
}

}  // namespace edgecase::rasterizer::family
