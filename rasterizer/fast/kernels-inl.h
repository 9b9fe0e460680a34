// Everything but the union of one centre sample: masks of each triangle, counts, first triangles, and regions.
#include "rasterizer/fast/counts-inl.h"
#include "rasterizer/fast/difference-inl.h"
#include "rasterizer/fast/first-inl.h"
#include "rasterizer/fast/grid-inl.h"
#include "rasterizer/fast/rows-inl.h"
#include "rasterizer/fast/tiles-inl.h"

#if defined(EDGECASE_FAST_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_KERNELS_INL_H_
#undef EDGECASE_FAST_KERNELS_INL_H_
#else
#define EDGECASE_FAST_KERNELS_INL_H_
#endif

#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// Border bits.
///
/// A region's first and last strip may hold columns that do not belong to it. What these hold is kept aside while the
/// region is drawn, and put back: a cost of the region's height, not of any triangle.
class KeptColumns {
 public:
  KeptColumns(const Region& region, const Strips& strips, std::size_t apart, std::uint32_t* kept)
      : region_(region), strips_(strips), apart_(apart), kept_(kept) {
    for_each([](std::uint32_t columns, std::uint32_t& word, std::uint32_t& kept_word) { kept_word = word & ~columns; });
  }
  void restore() const {
    for_each([](std::uint32_t columns, std::uint32_t& word, std::uint32_t& kept_word) {
      word = (word & columns) | kept_word;
    });
  }

 private:
  template <class Each>
  void for_each(const Each& each) const {
    std::uint32_t* kept = kept_;
    for (int sample = 0; sample < region_.samples; ++sample) {
      for (const int strip : {0, region_.strip_count() - 1}) {
        const std::uint32_t columns = region_.columns(strip);
        if (columns == ~std::uint32_t{0}) continue;
        std::uint32_t* words = strips_.words + static_cast<std::size_t>(sample) * apart_ +
                               static_cast<std::size_t>(strip) * strips_.stride;
        for (int y = 0; y < region_.height; ++y) each(columns, words[y], kept[y]);
        kept += region_.height;
        if (region_.strip_count() == 1) break;
      }
    }
  }
  const Region& region_;
  const Strips& strips_;
  std::size_t apart_;
  std::uint32_t* kept_;
};

inline void cover_union_in(std::span<const SnappedTriangle> triangles, const Region& region, const Strips& strips,
                           std::size_t apart, std::uint32_t* kept) {
  const KeptColumns outside(region, strips, apart, kept);
  draw_list(triangles, RegionPlanes{region, apart}, region.right, 0, strips);
  outside.restore();
}

/// Calls write(strips, i) for each triangle i, drawn by draw(list, strips) into strips of its own.
template <class Draw, class Write>
HWY_INLINE void draw_each(std::span<const SnappedTriangle> triangles, const Scratch& scratch, const Draw& draw,
                          const Write& write) {
  for (std::size_t first = 0; first < triangles.size(); first += scratch.masks) {
    const auto list = triangles.subspan(first, std::min(scratch.masks, triangles.size() - first));
    draw(list, scratch.strips);
    Strips own = scratch.strips;
    for (std::size_t i = 0; i < list.size(); ++i, own.words += scratch.apart) write(own, first + i);
  }
}

inline void cover_each(std::span<const SnappedTriangle> triangles, int width, const Scratch& scratch,
                       std::uint64_t* masks) {
  const std::uint64_t last_word = ~std::uint64_t{0} >> (63 - (width - 1) % 64);
  const std::size_t mask_words =
      static_cast<std::size_t>(scratch.strips.count + 1) / 2 * static_cast<std::size_t>(scratch.strips.height);
  draw_each(
      triangles, scratch,
      [&](std::span<const SnappedTriangle> list, const Strips& strips) HWY_ATTR {
        std::memset(strips.words, 0, list.size() * scratch.apart * sizeof(std::uint32_t));
        draw_list(list, CentrePlane(), width, scratch.apart, strips);
      },
      [&](const Strips& strips, std::size_t i) { strips_to_rows(strips, last_word, masks + i * mask_words); });
}

inline void cover_each_in(std::span<const SnappedTriangle> triangles, const Region& region, const Scratch& scratch,
                          std::size_t row_words, std::size_t mask_words, std::uint64_t* masks) {
  const std::size_t plane_words = scratch.apart / static_cast<std::size_t>(region.samples);
  const PlaneShift least = region.least_shift(), most = region.most_shift();
  draw_each(
      triangles, scratch,
      [&](std::span<const SnappedTriangle> list, const Strips& strips) HWY_ATTR {
        draw_list(list, RegionPlanes{region, plane_words}, region.right, scratch.apart, strips);
      },
      [&](const Strips& strips, std::size_t i) {
        std::uint64_t* mask = masks + i * mask_words;
        std::fill_n(mask, mask_words, std::uint64_t{0});
        take_to_rows(strips, plane_words, region, StripBox(triangles[i], least, most, region.right, region.height),
                     row_words, mask);
      });
}

inline constexpr FastRasterizer::Kernels kKernels{
    &snap_on_grid,           &cover_union, &cover_union_in, &cover_each,  &cover_each_in,  &first_difference,
    &first_short_difference, &count_each,  &count_each_in,  &cover_first, &cover_first_in, &strips_to_rows,
    &region_to_rows,         &cover_tile,  &find_reach,     &add_words};

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
