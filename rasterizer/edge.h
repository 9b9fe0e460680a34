// Edge functions over pixels, with the top-left rule as a bias, and the pixels that a triangle can cover.
//
// Units and widths, with the 16.8 format in brackets: S subpixel bits [8], P sample bits, P >= S [8], N = all bits
// [24]. An edge from p to q, y down, has at the point s the value
//
//   E(s) = a * (s.x - p.x) + b * (s.y - p.y),   a = p.y - q.y,   b = q.x - p.x,
//
// an exact integer in units of 2^-(S+P) px^2 once s and p are in units of 2^-P. If the triangle's area is positive (p,
// q and the third vertex clockwise on the screen), E is positive on the triangle's side of the edge.
//
// Top-left rule (D3D11.3 functional specification 3.4.2.1): a sample on the edge, E = 0, is inside if the edge is a
// left edge, the inside lying to the right (a > 0), or a top edge, horizontal with the inside below (a = 0 and b > 0).
// All other edges get the bias -1, and a sample is inside if E + bias >= 0 for all three: E is an integer, so E - 1 >=
// 0 is E > 0.
//
// Only whole pixels are stepped. One pixel to the right adds a * 2^P to E, one down adds b * 2^P, so with integers i, j
//
//   E + bias + (a*i + b*j) * 2^P >= 0   if and only if   floor((E + bias) / 2^P) + a*i + b*j >= 0,
//
// and the P lower bits can be dropped once the bias is in.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "rasterizer/format.h"
#include "rasterizer/sample_pattern.h"

namespace edgecase::rasterizer {

/// A vertex coordinate in units of 2^-P px.
template <class F>
constexpr auto on_sample_grid(typename F::Coordinate coordinate) {
  return coordinate.template shifted_left<F::kSampleBits - F::kSubpixelBits>();
}

/// The sample at `offset` in the pixel of that column or row, in units of 2^-P px.
template <class F>
constexpr auto sample_of(PixelIndex pixel, SampleOffset<F> offset) {
  return pixel.shifted_left<F::kSampleBits>() + offset;
}

/// The pixels of `view` that have a sample in the closed bounding box of `triangle`, or nothing if there are none: a
/// sample that is right of, left of, above or below all three vertices is outside. Samples of one pixel differ, so a
/// pixel's greatest offset decides at the left and the top, and its least at the right and the bottom.
template <class F, class Samples, class Clip>
constexpr std::optional<PixelBox> pixel_box(const FixedTriangle<F>& triangle, const View<Samples, Clip>& view) {
  constexpr auto kBelowOnePixel = constant<(std::int64_t{1} << F::kSampleBits) - 1>;
  // Pixel i has the sample i * 2^P + offset: the first at or right of v is ceil((v - offset) / 2^P).
  const auto first_from = [&](typename F::Coordinate v, SampleOffset<F> offset) {
    return (on_sample_grid<F>(v) - offset + kBelowOnePixel).template shifted_right<F::kSampleBits>();
  };
  // And the end of those at or left of v is floor((v - offset) / 2^P) + 1.
  const auto end_up_to = [&](typename F::Coordinate v, SampleOffset<F> offset) {
    return (on_sample_grid<F>(v) - offset).template shifted_right<F::kSampleBits>() + constant<1>;
  };
  const auto& [v0, v1, v2] = triangle;
  const SamplePoint<F> least = view.samples.template least<F>();
  const SamplePoint<F> greatest = view.samples.template greatest<F>();
  const PixelBox in = view.bounds();
  const PixelBox box{clamp(first_from(std::min({v0.x, v1.x, v2.x}), greatest.x), in.left, in.right),
                     clamp(first_from(std::min({v0.y, v1.y, v2.y}), greatest.y), in.top, in.bottom),
                     clamp(end_up_to(std::max({v0.x, v1.x, v2.x}), least.x), in.left, in.right),
                     clamp(end_up_to(std::max({v0.y, v1.y, v2.y}), least.y), in.top, in.bottom)};
  if (box.left >= box.right || box.top >= box.bottom) return std::nullopt;
  return box;
}

/// Twice the signed area, positive if the vertices are clockwise on the screen, in units of 2^-2S px^2 [51 bits].
template <class F>
constexpr auto doubled_area(const FixedTriangle<F>& triangle) {
  const auto& [v0, v1, v2] = triangle;
  return (v1.x - v0.x) * (v2.y - v0.y) - (v2.x - v0.x) * (v1.y - v0.y);
}

/// A sample as a point, in units of 2^-P px: the one at `offset` in the pixel (column, row).
template <class F>
struct SamplePosition {
  using Coordinate = decltype(sample_of<F>({}, {}));
  Coordinate x;
  Coordinate y;
};

template <class F>
constexpr SamplePosition<F> sample_position(PixelIndex column, PixelIndex row, const SamplePoint<F>& offset) {
  return {sample_of<F>(column, offset.x), sample_of<F>(row, offset.y)};
}

/// floor((E + bias) / 2^P) at `s`.
template <class F>
constexpr auto biased_edge_value(const FixedVertex<F>& p, const FixedVertex<F>& q, const SamplePosition<F>& s) {
  const auto a = p.y - q.y;
  const auto b = q.x - p.x;
  const auto e = a * (s.x - on_sample_grid<F>(p.x)) + b * (s.y - on_sample_grid<F>(p.y));
  const bool top_left = a > constant<0> || (a == constant<0> && b > constant<0>);
  const auto bias = top_left ? Int<1>() : constant<-1>;
  return (e + bias).template shifted_right<F::kSampleBits>();
}

/// An edge function over pixels: the sample i columns right of and j rows below the origin is on the triangle's side of
/// this edge if and only if c + a*i + b*j >= 0.
template <class F>
struct Edge {
  using Step = Int<F::kBits + 1>;
  using Value = decltype(biased_edge_value<F>({}, {}, {}));
  Step a;
  Step b;
  Value c;
};

/// The edge from p to q of a triangle with positive area, with its origin at the sample `s`.
template <class F>
constexpr Edge<F> make_edge(const FixedVertex<F>& p, const FixedVertex<F>& q, const SamplePosition<F>& s) {
  return {p.y - q.y, q.x - p.x, biased_edge_value<F>(p, q, s)};
}

/// `triangle` with its vertices in an order of positive area; nothing if it is degenerate.
template <class F>
constexpr std::optional<FixedTriangle<F>> turned_clockwise(const FixedTriangle<F>& triangle) {
  const auto area = doubled_area<F>(triangle);
  if (area == constant<0>) return std::nullopt;
  if (area > constant<0>) return triangle;
  return FixedTriangle<F>{triangle[0], triangle[2], triangle[1]};
}

/// The edges of `triangle`, of positive area, with their origin at the sample `s`.
template <class F>
constexpr std::array<Edge<F>, 3> make_edges(const FixedTriangle<F>& triangle, const SamplePosition<F>& s) {
  const auto& [v0, v1, v2] = triangle;
  return {make_edge<F>(v0, v1, s), make_edge<F>(v1, v2, s), make_edge<F>(v2, v0, s)};
}

// The widths that the text above promises for the whole 16.8 range.
static_assert(decltype(doubled_area<Format16_8>({}))::kBits == 51);
static_assert(Edge<Format16_8>::Step::kBits == 25);
static_assert(Edge<Format16_8>::Value::kBits == 45);

}  // namespace edgecase::rasterizer
