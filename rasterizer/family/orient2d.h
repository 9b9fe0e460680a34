// The definition as a program: orient2d for each edge and each pixel of the bounding box.
//
// After Fabian Giesen, "Triangle rasterization in practice", 2013
// (https://fgiesen.wordpress.com/2013/02/08/triangle-rasterization-in-practice/), its first loop. Everything faster is
// this with work moved out of the loop, so this is where to see what the loop computes.
//
// Exact: the area of each (edge, sample) triangle is computed anew from the coordinates, in types as wide as the
// products need.
#pragma once

#include <algorithm>
#include <cstdint>

#include "rasterizer/family/setup.h"

namespace edgecase::rasterizer::family {

template <class F, class Sink>
constexpr void cover_orient2d(const FixedTriangle<F>& triangle, const Target& target, Sink&& sink) {
  const auto box = pixel_box<F>(triangle, View<>{target});
  const auto turned = turned_clockwise<F>(triangle);
  if (!box || !turned) return;
  const auto& [v0, v1, v2] = *turned;

  for (int y = box->top.value(); y < box->bottom.value(); ++y) {
    const auto row = *PixelIndex::checked(y);
    for (int x = box->left.value(); x < box->right.value();) {
      const int word = x / 64;
      std::uint64_t bits = 0;
      for (; x < std::min(word * 64 + 64, box->right.value()); ++x) {
        const auto sample = sample_position<F>(*PixelIndex::checked(x), row, CentreSample::point<F>(0));
        const bool inside = biased_edge_value<F>(v0, v1, sample) >= constant<0> &&
                            biased_edge_value<F>(v1, v2, sample) >= constant<0> &&
                            biased_edge_value<F>(v2, v0, sample) >= constant<0>;
        bits |= std::uint64_t{inside} << (x % 64);
      }
      if (bits != 0) sink(y, word, bits);
    }
  }
}

}  // namespace edgecase::rasterizer::family
