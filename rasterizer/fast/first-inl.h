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
#include <optional>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// Where numbers go that are given in one plane.
struct Numbering {
  Strips covered;          ///< the samples that have a number
  std::uint32_t* numbers;  ///< of the first pixel; `row_pixels` further on for each row
  std::size_t row_pixels;
};

/// Gives `number` to the columns of a strip's row whose bits are set, at least one.
HWY_INLINE void number_columns(std::uint32_t bits, std::uint32_t number, std::uint32_t* to) {
  const auto d = DU32();
  constexpr int kColumns = static_cast<int>(kLanes);
  const U32 numbers = hn::Set(d, number);
  // Bit i of lane i.
  const U32 own_bit = hn::Shl(hn::Set(d, 1), hn::Iota(d, 0));
  const auto end = static_cast<int>(std::bit_width(bits));
  for (int column = std::countr_zero(bits) & -kColumns; column < end; column += kColumns) {
    const auto set = hn::TestBit(hn::Set(d, bits >> column), own_bit);
#if HWY_TARGET <= HWY_AVX3
    hn::BlendedStore(numbers, set, d, to + column);
#else
    hn::StoreU(hn::IfThenElse(set, numbers, hn::LoadU(d, to + column)), d, to + column);
#endif
  }
}

/// Takes a triangle, which it clears, into what is covered, and numbers what is new. Its strips begin at `own`, with
/// the first row and strip of its box, `stride` words apart. `columns(strip)`: those that may be drawn into.
template <class Columns>
HWY_INLINE void take_first(const StripBox& box, std::uint32_t* own, std::size_t stride, const Columns& columns,
                           std::uint32_t number, const Numbering& to) {
  const auto d = DU32();
  for (int strip = box.first_strip; strip < box.end_strip; ++strip, own += stride) {
    std::uint32_t* covered = to.covered.words + static_cast<std::size_t>(strip) * to.covered.stride + box.top;
    const U32 allowed = hn::Set(d, columns(strip));
    for (int y = 0; y < box.bottom - box.top; y += static_cast<int>(kLanes)) {
      const U32 drawn = hn::And(hn::LoadU(d, own + y), allowed);
      hn::StoreU(hn::Zero(d), d, own + y);
      const U32 before_it = hn::LoadU(d, covered + y);
      const U32 fresh = hn::AndNot(before_it, drawn);
      std::uint64_t rows = bits_of(hn::RebindMask(DI32(), hn::Ne(fresh, hn::Zero(d))));
      if (rows == 0) continue;
      hn::StoreU(hn::Or(before_it, fresh), d, covered + y);
      HWY_ALIGN std::uint32_t fresh_rows[kMaxLanes];
      hn::Store(fresh, d, fresh_rows);
      std::uint32_t* line = to.numbers + static_cast<std::size_t>(box.top + y) * to.row_pixels + strip * kStripWidth;
      for (; rows != 0; rows &= rows - 1) {
        const auto row = static_cast<std::size_t>(std::countr_zero(rows));
        number_columns(fresh_rows[row], number, line + row * to.row_pixels);
      }
    }
  }
}

/// The triangles moved into the first row and strip. Their edges are counted from there anyway.
HWY_INLINE LaneSetup moved_to_corner(const LaneSetup& s) {
  const auto d = DI32();
  LaneSetup moved = s;
  moved.left = hn::Sub(s.left, s.strip_left);
  moved.right = hn::Sub(s.right, s.strip_left);
  moved.strip_left = hn::Zero(d);
  moved.middle = hn::Sub(s.middle, s.top);
  moved.bottom = hn::Sub(s.bottom, s.top);
  moved.top = hn::Zero(d);
  return moved;
}

/// Those of kLanes triangles that fit into a block of fewer rows, each in a block of its own.
struct Blocks {
  static constexpr int kRows = kUnaskedRows;
  static constexpr std::size_t kStride = kRows;
  static constexpr std::size_t kApart = 2 * kStride;
  static_assert(kBlockColumns == 2 * kStripWidth && kSmallRows <= kRows);
  HWY_ALIGN std::uint32_t words[kMaxLanes * kApart] = {};
};

