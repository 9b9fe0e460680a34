// Lists of triangles: each group of as many as a vector has lanes is set up at once and goes the way of its sizes.
#include "rasterizer/fast/blocks-inl.h"
#include "rasterizer/fast/large-inl.h"

#if defined(EDGECASE_FAST_UNION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_UNION_INL_H_
#undef EDGECASE_FAST_UNION_INL_H_
#else
#define EDGECASE_FAST_UNION_INL_H_
#endif

#include <algorithm>
#include <array>
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

/// One plane, for samples in the centre: what all of this is when nothing more is asked for.
struct CentrePlane {
  struct Shift {
    static HWY_INLINE I32 x(I32 v) { return v; }
    static HWY_INLINE I32 y(I32 v) { return v; }
  };
  static constexpr int count() { return 1; }
  static constexpr std::size_t words_before(int) { return 0; }
  static Shift shift(int) { return {}; }
  static FixedTriangle<ShiftedFormat> shifted(const SnappedTriangle& triangle, int) { return widened(triangle); }
};

/// A plane for each sample of a region, `apart` words apart.
struct RegionPlanes {
  struct Shift {
    I32 dx, dy;
    HWY_INLINE I32 x(I32 v) const { return hn::Add(v, dx); }
    HWY_INLINE I32 y(I32 v) const { return hn::Add(v, dy); }
  };
  const Region& region;
  std::size_t apart;

  int count() const { return region.samples; }
  std::size_t words_before(int plane) const { return static_cast<std::size_t>(plane) * apart; }
  HWY_INLINE Shift shift(int plane) const {
    const PlaneShift& by = region.shifts[static_cast<std::size_t>(plane)];
    return {hn::Set(DI32(), by.x.value()), hn::Set(DI32(), by.y.value())};
  }
  FixedTriangle<ShiftedFormat> shifted(const SnappedTriangle& triangle, int plane) const {
    return rasterizer::shifted(triangle, region.shifts[static_cast<std::size_t>(plane)]);
  }
};

/// Which of the lanes go which way.
struct Ways {
  M32 small;             ///< in lanes, or not at all
  std::uint64_t others;  ///< those that may cover something and are not small
  std::uint64_t medium;  ///< those whose setup holds, small ones among them
};

/// Whether no number is negative: as with edge functions, that is the sign of their or.
HWY_INLINE M32 not_negative(I32 either_negative) { return hn::Gt(either_negative, hn::Set(DI32(), -1)); }
HWY_INLINE I32 room_in(I32 value, int most) { return hn::Sub(hn::Set(DI32(), most), value); }

/// Not negative for triangles inside the target.
HWY_INLINE I32 inside(const LaneSetup& s, int width, int height) {
  return hn::Or(hn::Or(s.left, s.top), hn::Or(room_in(s.right, width), room_in(s.bottom, height)));
}

/// The same for who draws into planes of another kind, with an overload of its own.
template <class Planes>
HWY_INLINE I32 inside(const Planes&, const LaneSetup& s, int width, int height) {
  return inside(s, width, height);
}

/// `is_inside`: as from inside().
HWY_INLINE Ways ways_of(const LaneSetup& s, I32 is_inside, int width, int height) {
  const auto d = DI32();
  const I32 columns = hn::Sub(s.right, s.left);
  const I32 rows = hn::Sub(s.bottom, s.top);
  const I32 fits = hn::Or(room_in(columns, kSmallColumns), room_in(rows, kSmallRows));
  Ways ways{not_negative(hn::Or(is_inside, fits)), 0, 0};
  if (hn::AllTrue(d, ways.small)) return ways;
  const I32 reaching_in = hn::Min(hn::Min(s.right, s.bottom), hn::Min(room_in(s.left, width), room_in(s.top, height)));
  const M32 visible = hn::Gt(hn::Min(reaching_in, hn::Min(columns, rows)), hn::Zero(d));
  ways.others = bits_of(hn::AndNot(ways.small, visible));
  ways.medium = bits_of(not_negative(hn::Or(room_in(columns, kMediumExtent), room_in(rows, kMediumExtent))));
  return ways;
}

HWY_INLINE Ways ways_of(const LaneSetup& s, int width, int height) {
  return ways_of(s, inside(s, width, height), width, height);
}

// draw_small() reaches every lane's strips by an offset of 32 bits.
constexpr std::int64_t largest_offset() {
  const auto largest = static_cast<std::int64_t>(StripLayout(*Target::make(kMaxExtent, kMaxExtent)).words());
  return (kMaxLanes - 1) * kMaxSamples * largest + largest;
}
static_assert(largest_offset() < std::int64_t{1} << 31);

/// Lanes that draw_block() can draw, of those in `lanes`, if they have no more than `most` rows. Its last vector of
/// rows may reach beyond the triangle, but not beyond what belongs to a strip of `height` rows.
HWY_INLINE std::uint64_t block_lanes(const LaneSetup& s, I32 is_inside, std::uint64_t lanes, int most, int height) {
  const I32 in_block =
      hn::Or(room_in(hn::Sub(s.bottom, s.top), most), room_in(hn::Sub(s.right, s.strip_left), kBlockColumns));
  const I32 above_end = room_in(s.bottom, height + kRowsBelow - kMaxLanes);
  return lanes & bits_of(not_negative(hn::Or(hn::Or(is_inside, above_end), in_block)));
}

