// The first triangle that covers each sample: every triangle is drawn by itself, and what is new of it gets its number.
#include "rasterizer/fast/strip_box.h"
#include "rasterizer/fast/union-inl.h"

#if defined(EDGECASE_FAST_FIRST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_FIRST_INL_H_
#undef EDGECASE_FAST_FIRST_INL_H_
#else
#define EDGECASE_FAST_FIRST_INL_H_
#endif

#include <algorithm>
#include <bit>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// Gives `number` to the columns of a strip's row whose bits are set.
HWY_INLINE void number_columns(std::uint32_t bits, std::uint32_t number, std::uint32_t* to) {
  const auto d = DU32();
  constexpr int kColumns = static_cast<int>(kLanes);
  const U32 numbers = hn::Set(d, number);
  // Bit i of lane i.
  const U32 own_bit = hn::Shl(hn::Set(d, 1), hn::Iota(d, 0));
  for (int column = 0; column < kStripWidth; column += kColumns) {
    const U32 shown = hn::Set(d, bits >> column);
    const auto set = hn::TestBit(shown, own_bit);
    hn::StoreU(hn::IfThenElse(set, numbers, hn::LoadU(d, to + column)), d, to + column);
  }
}

/// Takes a triangle from `own`, which it clears, into what is covered, and numbers what is new. `columns(strip)`: those
/// that may be drawn into.
template <class Columns>
HWY_INLINE void take_first(const StripBox& box, const Strips& own, const Strips& covered, const Columns& columns,
                           std::uint32_t number, std::uint32_t* numbers, std::size_t row_pixels) {
  const auto d = DU32();
  for (int strip = box.first_strip; strip < box.end_strip; ++strip) {
    const std::size_t before = static_cast<std::size_t>(strip) * own.stride;
    std::uint32_t* from = own.words + before;
    std::uint32_t* to = covered.words + static_cast<std::size_t>(strip) * covered.stride;
    const U32 allowed = hn::Set(d, columns(strip));
    for (int y = box.top; y < box.bottom; y += static_cast<int>(kLanes)) {
      const U32 drawn = hn::And(hn::LoadU(d, from + y), allowed);
      hn::StoreU(hn::Zero(d), d, from + y);
      const U32 before_it = hn::LoadU(d, to + y);
      const U32 fresh = hn::AndNot(before_it, drawn);
      if (hn::AllTrue(d, hn::Eq(fresh, hn::Zero(d)))) continue;
      hn::StoreU(hn::Or(before_it, fresh), d, to + y);
      HWY_ALIGN std::uint32_t rows[kMaxLanes];
      hn::Store(fresh, d, rows);
      std::uint32_t* line = numbers + static_cast<std::size_t>(y) * row_pixels + strip * kStripWidth;
      for (std::size_t i = 0; i < kLanes; ++i, line += row_pixels) {
        if (rows[i] != 0) number_columns(rows[i], number, line);
      }
    }
  }
}

/// `columns(strip)` as for take_first(); `covered_apart`: words from plane to plane of what is covered.
template <class Planes, class Columns>
HWY_INLINE void first_in_list(std::span<const SnappedTriangle> triangles, const Planes& planes, int width,
                              const Scratch& scratch, const Strips& covered, std::size_t covered_apart,
                              const Columns& columns, const FirstTriangles& first) {
  for (std::size_t begin = 0; begin < triangles.size(); begin += scratch.masks) {
    const auto list = triangles.subspan(begin, std::min(scratch.masks, triangles.size() - begin));
    draw_list(list, planes, width, scratch.apart, scratch.strips);
    Strips own = scratch.strips;
    for (std::size_t i = 0; i < list.size(); ++i, own.words += scratch.apart) {
      for (int plane = 0; plane < planes.count(); ++plane) {
        Strips from = own, to = covered;
        from.words += planes.words_before(plane);
        to.words += static_cast<std::size_t>(plane) * covered_apart;
        take_first(StripBox(planes.shifted(list[i], plane), width, from.height), from, to, columns,
                   first.first_number + static_cast<std::uint32_t>(begin + i),
                   first.numbers + static_cast<std::size_t>(plane) * first.apart, first.row_pixels);
      }
    }
  }
}

inline void cover_first(std::span<const SnappedTriangle> triangles, int width, const Scratch& scratch,
                        const Strips& covered, const FirstTriangles& first) {
  const int last = covered.count - 1;
  const std::uint32_t last_columns = ~std::uint32_t{0} >> (kStripWidth - 1 - (width - 1) % kStripWidth);
  const auto columns = [&](int strip) { return strip == last ? last_columns : ~std::uint32_t{0}; };
  first_in_list(triangles, CentrePlane(), width, scratch, covered, 0, columns, first);
}

inline void cover_first_in(std::span<const SnappedTriangle> triangles, const Region& region, const Scratch& scratch,
                           const Strips& covered, std::size_t apart, const FirstTriangles& first) {
  const RegionPlanes planes{region, scratch.apart / static_cast<std::size_t>(region.samples)};
  const auto columns = [&](int strip) { return region.columns(strip); };
  first_in_list(triangles, planes, region.right, scratch, covered, apart, columns, first);
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
