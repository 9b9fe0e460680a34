// FastRasterizer on a View: the choice by type. Included by fast.h.
#pragma once

#include <algorithm>
#include <cassert>

#include "rasterizer/fast/fast.h"
#include "rasterizer/fast/region.h"

namespace edgecase::rasterizer {

template <class Samples, class Clip>
void FastRasterizer::cover_union(Triangles triangles, const View<Samples, Clip>& view, StripMask& mask) const {
  assert(mask.target() == view.target && mask.samples() == view.samples.count());
  if constexpr (kIsPlain<Samples, Clip>) {
    cover_union(triangles, mask);
  } else if (const auto region = region_of(view)) {
    cover_union_in(triangles, *region, mask);
  }
}

template <class Samples, class Clip>
void FastRasterizer::cover_each(Triangles triangles, const View<Samples, Clip>& view,
                                std::span<std::uint64_t> masks) const {
  assert(masks.size() == triangles.size() * view.target.mask_words(view.samples.count()));
  if constexpr (kIsPlain<Samples, Clip>) {
    cover_each(triangles, view.target, masks);
  } else if (const auto region = region_of(view)) {
    cover_each_in(triangles, *region, view.target, masks);
  } else {
    std::ranges::fill(masks, std::uint64_t{0});
  }
}

template <class Samples, class Clip>
void FastRasterizer::count_each(Triangles triangles, const View<Samples, Clip>& view,
                                std::span<std::uint64_t> counts) const {
  assert(counts.size() == triangles.size());
  if constexpr (kIsPlain<Samples, Clip>) {
    count_each(triangles, view.target, counts);
  } else if (const auto region = region_of(view, false)) {
    count_each_in(triangles, *region, counts);
  } else {
    std::ranges::fill(counts, std::uint64_t{0});
  }
}

template <class Samples, class Clip>
void FastRasterizer::cover_first(Triangles triangles, const View<Samples, Clip>& view, VisibilityBuffer& buffer,
                                 std::uint32_t first_number) const {
  assert(buffer.target() == view.target && buffer.samples() == view.samples.count());
  if constexpr (kIsPlain<Samples, Clip>) {
    cover_first(triangles, buffer, first_number);
  } else if (const auto region = region_of(view)) {
    cover_first_in(triangles, *region, buffer, first_number);
  }
}

}  // namespace edgecase::rasterizer
