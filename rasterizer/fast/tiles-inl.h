// Tiles: a part of a target drawn by itself, and which tiles each triangle of a list reaches.
#include "rasterizer/fast/tile_mask.h"
#include "rasterizer/fast/union-inl.h"

#if defined(EDGECASE_FAST_TILES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_TILES_INL_H_
#undef EDGECASE_FAST_TILES_INL_H_
#else
#define EDGECASE_FAST_TILES_INL_H_
#endif

#include <utility>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// One plane, for samples in the centre, that begins where the tile does.
struct TilePlane {
  using Shift = RegionPlanes::Shift;
  const Tile& tile;

  static constexpr int count() { return 1; }
  static constexpr std::size_t words_before(int) { return 0; }
  HWY_INLINE Shift shift(int) const { return {hn::Set(DI32(), -tile.left * 256), hn::Set(DI32(), -tile.top * 256)}; }
};

/// What is small may lie on the margins; it begins before the tile ends.
HWY_INLINE I32 inside(const TilePlane&, const LaneSetup& s, int width, int height) {
  const auto d = DI32();
  return hn::Or(
      hn::Or(hn::Add(s.left, hn::Set(d, kMarginStrips * kStripWidth)), hn::Add(s.top, hn::Set(d, kMarginRows))),
      hn::Or(room_in(s.left, width - 1), room_in(s.top, height - 1)));
}
static_assert(kUnaskedRows <= kMarginRows && kSmallRows <= kMarginRows);
static_assert(kBlockColumns <= (1 + kMarginStrips) * kStripWidth && kSmallColumns <= kMarginStrips * kStripWidth);

inline void cover_tile(std::span<const SnappedTriangle> triangles, const Tile& tile, const Strips& strips) {
  draw_list(triangles, TilePlane{tile}, tile.width, 0, strips);
}

inline void add_words(const std::uint32_t* from, std::uint32_t* to, std::size_t words) {
  const auto d = DU32();
  std::size_t i = 0;
  for (; i + kLanes <= words; i += kLanes) hn::StoreU(hn::Or(hn::LoadU(d, to + i), hn::LoadU(d, from + i)), d, to + i);
  for (; i < words; ++i) to[i] |= from[i];
}

// Reach.
//
// A triangle reaches the columns and rows of tiles that hold a sample of its bounding box. The box's ends, as first
// samples (small-inl.h), are compared with where columns and rows begin and end: nothing is divided, so nothing is
// truncated towards zero left of the target, and both ends are exclusive, so a triangle that ends where a tile does is
// not in the next one.

/// Adds bit `first_bit` + lane to the word of each column and row that the lane reaches.
HWY_INLINE void add_reach(const LaneVertices& v, const TileGrid& grid, std::size_t first_bit, std::uint64_t* words) {
  const auto add = [&](const I32* c, std::span<const std::int32_t> at) {
    // Samples lie in [begin, end), if in any.
    const I32 begin = first_sample(hn::Min(hn::Min(c[0], c[1]), c[2]));
    const I32 end = first_sample(hn::Max(hn::Max(c[0], c[1]), c[2]));
    const M32 some = hn::Lt(begin, end);
    M32 ends_beyond = hn::Gt(end, hn::Set(DI32(), at[0]));
    for (std::size_t i = 1; i < at.size(); ++i) {
      const I32 bound = hn::Set(DI32(), at[i]);
      const M32 reaches = hn::And(hn::And(some, ends_beyond), hn::Lt(begin, bound));
      ends_beyond = hn::Gt(end, bound);
      *words++ |= bits_of(reaches) << first_bit;
    }
  };
  add(v.x, grid.columns_at());
  add(v.y, grid.rows_at());
}

inline void find_reach(std::span<const SnappedTriangle> triangles, const TileGrid& grid, std::uint64_t* words) {
  const auto block_words = static_cast<std::size_t>(grid.columns() + grid.rows());
  for (std::size_t first = 0; first < triangles.size(); first += kReachBlock, words += block_words) {
    const auto block = triangles.subspan(first, std::min(kReachBlock, triangles.size() - first));
    std::fill_n(words, block_words, std::uint64_t{0});
    const std::size_t whole = block.size() / kLanes * kLanes;
    for (std::size_t i = 0; i < whole; i += kLanes) add_reach(load_vertices(block.data() + i), grid, i, words);
    if (whole == block.size()) continue;
    std::array<SnappedTriangle, kLanes> last{};  // the rest of them without area
    std::copy(block.begin() + static_cast<std::ptrdiff_t>(whole), block.end(), last.begin());
    add_reach(load_vertices(last.data()), grid, whole, words);
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
