// Lists of triangles: each group of as many as a vector has lanes is set up at once and goes the way of its sizes.
#include "rasterizer/fast/large-inl.h"

#if defined(EDGECASE_FAST_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_KERNELS_INL_H_
#undef EDGECASE_FAST_KERNELS_INL_H_
#else
#define EDGECASE_FAST_KERNELS_INL_H_
#endif

#include <array>
#include <cstring>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

using SnappedTriangle = FixedTriangle<Format16_8>;
static_assert(sizeof(SnappedTriangle) == 6 * sizeof(std::int32_t) && std::is_trivially_copyable_v<SnappedTriangle>);

/// kLanes triangles, a triangle to a lane.
HWY_INLINE LaneVertices load_vertices(const SnappedTriangle* triangles) {
  LaneVertices v;
  const auto d = DI32();
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t i = 0; i < 3; ++i) {
    v.x[i] = hn::Set(d, (*triangles)[i].x.value());
    v.y[i] = hn::Set(d, (*triangles)[i].y.value());
  }
#else
  // A vertex is one lane of 64 bits, x in its lower half. Read by vector loads only, which may alias anything.
  const hn::Repartition<std::uint64_t, DI32> pairs;
  const auto* words = reinterpret_cast<const std::uint64_t*>(triangles);
  hn::Vec<decltype(pairs)> low[3], high[3];
  hn::LoadInterleaved3(pairs, words, low[0], low[1], low[2]);
  hn::LoadInterleaved3(pairs, words + 3 * kLanes / 2, high[0], high[1], high[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    v.x[i] = hn::ConcatEven(d, hn::BitCast(d, high[i]), hn::BitCast(d, low[i]));
    v.y[i] = hn::ConcatOdd(d, hn::BitCast(d, high[i]), hn::BitCast(d, low[i]));
  }
#endif
  return v;
}

/// The same with (left, top) as the origin of coordinates: they stay below 2^15 + 2^14 px, which the arithmetic of all
/// paths allows, as it is in differences, in rows, or in pixels below 2^16 + 1.
HWY_INLINE LaneVertices load_vertices(const SnappedTriangle* triangles, Point origin) {
  LaneVertices v = load_vertices(triangles);
  for (std::size_t i = 0; i < 3; ++i) {
    v.x[i] = hn::Sub(v.x[i], hn::Set(DI32(), origin.x));
    v.y[i] = hn::Sub(v.y[i], hn::Set(DI32(), origin.y));
  }
  return v;
}

/// Draws kLanes triangles; the one in lane i into the strips that begin i * `apart` words further on. If kInTile, the
/// strips are those of a tile with margins, which begins at `origin`, in subpixels.
template <bool kInTile = false>
HWY_INLINE void draw_group(const SnappedTriangle* triangles, int width, std::size_t apart, const Strips& strips,
                           Point origin = {0, 0}) {
  const auto d = DI32();
  const LaneSetup setup = make_lane_setup(kInTile ? load_vertices(triangles, origin) : load_vertices(triangles));
  const I32 zero = hn::Zero(d);
  const I32 columns = hn::Sub(setup.right, setup.left);
  const I32 rows = hn::Sub(setup.bottom, setup.top);
  // As with edge functions, a conjunction of conditions "not negative" is the sign of the or.
  const auto room_in = [&](I32 value, int most) { return hn::Sub(hn::Set(d, most), value); };
  const I32 inside = kInTile ? hn::Or(hn::Or(hn::Add(setup.left, hn::Set(d, kMarginStrips * kStripWidth)),
                                             hn::Add(setup.top, hn::Set(d, kMarginRows))),
                                      hn::Or(room_in(setup.left, width - 1), room_in(setup.top, strips.height - 1)))
                             : hn::Or(hn::Or(setup.left, setup.top),
                                      hn::Or(room_in(setup.right, width), room_in(setup.bottom, strips.height)));
  const I32 fits = hn::Or(room_in(columns, kSmallColumns), room_in(rows, kSmallRows));
  const I32 minus_one = hn::Set(d, -1);
  const M32 small = hn::Gt(hn::Or(inside, fits), minus_one);
  draw_small(setup, small, hn::Mul(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(apart))), strips);

  if (hn::AllTrue(d, small)) return;
  const I32 reaching_in = hn::Min(hn::Min(setup.right, setup.bottom),
                                  hn::Min(room_in(setup.left, width), room_in(setup.top, strips.height)));
  const M32 visible = hn::Gt(hn::Min(reaching_in, hn::Min(columns, rows)), zero);
  std::uint64_t others = bits_of(hn::AndNot(small, visible));
  if (others == 0) return;
  const std::uint64_t medium =
      bits_of(hn::Gt(hn::Or(room_in(columns, kMediumExtent), room_in(rows, kMediumExtent)), minus_one));
  StoredSetup stored;
  if ((others & medium) != 0) store(setup, stored);
  const I32 in_block =
      hn::Or(room_in(rows, kBlockRows), room_in(hn::Sub(setup.right, setup.strip_left), kBlockColumns));
  const std::uint64_t block = others & bits_of(hn::Gt(hn::Or(inside, in_block), minus_one));
  for (std::uint64_t lanes = block; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    Strips own = strips;
    own.words += lane * apart;
    draw_block(stored, lane, own);
  }
  for (std::uint64_t lanes = others & ~block; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    Strips own = strips;
    own.words += lane * apart;
    if (medium >> lane & 1) {
      draw_medium(stored, lane, own);
    } else {
      draw_large(triangles[lane], origin, width, own);
    }
  }
}

