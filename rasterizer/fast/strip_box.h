// StripBox: where the samples of a triangle are, in strips and rows.
#pragma once

#include <algorithm>

#include "rasterizer/fast/region.h"
#include "rasterizer/fast/strip_mask.h"

namespace edgecase::rasterizer {

/// Strips and rows of a target that hold the samples of a triangle.
struct StripBox {
  int first_strip, end_strip, top, bottom;

  /// All of a target.
  explicit StripBox(const Strips& strips) : first_strip(0), end_strip(strips.count), top(0), bottom(strips.height) {}

  StripBox(int first_strip, int end_strip, int top, int bottom)
      : first_strip(first_strip), end_strip(end_strip), top(top), bottom(bottom) {}

  StripBox(const FixedTriangle<ShiftedFormat>& triangle, int width, int height)
      : StripBox(triangle, PlaneShift{}, PlaneShift{}, width, height) {}

  /// In all planes, which move the triangle by between `least` and `most` in either direction.
  template <class Format>
  StripBox(const FixedTriangle<Format>& triangle, const PlaneShift& least, const PlaneShift& most, int width,
           int height) {
    const auto& [v0, v1, v2] = triangle;
    const auto [left, right] = std::minmax({v0.x.value(), v1.x.value(), v2.x.value()});
    const auto [upper, lower] = std::minmax({v0.y.value(), v1.y.value(), v2.y.value()});
    const auto first_in = [](int v, int extent) { return std::clamp((v + 127) >> 8, 0, extent); };
    first_strip = first_in(left + least.x.value(), width) / kStripWidth;
    end_strip = (first_in(right + most.x.value(), width) + kStripWidth - 1) / kStripWidth;
    top = first_in(upper + least.y.value(), height);
    bottom = first_in(lower + most.y.value(), height);
  }
};

}  // namespace edgecase::rasterizer
