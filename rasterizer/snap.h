// The one place where floats become coordinates of the subpixel grid.
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

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

/// The same for a list: triangle i to snapped[i]; both are equally long. After an error `snapped` is unspecified.
///
/// Vertices that lie on the grid already, as most do that were made for a test or snapped before, are read in a loop
/// that compilers turn into vectors: a coordinate that a cast to an integer and back leaves as it is lies on the grid,
/// and every way of rounding leaves it there.
template <class F>
[[nodiscard]] std::optional<InputError> snap_list(std::span<const Triangle> triangles,
                                                  std::span<FixedTriangle<F>> snapped) {
  assert(triangles.size() == snapped.size());
  constexpr std::size_t kAtOnce = 8;
  constexpr std::size_t kCoordinates = 6;
  static_assert(sizeof(Triangle) == kCoordinates * sizeof(float));
  // Exact in binary32 unless it overflows, and infinity is beyond every limit. Magnitudes compare as their bit patterns
  // do. Below 2^24, so that all of the format's integers up to there are binary32.
  constexpr auto kScale = static_cast<float>(std::int64_t{1} << F::kSubpixelBits);
  constexpr auto kLimit = std::bit_cast<std::uint32_t>(static_cast<float>(1 << (std::min(F::kBits, 25) - 1)));
  // Whole groups are read where they are; the last one, if it is less, among zeros.
  Triangle last[kAtOnce] = {};
  for (std::size_t first = 0; first < triangles.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, triangles.size() - first);
    if (count < kAtOnce) std::copy_n(&triangles[first], count, last);
    const auto* pixels = reinterpret_cast<const std::byte*>(count < kAtOnce ? last : &triangles[first]);
    std::int32_t whole[kAtOnce * kCoordinates];
    std::uint32_t off_grid = 0;
    for (std::size_t i = 0; i < kAtOnce * kCoordinates; ++i) {
      float pixel;
      std::memcpy(&pixel, pixels + i * sizeof pixel, sizeof pixel);
      const auto scaled = std::bit_cast<std::uint32_t>(pixel * kScale);
      const std::uint32_t in_range = (scaled & 0x7fffffff) < kLimit ? ~std::uint32_t{0} : 0;
      whole[i] = static_cast<std::int32_t>(std::bit_cast<float>(scaled & in_range));
      off_grid |= std::bit_cast<std::uint32_t>(static_cast<float>(whole[i])) ^ scaled;  // of -0, too: rare
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (off_grid != 0) {
        if (const auto error = snap<F>(triangles[first + i], snapped[first + i], first + i)) return error;
        continue;
      }
      for (std::size_t v = 0; v < 3; ++v) {
        const std::int32_t* vertex = whole + kCoordinates * i + 2 * v;
        snapped[first + i][v] = {*F::Coordinate::checked(vertex[0]), *F::Coordinate::checked(vertex[1])};
      }
    }
  }
  return std::nullopt;
}

}  // namespace edgecase::rasterizer
