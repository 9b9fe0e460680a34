// The triangle setup and the scalar reference for one sample in the pixel's centre and a target without a scissor: the
// setting of the articles that the family comes from, and of most scenes.
#pragma once

#include <array>
#include <optional>

#include "rasterizer/edge.h"
#include "rasterizer/scalar.h"

namespace edgecase::rasterizer {

/// The centre of the pixel (column, row).
template <class F>
constexpr SamplePosition<F> pixel_centre(PixelIndex column, PixelIndex row) {
  return sample_position<F>(column, row, CentreSample::point<F>(0));
}

template <class F>
constexpr std::optional<PixelBox> pixel_box(const FixedTriangle<F>& triangle, const Target& target) {
  return pixel_box<F>(triangle, View<>{target});
}

/// The edges of `triangle`, turned to positive area, with their origin at the centre of the pixel (column, row);
/// nothing if the triangle is degenerate.
template <class F>
constexpr std::optional<std::array<Edge<F>, 3>> make_edges(const FixedTriangle<F>& triangle, PixelIndex column,
                                                           PixelIndex row) {
  const auto turned = turned_clockwise<F>(triangle);
  if (!turned) return std::nullopt;
  return make_edges<F>(*turned, pixel_centre<F>(column, row));
}

template <class F, class Sink>
constexpr void cover_scalar(const FixedTriangle<F>& triangle, const Target& target, Sink&& sink) {
  cover_scalar<F>(triangle, View<>{target}, sink);
}

}  // namespace edgecase::rasterizer
