// Regions: which part of a target is drawn into, and at which samples, in a form that costs the kernels one addition.
//
// The coverage at a sample off the pixel's centre is that of the triangle moved by what leads from the sample to the
// centre, read at the centres. So a mask of several samples is a plane of strips for each, all drawn by the code for
// centres, and a scissor is a smaller target, to whose first row and strip the triangle is moved just as well.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "rasterizer/fast/strip_mask.h"
#include "rasterizer/format.h"
#include "rasterizer/sample_pattern.h"

namespace edgecase::rasterizer {

/// What is added to a triangle's vertices, in subpixels. At most half a pixel to the right and down, from a sample at
/// 0; and to the left and up 7/16 px, from one at 15, and the up to kMaxExtent - 1 px at which a region begins.
struct PlaneShift {
  using Coordinate = Int<23>;
  static_assert(Coordinate::kMin <= -(kMaxExtent - 1) * 256 - 112 && Coordinate::kMax >= 128);
  Coordinate x;
  Coordinate y;
};

/// Vertices of 16.8 after a PlaneShift.
using ShiftedFormat = Format<17, 8>;
static_assert(decltype(Format16_8::Coordinate() + PlaneShift::Coordinate())::kBits == ShiftedFormat::kBits);

constexpr FixedTriangle<ShiftedFormat> shifted(const FixedTriangle<Format16_8>& triangle, const PlaneShift& by) {
  const auto& [v0, v1, v2] = triangle;
  return {{{v0.x + by.x, v0.y + by.y}, {v1.x + by.x, v1.y + by.y}, {v2.x + by.x, v2.y + by.y}}};
}
constexpr FixedTriangle<ShiftedFormat> widened(const FixedTriangle<Format16_8>& triangle) {
  const auto& [v0, v1, v2] = triangle;
  return {{{v0.x, v0.y}, {v1.x, v1.y}, {v2.x, v2.y}}};
}

/// A rectangle of a target's pixels, not empty, and its samples. Its rows and strips are counted from those of its
/// first pixel on; its columns from the left side of its first strip.
struct Region {
  int first_strip;  ///< in the target
  int top;          ///< in the target
  int left;         ///< columns left <= x < right; 0 <= left < kStripWidth
  int right;
  int height;
  int samples;
  std::array<PlaneShift, kMaxSamples> shifts;

  /// The least and the most that a plane moves a triangle, in either direction.
  constexpr PlaneShift least_shift() const {
    PlaneShift least = shifts[0];
    for (const PlaneShift& by : std::span(shifts).first(static_cast<std::size_t>(samples))) {
      least = {std::min(least.x, by.x), std::min(least.y, by.y)};
    }
    return least;
  }
  constexpr PlaneShift most_shift() const {
    PlaneShift most = shifts[0];
    for (const PlaneShift& by : std::span(shifts).first(static_cast<std::size_t>(samples))) {
      most = {std::max(most.x, by.x), std::max(most.y, by.y)};
    }
    return most;
  }

  constexpr int strip_count() const { return (right + kStripWidth - 1) / kStripWidth; }
  /// The columns of one of its strips, as bits.
  constexpr std::uint32_t columns(int strip) const {
    const int before = left - strip * kStripWidth, end = right - strip * kStripWidth;
    const std::uint32_t from = before > 0 ? ~std::uint32_t{0} << before : ~std::uint32_t{0};
    return end < kStripWidth ? from & ~(~std::uint32_t{0} << end) : from;
  }
};

/// The region that `view` draws into; nothing if no pixel is left of it. `strips`: whether its first strip is one of
/// the target's; else it begins with its first pixel.
template <class Samples, class Clip>
constexpr std::optional<Region> region_of(const View<Samples, Clip>& view, bool strips = true) {
  const PixelBox box = view.bounds();
  if (box.left >= box.right || box.top >= box.bottom) return std::nullopt;
  const int first_strip = strips ? box.left.value() / kStripWidth : 0;
  const int begin = strips ? first_strip * kStripWidth : box.left.value();
  const int top = box.top.value();
  Region region{
      first_strip,          top, box.left.value() - begin, box.right.value() - begin, box.bottom.value() - top,
      view.samples.count(), {}};
  for (int s = 0; s < region.samples; ++s) {
    const auto at = view.samples.template point<Format16_8>(s);
    const auto shift = [](SampleOffset<Format16_8> from, int pixels) {
      return *PlaneShift::Coordinate::checked(128 - from.value() - pixels * 256);
    };
    region.shifts[static_cast<std::size_t>(s)] = {shift(at.x, begin), shift(at.y, top)};
  }
  return region;
}

}  // namespace edgecase::rasterizer
