// Tempting arithmetics that are not exact, each a few lines on one of two hosts: edge functions tested pixel by pixel,
// and edges stepped row by row. Fill rule, winding and bounding box are right in all of them; what is wrong is the
// arithmetic alone. One sample, in the pixel's centre.
//
// An arithmetic has a type Vertices, made from a triangle by prepare(), outside of any timing, and a function
// cover(vertices, target, mask) that adds the coverage of one triangle to a mask of target's MaskLayout.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance::inexact {

/// A mask that knows the length of its rows.
struct Canvas {
  Extent target;
  std::size_t row_words;
  MutableMaskView words;

  std::uint64_t* row(int y) const { return words.data() + static_cast<std::size_t>(y) * row_words; }
};

template <class Number>
struct Point {
  Number x;
  Number y;
};
template <class Number>
using Points = std::array<Point<Number>, 3>;

/// 32 bits and no more: what overflows wraps around, as it does in hardware.
struct Wrapping32 {
  std::uint32_t bits = 0;

  friend Wrapping32 operator+(Wrapping32 a, Wrapping32 b) { return {a.bits + b.bits}; }
  friend Wrapping32 operator-(Wrapping32 a, Wrapping32 b) { return {a.bits - b.bits}; }
  friend Wrapping32 operator*(Wrapping32 a, Wrapping32 b) { return {a.bits * b.bits}; }
  friend bool operator==(Wrapping32 a, Wrapping32 b) = default;
  friend std::strong_ordering operator<=>(Wrapping32 a, Wrapping32 b) {
    return static_cast<std::int32_t>(a.bits) <=> static_cast<std::int32_t>(b.bits);
  }
};

/// How Arithmetic::Number steps from one pixel centre to the next.
enum class Stepping { anew, accumulated };

/// First host: a*x + b*y + c for each edge and each pixel of the bounding box, in Arithmetic::Number.
template <class Arithmetic, Stepping stepping = Stepping::anew>
struct EdgeFunctions {
  using Number = typename Arithmetic::Number;
  using Vertices = Points<Number>;

  static Vertices prepare(const Triangle& triangle) {
    Vertices v;
    for (std::size_t i = 0; i < 3; ++i)
      v[i] = {Arithmetic::coordinate(triangle[i].x), Arithmetic::coordinate(triangle[i].y)};
    return v;
  }

  static void cover(const Vertices& vertices, const Canvas& canvas) {
    const Number zero{};
    auto [v0, v1, v2] = vertices;
    const Number area = (v1.x - v0.x) * (v2.y - v0.y) - (v2.x - v0.x) * (v1.y - v0.y);
    if (area == zero) return;
    if (area < zero) std::swap(v1, v2);

    const auto [min_x, max_x] = std::minmax({v0.x, v1.x, v2.x});
    const auto [min_y, max_y] = std::minmax({v0.y, v1.y, v2.y});
    const int left = Arithmetic::pixel_of(min_x, canvas.target.width),
              right = Arithmetic::pixel_of(max_x, canvas.target.width);
    const int top = Arithmetic::pixel_of(min_y, canvas.target.height),
              bottom = Arithmetic::pixel_of(max_y, canvas.target.height);

    struct Edge {
      Number a, b, c;
      bool top_left;
      bool accepts(Number value) const { return value > Number{} || (value == Number{} && top_left); }
    };
    const auto edge = [&](const Point<Number>& p, const Point<Number>& q) {
      const Number a = p.y - q.y, b = q.x - p.x;
      return Edge{a, b, p.x * q.y - q.x * p.y, a > zero || (a == zero && b > zero)};
    };
    const std::array<Edge, 3> edges{edge(v0, v1), edge(v1, v2), edge(v2, v0)};
    // In accumulated stepping, the edges' values at the pixel at hand.
    std::array<Number, 3> values{};
    const Number one_pixel = Arithmetic::centre(1) - Arithmetic::centre(0);
    for (int y = top; y <= bottom && y < canvas.target.height; ++y) {
      std::array<Number, 3> row_values;
      for (std::size_t e = 0; e < 3; ++e) {
        row_values[e] = edges[e].b * Arithmetic::centre(y) + edges[e].c;
        values[e] = edges[e].a * Arithmetic::centre(left) + row_values[e];
      }
      std::uint64_t* const row = canvas.row(y);
      for (int x = left; x <= right && x < canvas.target.width; ++x) {
        bool inside = true;
        for (std::size_t e = 0; e < 3; ++e) {
          if constexpr (stepping == Stepping::accumulated) {
            inside &= edges[e].accepts(values[e]);
            values[e] = values[e] + edges[e].a * one_pixel;
          } else {
            inside &= edges[e].accepts(edges[e].a * Arithmetic::centre(x) + row_values[e]);
          }
        }
        row[x / 64] |= std::uint64_t{inside} << (x % 64);
      }
    }
  }
};

/// Pixels, in floating point; not snapped.
template <class Real>
struct Floating {
  using Number = Real;
  static Number coordinate(float pixels) { return static_cast<Real>(pixels); }
  static Number centre(int pixel) { return static_cast<Real>(pixel) + Real{0.5}; }
  static int pixel_of(Number coordinate, int end) {
    return static_cast<int>(std::clamp(std::floor(coordinate), Real{0}, static_cast<Real>(end)));
  }
};

