// The one place where floats become coordinates of the subpixel grid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "rasterizer/format.h"
#include "rasterizer/input_error.h"

namespace edgecase::rasterizer {

/// |value| rounded to the nearest integer, ties to the even one, with the sign of `value` put back. Requires
/// |value| < 2^52. The cast truncates, whatever the current rounding mode is; the difference is exact.
constexpr std::int64_t round_to_nearest_even(double value) {
  const double magnitude = value < 0 ? -value : value;
  std::int64_t rounded = static_cast<std::int64_t>(magnitude);
  const double rest = magnitude - static_cast<double>(rounded);
  if (rest > 0.5 || (rest == 0.5 && rounded % 2 != 0)) ++rounded;
  return value < 0 ? -rounded : rounded;
}

/// `pixels` on the subpixel grid, rounded to nearest even (D3D11.3 functional specification 3.2.4.1); nothing if it is
/// NaN, infinite, or rounds to a number outside the format.
template <class F>
constexpr std::optional<typename F::Coordinate> snap_coordinate(float pixels) {
  // Exact: binary32 has 24 significant bits and an exponent far inside that of binary64.
  const double scaled = static_cast<double>(pixels) * static_cast<double>(std::int64_t{1} << F::kSubpixelBits);
  constexpr double kLimit = static_cast<double>(std::int64_t{1} << F::kBits);
  if (!(scaled > -kLimit && scaled < kLimit)) return std::nullopt;  // NaN, too
  return F::Coordinate::checked(round_to_nearest_even(scaled));
}

/// Snaps `triangle`, or says which coordinate cannot be; `triangle_index` goes into that error.
template <class F>
[[nodiscard]] constexpr std::optional<InputError> snap(const Triangle& triangle, FixedTriangle<F>& snapped,
                                                       std::size_t triangle_index = 0) {
  for (int i = 0; i < 3; ++i) {
    const Vertex& vertex = triangle[static_cast<std::size_t>(i)];
    const auto x = snap_coordinate<F>(vertex.x);
    if (!x) return make_input_error(triangle_index, i, Axis::x, vertex.x);
    const auto y = snap_coordinate<F>(vertex.y);
    if (!y) return make_input_error(triangle_index, i, Axis::y, vertex.y);
    snapped[static_cast<std::size_t>(i)] = {*x, *y};
  }
  return std::nullopt;
}

}  // namespace edgecase::rasterizer
