// The scan-line way: two trapezoids, split at the middle vertex, whose left and right edges are stepped row by row.
//
// After Michael Abrash, "Graphics Programming Black Book", 1997, chapters 38 and 39: an edge is kept as the integer
// column where it stands and the remainder of the division that gave it, and the next row is one addition to each, as
// in Bresenham's line.
//
// Exact: in row j an edge lets pixel i pass if a*i + (c + b*j) >= 0, so with v = c + b*j
//
//   a > 0, a left edge:    i >= -v/a     the first column is  ceil(-v/a) = -floor(v/a)
//   a < 0, a right edge:   i <= v/|a|    the column after the last is  floor(v/|a|) + 1
//
// and both need floor(v/|a|) = quotient, with v = quotient*|a| + remainder, 0 <= remainder < |a|. One row down v grows
// by b = step*|a| + rest, 0 <= rest < |a|: the quotient grows by step, the remainder by rest, and a remainder that has
// reached |a| gives |a| back for one more in the quotient. Nothing is rounded, so nothing adds up. |quotient| <= |v| +
// 1, and v fits (setup.h).
//
// Horizontal edges need no test: rows whose samples lie in [y of the top vertex, y of the middle one) belong to the
// upper trapezoid, those in [y of the middle one, y of the bottom one) to the lower, which is the top-left rule in y.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "rasterizer/family/setup.h"

namespace edgecase::rasterizer::family {

/// floor(v / |a|), row after row.
class ScanEdge {
 public:
  /// Beginning j rows below the edge's origin; the edge is not horizontal.
  constexpr ScanEdge(const PlainEdge& edge, int j)
      : divisor_(edge.a < 0 ? -edge.a : edge.a),
        quotient_(floor_quotient(edge.at(0, j), divisor_)),
        remainder_(edge.at(0, j) - quotient_ * divisor_),
        step_(floor_quotient(edge.b, divisor_)),
        rest_(edge.b - step_ * divisor_) {}

  constexpr std::int64_t quotient() const { return quotient_; }

  constexpr void next_row() {
    quotient_ += step_;
    remainder_ += rest_;
    if (remainder_ >= divisor_) {
      remainder_ -= divisor_;
      ++quotient_;
    }
  }

 private:
  static constexpr std::int64_t floor_quotient(std::int64_t value, std::int64_t divisor) {
    return value / divisor - (value % divisor < 0 ? 1 : 0);
  }

  std::int64_t divisor_;
  std::int64_t quotient_;
  std::int64_t remainder_;
  std::int64_t step_;
  std::int64_t rest_;
};

template <class F, class Sink>
constexpr void cover_trapezoid(const FixedTriangle<F>& triangle, const Target& target, Sink&& sink) {
  static_assert(value_bits<F> < 64);
  const auto box = pixel_box<F>(triangle, View<>{target});
  if (!box) return;
  auto [high, middle, low] = triangle;
  if (high.y > middle.y) std::swap(high, middle);
  if (middle.y > low.y) std::swap(middle, low);
  if (high.y > middle.y) std::swap(high, middle);
  const auto area = doubled_area<F>({high, middle, low});
  if (area == constant<0>) return;

  // The first row of the box whose sample is at or below y, or the end of the box.
  const auto first_row_from = [&](typename F::Coordinate y) {
    constexpr auto kBelowOnePixel = constant<(std::int64_t{1} << F::kSampleBits) - 1>;
    const auto row =
        (on_sample_grid<F>(y) - CentreSample::point<F>(0).y + kBelowOnePixel).template shifted_right<F::kSampleBits>();
    return clamp(row, box->top, box->bottom).value();
  };
  const int top = box->top.value(), split = first_row_from(middle.y), bottom = first_row_from(low.y);
  const int left = box->left.value(), width = box->right.value() - left;

  const auto origin = sample_position<F>(box->left, box->top, CentreSample::point<F>(0));
  const auto edge = [&](const FixedVertex<F>& p, const FixedVertex<F>& q) {
    const Edge<F> made = make_edge<F>(p, q, origin);
    return PlainEdge{made.a.value(), made.b.value(), made.c.value()};
  };
  const auto cover_rows = [&](const PlainEdge& left_edge, const PlainEdge& right_edge, int from, int to) {
    if (from >= to) return;
    ScanEdge first(left_edge, from - top), last(right_edge, from - top);
    for (int y = from; y < to; ++y, first.next_row(), last.next_row()) {
      const int x = left + static_cast<int>(std::clamp<std::int64_t>(-first.quotient(), 0, width));
      const int end = left + static_cast<int>(std::clamp<std::int64_t>(last.quotient() + 1, 0, width));
      emit_span(y, x, end, sink);
    }
  };
  // With the inside on the right of the way, left edges go up and right edges down.
  if (area > constant<0>) {  // the middle vertex is on the right
    cover_rows(edge(low, high), edge(high, middle), top, split);
    cover_rows(edge(low, high), edge(middle, low), split, bottom);
  } else {
    cover_rows(edge(middle, high), edge(high, low), top, split);
    cover_rows(edge(low, middle), edge(high, low), split, bottom);
  }
}

}  // namespace edgecase::rasterizer::family