/// Small triangles cost their group as much as its highest one, in all lanes: fewer than that many are drawn as blocks.
inline constexpr int kWorthLanes = kLanes * 3 / 4;
static_assert(kSmallRows <= kBlockRows && kSmallColumns + kStripWidth - 1 <= kBlockColumns);

/// The vertices are loaded and sorted once more: kept from setup, they would take registers from smaller triangles.
template <class Planes>
HWY_INLINE LaneHalves halves_of(const SnappedTriangle* triangles, const Planes& planes, int plane, int width,
                                int height) {
  LaneVertices v = load_vertices(triangles);
  sort_by_y(v);
  const auto shift = planes.shift(plane);
  for (std::size_t i = 0; i < 3; ++i) v.x[i] = shift.x(v.x[i]), v.y[i] = shift.y(v.y[i]);
  return LaneHalves(v, width, height);
}

/// Draws the triangles in `lanes`, as draw_plane() does. Never inlined, so that smaller triangles have the registers.
template <class Planes>
HWY_NOINLINE void draw_large(const SnappedTriangle* triangles, std::uint64_t lanes, const Planes& planes, int plane,
                             int width, std::size_t apart, const Strips& strips) {
  const LaneHalves halves = halves_of(triangles, planes, plane, width, strips.height);
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    Strips own = strips;
    own.words += lane * apart;
    draw_halves(halves.of(lane), own);
  }
}

/// Draws kLanes triangles, set up for plane `plane`, into that plane; the one in lane i into the strips that begin i *
/// `apart` words further on.
template <class Planes>
HWY_INLINE void draw_plane(const SnappedTriangle* triangles, const LaneSetup& setup, const Planes& planes, int plane,
                           int width, std::size_t apart, const Strips& strips) {
  const auto d = DI32();
  const I32 is_inside = inside(planes, setup, width, strips.height);
  const Ways ways = ways_of(setup, is_inside, width, strips.height);
  std::uint64_t block = bits_of(hn::Gt(filled_rows(setup, ways.small), hn::Zero(d)));
  if (std::popcount(block) >= kWorthLanes) {
    draw_small(setup, ways.small, hn::Mul(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(apart))), strips);
    block = 0;
  }
  if ((block | ways.others) == 0) return;
  block |= block_lanes(setup, is_inside, ways.others, kBlockRows, strips.height);
  StoredBlocks blocks;
  if (block != 0) store(setup, blocks);
  for (std::uint64_t lanes = block; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    Strips own = strips;
    own.words += lane * apart;
    draw_block(blocks, lane, own);
  }
  const std::uint64_t others = ways.others & ~block;
  if (others == 0) return;
  StoredSetup stored;
  if ((others & ways.medium) != 0) store(setup, stored);
  for (std::uint64_t lanes = others & ways.medium; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    Strips own = strips;
    own.words += lane * apart;
    draw_medium(stored, lane, own);
  }
  if (const std::uint64_t large = others & ~ways.medium; large != 0) {
    draw_large(triangles, large, planes, plane, width, apart, strips);
  }
}

/// Draws `groups` times kLanes triangles into every plane. Never inlined, so that its code is the same whoever calls
/// it.
template <class Planes>
HWY_NOINLINE void draw_groups(const SnappedTriangle* triangles, std::size_t groups, const Planes& planes, int width,
                              std::size_t apart, Strips strips) {
  for (; groups != 0; --groups, triangles += kLanes, strips.words += kLanes * apart) {
    const LaneTriangle lanes = make_lane_triangle(load_vertices(triangles));
    for (int plane = 0; plane < planes.count(); ++plane) {
      Strips own = strips;
      own.words += planes.words_before(plane);
      draw_plane(triangles, make_lane_setup(lanes, planes.shift(plane)), planes, plane, width, apart, own);
    }
  }
}

/// Calls draw(triangles, first, groups) for all triangles in groups of kLanes, and in the end once for a group of which
/// those after the list's last one have no area. `first`: the index of the first.
template <class Draw>
HWY_INLINE void in_groups(std::span<const SnappedTriangle> triangles, const Draw& draw) {
  const std::size_t whole = triangles.size() / kLanes * kLanes;
  draw(triangles.data(), std::size_t{0}, whole / kLanes);
  if (whole == triangles.size()) return;
  std::array<SnappedTriangle, kLanes> last{};
  std::copy(triangles.begin() + static_cast<std::ptrdiff_t>(whole), triangles.end(), last.begin());
  draw(last.data(), whole, std::size_t{1});
}

/// Draws any number of triangles, each into the strips that begin `apart` words after those of the one before.
template <class Planes>
HWY_INLINE void draw_list(std::span<const SnappedTriangle> triangles, const Planes& planes, int width,
                          std::size_t apart, const Strips& strips) {
  in_groups(triangles, [&](const SnappedTriangle* group, std::size_t first, std::size_t groups) HWY_ATTR {
    Strips own = strips;
    own.words += first * apart;
    draw_groups(group, groups, planes, width, apart, own);
  });
}

inline void cover_union(std::span<const SnappedTriangle> triangles, int width, const Strips& strips) {
  draw_list(triangles, CentrePlane(), width, 0, strips);
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