/// Numbers kLanes triangles, from `number` on, set up for plane `plane`. `blocks` and `scratch`, a target's strips, are
/// clear, and are left so.
template <class Planes, class Columns>
HWY_INLINE void first_in_plane(const SnappedTriangle* triangles, const LaneSetup& setup, const Planes& planes,
                               int plane, int width, Blocks& blocks, const Strips& scratch, const Columns& columns,
                               std::uint32_t number, const Numbering& to) {
  const auto d = DI32();
  const I32 is_inside = inside(planes, setup, width, scratch.height);
  const Ways ways = ways_of(setup, is_inside, width, scratch.height);
  const std::uint64_t small = bits_of(hn::Gt(filled_rows(setup, ways.small), hn::Zero(d)));
  const std::uint64_t block = block_lanes(setup, is_inside, ways.others, Blocks::kRows, scratch.height);
  const LaneSetup moved = moved_to_corner(setup);
  const Strips corner{blocks.words, Blocks::kStride, 2, Blocks::kRows};
  const I32 base = hn::Mul(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(Blocks::kApart)));
  draw_small(moved, ways.small, base, corner);
  StoredBlocks stored;
  if (block != 0) store(moved, stored);
  for (std::uint64_t lanes = block; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    Strips own = corner;
    own.words += lane * Blocks::kApart;
    draw_block(stored, lane, own);
  }
  HWY_ALIGN std::int32_t first_strip[kMaxLanes], end_strip[kMaxLanes], top[kMaxLanes], bottom[kMaxLanes];
  hn::Store(hn::ShiftRight<5>(setup.strip_left), d, first_strip);
  hn::Store(hn::ShiftRight<5>(hn::Add(setup.right, hn::Set(d, kStripWidth - 1))), d, end_strip);
  hn::Store(setup.top, d, top);
  hn::Store(setup.bottom, d, bottom);
  std::optional<LaneHalves> halves;
  if ((ways.others & ~block) != 0) halves.emplace(halves_of(triangles, planes, plane, width, scratch.height));
  // In the order of the list, whatever their sizes.
  for (std::uint64_t lanes = small | ways.others; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    const std::uint32_t own_number = number + static_cast<std::uint32_t>(lane);
    if ((small | block) >> lane & 1) {
      const StripBox box(first_strip[lane], end_strip[lane], top[lane], bottom[lane]);
      take_first(box, blocks.words + lane * Blocks::kApart, Blocks::kStride, columns, own_number, to);
      continue;
    }
    const auto triangle = planes.shifted(triangles[lane], plane);
    draw_halves(halves->of(lane), scratch);
    const StripBox box(triangle, width, scratch.height);
    std::uint32_t* own = scratch.words + static_cast<std::size_t>(box.first_strip) * scratch.stride + box.top;
    take_first(box, own, scratch.stride, columns, own_number, to);
  }
}

/// `columns(strip)` as for take_first(); `covered_apart`: words from plane to plane of what is covered.
template <class Planes, class Columns>
HWY_INLINE void first_in_list(std::span<const SnappedTriangle> triangles, const Planes& planes, int width,
                              const Strips& scratch, const Strips& covered, std::size_t covered_apart,
                              const Columns& columns, const FirstTriangles& first) {
  Blocks blocks;
  in_groups(triangles, [&](const SnappedTriangle* group, std::size_t begin, std::size_t groups) HWY_ATTR {
    auto number = first.first_number + static_cast<std::uint32_t>(begin);
    for (; groups != 0; --groups, group += kLanes, number += static_cast<std::uint32_t>(kLanes)) {
      const LaneTriangle lanes = make_lane_triangle(load_vertices(group));
      for (int plane = 0; plane < planes.count(); ++plane) {
        Numbering to{covered, first.numbers + static_cast<std::size_t>(plane) * first.apart, first.row_pixels};
        to.covered.words += static_cast<std::size_t>(plane) * covered_apart;
        first_in_plane(group, make_lane_setup(lanes, planes.shift(plane)), planes, plane, width, blocks, scratch,
                       columns, number, to);
      }
    }
  });
}

inline void cover_first(std::span<const SnappedTriangle> triangles, int width, const Strips& scratch,
                        const Strips& covered, const FirstTriangles& first) {
  const int last = covered.count - 1;
  const std::uint32_t last_columns = ~std::uint32_t{0} >> (kStripWidth - 1 - (width - 1) % kStripWidth);
  const auto columns = [&](int strip) { return strip == last ? last_columns : ~std::uint32_t{0}; };
  first_in_list(triangles, CentrePlane(), width, scratch, covered, 0, columns, first);
}

inline void cover_first_in(std::span<const SnappedTriangle> triangles, const Region& region, const Strips& scratch,
                           const Strips& covered, std::size_t apart, const FirstTriangles& first) {
  const auto columns = [&](int strip) { return region.columns(strip); };
  first_in_list(triangles, RegionPlanes{region, apart}, region.right, scratch, covered, apart, columns, first);
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
