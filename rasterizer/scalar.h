// The readable reference: edge functions stepped incrementally, one pixel at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "rasterizer/edge.h"

namespace edgecase::rasterizer {

/// An edge's value at the first column of the box, row by row, and from there column by column.
template <class F>
using RowStepper = Stepper<Edge<F>::Value::kBits, Edge<F>::Step::kBits, kMaxExtent>;
template <class F>
using ColumnStepper = Stepper<RowStepper<F>::Value::kBits, Edge<F>::Step::kBits, kMaxExtent>;

// One machine word for an edge, in the finest format with 16 integer bits, too. Wider ones work, with two words.
static_assert(ColumnStepper<Format16_8>::Value::kBits == 47);
static_assert(ColumnStepper<Format<16, 16>>::Value::kBits <= 64);

/// Calls sink(y, word, bits) for every row y and word of 64 columns in which `triangle` covers a pixel of `view`; bit
/// i of `bits` is column 64 * word + i. Rows come top to bottom, the words of a row left to right, each at most once.
template <class F, class Clip, class Sink>
constexpr void cover_scalar(const FixedTriangle<F>& triangle, const View<CentreSample, Clip>& view, Sink&& sink) {
  const auto box = pixel_box<F>(triangle, view);
  if (!box) return;
  const auto turned = turned_clockwise<F>(triangle);
  if (!turned) return;

  using Row = RowStepper<F>;
  using Column = ColumnStepper<F>;
  const auto [e0, e1, e2] = make_edges<F>(*turned, sample_position<F>(box->left, box->top, CentreSample::point<F>(0)));
  Row row0(e0.c, e0.b), row1(e1.c, e1.b), row2(e2.c, e2.b);
  const int left = box->left.value(), right = box->right.value();
  for (int y = box->top.value(); y < box->bottom.value(); ++y) {
    Column value0(row0.value(), e0.a), value1(row1.value(), e1.a), value2(row2.value(), e2.a);
    for (int word = left / 64; word * 64 < right; ++word) {
      const int first = std::max(left - word * 64, 0);
      const int end = std::min(right - word * 64, 64);
      std::uint64_t bits = 0;
      for (int bit = first; bit < end; ++bit) {
        // Inside if no edge is negative: the sign of the or.
        const bool inside = (value0.value() | value1.value() | value2.value()) >= constant<0>;
        bits |= std::uint64_t{inside} << bit;
        value0.next(), value1.next(), value2.next();
      }
      if (bits != 0) sink(y, word, bits);
    }
    row0.next(), row1.next(), row2.next();
  }
}

/// The same for any samples: sample s of the pixel in column x is bit (x * samples + s) % 64 of word (x * samples + s)
/// / 64 of its row. An edge function at sample s differs from that at any other sample of the pixel by a constant, so
/// what is stepped is a*i + b*j, common to all samples, and each sample has one constant c for each edge.
template <class F, class Clip, class Sink>
constexpr void cover_scalar(const FixedTriangle<F>& triangle, const View<SamplePattern, Clip>& view, Sink&& sink) {
  const auto box = pixel_box<F>(triangle, view);
  if (!box) return;
  const auto turned = turned_clockwise<F>(triangle);
  if (!turned) return;

  const int samples = view.samples.count();
  std::array<std::array<Edge<F>, 3>, kMaxSamples> edges;
  for (int s = 0; s < samples; ++s) {
    edges[static_cast<std::size_t>(s)] =
        make_edges<F>(*turned, sample_position<F>(box->left, box->top, view.samples.template point<F>(s)));
  }

  using Row = Stepper<1, Edge<F>::Step::kBits, kMaxExtent>;
  using Column = Stepper<Row::Value::kBits, Edge<F>::Step::kBits, kMaxExtent>;
  const auto& [e0, e1, e2] = edges[0];
  Row row0({}, e0.b), row1({}, e1.b), row2({}, e2.b);
  for (int y = box->top.value(); y < box->bottom.value(); ++y) {
    Column step0(row0.value(), e0.a), step1(row1.value(), e1.a), step2(row2.value(), e2.a);
    int word = box->left.value() * samples / 64;
    int bit = box->left.value() * samples % 64;
    std::uint64_t bits = 0;
    const auto flush = [&] {
      if (bits != 0) sink(y, word, bits);
      bits = 0, bit = 0, ++word;
    };
    for (int x = box->left.value(); x < box->right.value(); ++x) {
      for (int s = 0; s < samples; ++s) {
        const auto& [at0, at1, at2] = edges[static_cast<std::size_t>(s)];
        const bool inside =
            ((step0.value() + at0.c) | (step1.value() + at1.c) | (step2.value() + at2.c)) >= constant<0>;
        bits |= std::uint64_t{inside} << bit;
        if (++bit == 64) flush();
      }
      step0.next(), step1.next(), step2.next();
    }
    flush();
    row0.next(), row1.next(), row2.next();
  }
}

}  // namespace edgecase::rasterizer