/// 256ths of a pixel, in integers, after snapping to 2^-Bits px, ties to even.
template <class Integer, int Bits>
struct FixedPoint {
  using Number = Integer;
  static std::int64_t snapped(float pixels) {
    const double nearest = std::nearbyint(std::ldexp(static_cast<double>(pixels), Bits));
    return static_cast<std::int64_t>(nearest) * (std::int64_t{256} >> Bits);
  }
  static Number number(std::int64_t value) {
    if constexpr (std::is_same_v<Integer, Wrapping32>) {
      return {static_cast<std::uint32_t>(value)};
    } else {
      return value;
    }
  }
  static Number coordinate(float pixels) { return number(snapped(pixels)); }
  static Number centre(int pixel) { return number(std::int64_t{pixel} * 256 + 128); }
  static int pixel_of(Number coordinate, int end) {
    std::int64_t value;
    if constexpr (std::is_same_v<Integer, Wrapping32>) {
      value = static_cast<std::int32_t>(coordinate.bits);
    } else {
      value = coordinate;
    }
    return static_cast<int>(std::clamp<std::int64_t>(value >> 8, 0, end));
  }
};

/// Second host: for each row the columns between a left and a right edge, x stepped by the edge's slope from row to
/// row. A DDA, or digital differential analyser. `Edge(p, q, row)` begins in that row, one between the rows of p and q.
template <class Edge>
struct SlopeStepping {
  using Vertices = Points<float>;

  static Vertices prepare(const Triangle& triangle) {
    Vertices v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = {triangle[i].x, triangle[i].y};
    return v;
  }

  static void cover(const Vertices& vertices, const Canvas& canvas) {
    auto v = vertices;
    std::stable_sort(v.begin(), v.end(), [](const auto& p, const auto& q) { return p.y < q.y; });
    const auto& [high, middle, low] = v;
    const auto row_of = [&](const Point<float>& p) {
      return static_cast<int>(std::clamp(Edge::first_row(p.y), 0.0f, static_cast<float>(canvas.target.height)));
    };
    const int top = row_of(high), split = row_of(middle), bottom = row_of(low);
    const double area = (static_cast<double>(middle.x) - high.x) * (static_cast<double>(low.y) - high.y) -
                        (static_cast<double>(low.x) - high.x) * (static_cast<double>(middle.y) - high.y);
    if (area == 0 || top == bottom) return;
    Edge longest(high, low, top);
    const auto cover_rows = [&](Edge other, int from, int to) {
      for (int y = from; y < to; ++y, longest.next_row(), other.next_row()) {
        int x = longest.first_column(canvas.target.width), end = other.first_column(canvas.target.width);
        if (area < 0) std::swap(x, end);
        while (x < end) {
          const int next = std::min((x / 64 + 1) * 64, end);
          canvas.row(y)[x / 64] |= ~std::uint64_t{0} >> (64 - (next - x)) << (x % 64);
          x = next;
        }
      }
    };
    if (top < split) cover_rows(Edge(high, middle, top), top, split);
    if (split < bottom) cover_rows(Edge(middle, low, split), split, bottom);
  }
};

/// binary32, one addition of the slope per row.
class FloatSlope {
 public:
  FloatSlope(const Point<float>& p, const Point<float>& q, int row)
      : slope_((q.x - p.x) / (q.y - p.y)), x_(p.x + (static_cast<float>(row) + 0.5f - p.y) * slope_) {}

  /// The first row whose sample is at or below y.
  static float first_row(float y) { return std::ceil(y - 0.5f); }
  /// The first column whose sample is at or right of the edge in this row.
  int first_column(int end) const {
    return static_cast<int>(std::clamp(std::ceil(x_ - 0.5f), 0.0f, static_cast<float>(end)));
  }
  void next_row() { x_ += slope_; }

 private:
  float slope_;
  float x_;
};

/// 16.16 fixed point, the slope truncated to it.
class FixedSlope {
 public:
  FixedSlope(const Point<float>& p, const Point<float>& q, int row) {
    const double slope = (static_cast<double>(q.x) - p.x) / (static_cast<double>(q.y) - p.y);
    slope_ = static_cast<std::int64_t>(slope * 65536);
    // From p to the centre of the row, in 16.16, too.
    const auto down = static_cast<std::int64_t>((row + 0.5 - p.y) * 65536);
    x_ = static_cast<std::int64_t>(static_cast<double>(p.x) * 65536) +
         static_cast<std::int64_t>(static_cast<double>(down) / 65536 * static_cast<double>(slope_));
  }

  static float first_row(float y) { return FloatSlope::first_row(y); }
  int first_column(int end) const {
    // ceil(x - 1/2)
    return static_cast<int>(std::clamp<std::int64_t>((x_ + 32767) >> 16, 0, end));
  }
  void next_row() { x_ += slope_; }

 private:
  std::int64_t slope_;
  std::int64_t x_;
};

/// The ends moved to the nearest whole pixels, but the slope that of the edge as it was.
class SnappedEndsSlope {
 public:
  SnappedEndsSlope(const Point<float>& p, const Point<float>& q, int row)
      : slope_((q.x - p.x) / (q.y - p.y)),
        x_(std::round(p.x) + (static_cast<float>(row) + 0.5f - std::round(p.y)) * slope_) {}

  static float first_row(float y) { return std::round(y); }
  int first_column(int end) const {
    return static_cast<int>(std::clamp(std::ceil(x_ - 0.5f), 0.0f, static_cast<float>(end)));
  }
  void next_row() { x_ += slope_; }

 private:
  float slope_;
  float x_;
};

}  // namespace edgecase::conformance::inexact
