// What the members of the family share: triangle setup in plain 64-bit integers, and how coverage reaches the sink.
//
// Views. One sample in each pixel's centre, no scissor: the family is about traversal.
//
// Sinks. Every member calls sink(y, word, bits) as cover_scalar does, with one freedom more: rows and words may come in
// any order, and a word may come in several parts, which have no bit in common. A sink that ors them, as Mask::add
// does, sees no difference.
//
// Widths. Edge functions are those of edge.h: the pixel i columns right of and j rows below the origin is on the
// triangle's side of an edge if c + a*i + b*j >= 0. The origin is a pixel of the target, and members look at pixels up
// to one block of 64 outside of it, so that -2^15 <= i, j < 2^15. value_bits<F> is the width of the sum over all of
// these, 47 for 16.8: no expression of the form c + a*i + b*j overflows in 64 bits, nor does any part of it.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <optional>

#include "rasterizer/edge.h"

namespace edgecase::rasterizer::family {

/// How far right or down of the origin a pixel lies.
using PixelOffset = Int<16>;
inline constexpr int kLargestBlock = 64;
static_assert(PixelOffset::kMin <= -kMaxExtent - kLargestBlock && PixelOffset::kMax >= kMaxExtent + kLargestBlock);

template <class F>
inline constexpr int value_bits = decltype(typename Edge<F>::Value() + typename Edge<F>::Step() * PixelOffset() +
                                           typename Edge<F>::Step() * PixelOffset())::kBits;
static_assert(value_bits<Format16_8> == 47);

/// Edge<F> in plain integers, for code that works in lanes.
struct PlainEdge {
  std::int64_t a;
  std::int64_t b;
  std::int64_t c;

  constexpr std::int64_t at(int i, int j) const { return c + a * i + b * j; }
  /// The largest and the smallest value in a block of size * size pixels less the one at its top-left pixel.
  constexpr std::int64_t to_largest(int size) const {
    return (size - 1) * (std::max<std::int64_t>(a, 0) + std::max<std::int64_t>(b, 0));
  }
  constexpr std::int64_t to_smallest(int size) const {
    return (size - 1) * (std::min<std::int64_t>(a, 0) + std::min<std::int64_t>(b, 0));
  }
};

/// left <= x < right and top <= y < bottom hold the pixels whose samples lie in the triangle's bounding box and in the
/// target, with left and top moved out to a multiple of the block. A pixel of the target that this adds is decided by
/// the edge functions like any other; beyond right and bottom the target may have ended.
struct Setup {
  int left;
  int top;
  int right;
  int bottom;
  /// Their origin is the pixel (left, top).
  std::array<PlainEdge, 3> edges;
};

/// Nothing if the triangle is degenerate or has no sample in its bounding box. `block` is a power of two, at most
/// kLargestBlock.
template <class F>
constexpr std::optional<Setup> set_up(const FixedTriangle<F>& triangle, const Target& target, int block) {
  static_assert(value_bits<F> <= 64);
  const auto box = pixel_box<F>(triangle, View<>{target});
  const auto turned = turned_clockwise<F>(triangle);
  if (!box || !turned) return std::nullopt;
  const auto left = *PixelIndex::checked(box->left.value() & -block);
  const auto top = *PixelIndex::checked(box->top.value() & -block);
  const auto edges = make_edges<F>(*turned, sample_position<F>(left, top, CentreSample::point<F>(0)));
  Setup setup{left.value(), top.value(), box->right.value(), box->bottom.value(), {}};
  for (std::size_t e = 0; e < 3; ++e) {
    const Edge<F>& edge = edges[e];
    setup.edges[e] = {edge.a.value(), edge.b.value(), edge.c.value()};
  }
  return setup;
}

/// The lowest `count` bits; 0 <= count <= 64.
constexpr std::uint64_t low_bits(int count) {
  return count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

/// Gives the sink the pixels of row y from column x on, the least significant bit first, less those at or right of
/// `right`. 0 <= x < right, and they lie in one word.
template <class Sink>
constexpr void emit(int y, int x, std::uint64_t pixels, int right, Sink& sink) {
  assert(x >= 0 && x < right);
  const int word = x / 64;
  const std::uint64_t bits = pixels << (x % 64) & low_bits(std::min(right - word * 64, 64));
  if (bits != 0) sink(y, word, bits);
}

/// Gives the sink the pixels x to end - 1 of row y.
template <class Sink>
constexpr void emit_span(int y, int x, int end, Sink& sink) {
  while (x < end) {
    const int next = std::min((x / 64 + 1) * 64, end);
    emit(y, x, low_bits(next - x), end, sink);
    x = next;
  }
}

/// Gives the sink the whole block of size * size pixels at (x, y), less what lies at or beyond `right` and `bottom`.
template <class Sink>
constexpr void emit_block(int x, int y, int size, int right, int bottom, Sink& sink) {
  for (int row = y; row < std::min(y + size, bottom); ++row) emit_span(row, x, std::min(x + size, right), sink);
}

}  // namespace edgecase::rasterizer::family