/// Draws any number of triangles.
template <bool kInTile = false>
inline void draw_list(std::span<const SnappedTriangle> triangles, int width, std::size_t apart, Strips strips,
                      Point origin = {0, 0}) {
  const std::size_t whole = triangles.size() / kLanes * kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) {
    draw_group<kInTile>(triangles.data() + i, width, apart, strips, origin);
    strips.words += kLanes * apart;
  }
  if (whole == triangles.size()) return;
  std::array<SnappedTriangle, kLanes> last{};  // the rest of them without area
  std::copy(triangles.begin() + static_cast<std::ptrdiff_t>(whole), triangles.end(), last.begin());
  draw_group<kInTile>(last.data(), width, apart, strips, origin);
}

inline void cover_union(std::span<const SnappedTriangle> triangles, int width, const Strips& strips) {
  draw_list(triangles, width, 0, strips);
}

inline void cover_tile(std::span<const SnappedTriangle> triangles, const Tile& tile, const Strips& strips) {
  constexpr int kPixel = 1 << Format16_8::kSubpixelBits;
  draw_list<true>(triangles, tile.width, 0, strips, {tile.left * kPixel, tile.top * kPixel});
}

/// A mask as strips, written out as rows. `last_word`: the pixels of a row's last word.
HWY_INLINE void strips_to_rows(const Strips& strips, std::uint64_t last_word, std::uint64_t* rows) {
  const std::uint32_t* left = strips.words;
  const int words = (strips.count + 1) / 2;
  for (int word = 0; word < words; ++word, left += 2 * strips.stride) {
    const bool single = 2 * word + 1 == strips.count;
    const std::uint64_t pixels = word + 1 == words ? last_word : ~std::uint64_t{0};
    for (int y = 0; y < strips.height; ++y) {
      const std::uint64_t right = single ? 0 : left[strips.stride + static_cast<std::size_t>(y)];
      rows[y * words + word] = (left[y] | right << 32) & pixels;
    }
  }
}

/// `scratch`: strips for `at_once` triangles, `apart` words apart.
inline void cover_each(std::span<const SnappedTriangle> triangles, int width, std::size_t at_once, std::size_t apart,
                       const Strips& scratch, std::uint64_t* masks) {
  const std::uint64_t last_word = ~std::uint64_t{0} >> (63 - (width - 1) % 64);
  const std::size_t mask_words =
      static_cast<std::size_t>(scratch.count + 1) / 2 * static_cast<std::size_t>(scratch.height);
  for (std::size_t first = 0; first < triangles.size(); first += at_once) {
    const auto group = triangles.subspan(first, std::min(at_once, triangles.size() - first));
    std::memset(scratch.words, 0, group.size() * apart * sizeof(std::uint32_t));
    draw_list(group, width, apart, scratch);
    Strips own = scratch;
    for (std::size_t i = 0; i < group.size(); ++i, own.words += apart) {
      strips_to_rows(own, last_word, masks + (first + i) * mask_words);
    }
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
