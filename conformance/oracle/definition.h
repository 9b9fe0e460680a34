// By definition: the exact arithmetic that cover_by_definition and allow_by_definition share. No other part may use it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>

#include "conformance/scene/explanation.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance::oracle::definition {

// 2^24 px with 16 subpixel bits are 2^40 grid units; differences have 42 bits with sign, their products 84, sums 85.
__extension__ using Wide = __int128;

// The same in 64 bits, for points less than this far from the origin: differences stay below 2^30, their products below
// 2^60, sums below 2^61.
using Narrow = std::int64_t;
inline constexpr std::int64_t kNarrowReach = std::int64_t{1} << 29;

template <typename Number>
struct PointIn {
  Number x = 0;
  Number y = 0;
};
using Point = PointIn<Wide>;

// A finite binary32 is mantissa * 2^exponent with an integer mantissa of at most 24 bits, so that times 2^bits it is an
// integer plus a fraction of -(exponent + bits) bits, and every rounding is a comparison of that fraction with a
// constant: |coordinate| * 2^bits = whole + fraction / 2^fraction_bits.
struct Split {
  bool negative = false;
  std::int64_t whole = 0;
  std::int64_t fraction = 0;
  int fraction_bits = 0;

  Split(float coordinate, int subpixel_bits) {
    const auto pattern = std::bit_cast<std::uint32_t>(coordinate);
    negative = (pattern >> 31) != 0;
    const int biased = static_cast<int>(pattern >> 23 & 0xff);
    const std::int64_t mantissa = (pattern & 0x7fffff) | (biased == 0 ? 0 : 0x800000);
    const int shift = std::max(biased, 1) - 150 + subpixel_bits;
    assert(biased <= 127 + 24);
    if (shift >= 0) {
      whole = mantissa * (std::int64_t{1} << shift);
      return;
    }
    // 26 fraction bits already put the whole mantissa below one quarter: whatever lies below decides no rounding.
    fraction_bits = std::min(-shift, 26);
    whole = mantissa >> fraction_bits;
    fraction = mantissa & ((std::int64_t{1} << fraction_bits) - 1);
  }

  std::int64_t with_sign(std::int64_t magnitude) const { return negative ? -magnitude : magnitude; }
};

// Everything below is in units of 1/2^bits px, bits being fine enough for the vertices and the sample locations both.
inline int common_bits(const Rules& rules) { return std::max(rules.subpixel_bits, kSampleGridBits); }

template <typename Number = Wide>
PointIn<Number> sample_point(const Rules& rules, const SampleLocation& location, int x, int y) {
  const int bits = common_bits(rules);
  const int sample_shift = bits - kSampleGridBits;
  return {(Number{x} << bits) + (Number{location.x} << sample_shift),
          (Number{y} << bits) + (Number{location.y} << sample_shift)};
}

template <typename Number>
struct EdgeIn {
  int from = 0;
  int to = 0;
  PointIn<Number> start;
  Number dx = 0;
  Number dy = 0;

  // Positive on the right-hand side of start -> end as seen on the screen (y down).
  Number at(const PointIn<Number>& p) const { return dx * (p.y - start.y) - dy * (p.x - start.x); }
  // With the inside on its right, a horizontal edge above the triangle runs to the right, a left edge upwards.
  bool is_top() const { return dy == 0 && dx > 0; }
  bool is_left() const { return dy < 0; }
  bool accepts(Number value) const { return value > 0 || (value == 0 && (is_top() || is_left())); }
};

// The triangle's edges in an order that has the inside on their right.
template <typename Number>
struct OutlineIn {
  using Point = PointIn<Number>;
  using Edge = EdgeIn<Number>;
  std::array<GridPoint, 3> snapped;
  std::array<Point, 3> vertices;
  std::array<Edge, 3> edges;
  bool degenerate = false;
  bool clockwise = false;

  OutlineIn(const Rules& rules, const std::array<GridPoint, 3>& points) : snapped(points) {
    const int shift = common_bits(rules) - rules.subpixel_bits;
    for (std::size_t i = 0; i < 3; ++i) {
      vertices[i] = {Number{snapped[i].x} << shift, Number{snapped[i].y} << shift};
    }
    const Number area = edge(0, 1).at(vertices[2]);
    degenerate = area == 0;
    clockwise = area > 0;
    edges = area >= 0 ? std::array{edge(0, 1), edge(1, 2), edge(2, 0)} : std::array{edge(0, 2), edge(2, 1), edge(1, 0)};
  }

  Edge edge(int from, int to) const {
    const Point& a = vertices[static_cast<std::size_t>(from)];
    const Point& b = vertices[static_cast<std::size_t>(to)];
    return {from, to, a, b.x - a.x, b.y - a.y};
  }

  bool covers(const Point& p) const {
    return !degenerate && std::all_of(edges.begin(), edges.end(), [&](const Edge& e) { return e.accepts(e.at(p)); });
  }

  bool strictly_holds(const Point& p) const {
    return !degenerate && std::all_of(edges.begin(), edges.end(), [&](const Edge& e) { return e.at(p) > 0; });
  }

  // Inside or on an edge. What has no area is all edge: the points between its outermost vertices.
  bool reaches(const Point& p) const {
    if (!degenerate) return std::all_of(edges.begin(), edges.end(), [&](const Edge& e) { return e.at(p) >= 0; });
    const auto [left, right] = std::minmax({vertices[0].x, vertices[1].x, vertices[2].x});
    const auto [top, bottom] = std::minmax({vertices[0].y, vertices[1].y, vertices[2].y});
    return left <= p.x && p.x <= right && top <= p.y && p.y <= bottom &&
           std::all_of(edges.begin(), edges.end(), [&](const Edge& e) { return e.at(p) == 0; });
  }
};
using Edge = EdgeIn<Wide>;
using Outline = OutlineIn<Wide>;

// By definition again: the scissor is asked pixel by pixel.
inline bool scissor_holds(const Setting& setting, int x, int y) {
  if (!setting.scissor) return true;
  const Rect& r = *setting.scissor;
  return x >= r.x && x < std::int64_t{r.x} + r.width && y >= r.y && y < std::int64_t{r.y} + r.height;
}

// By definition, too: the front is whichever winding the setting calls so.
template <typename Number>
bool is_culled(const Setting& setting, const OutlineIn<Number>& outline) {
  const bool front = outline.clockwise == (setting.front_face == FrontFace::clockwise);
  return setting.cull != CullMode::none && front == (setting.cull == CullMode::front);
}

}  // namespace edgecase::conformance::oracle::definition
