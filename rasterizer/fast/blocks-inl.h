// Triangles that fit into a block of 64 rows and two strips, inside the target: what nearly all of a few hundred pixels
// do. As those of medium-inl.h, rows in lanes, with less arithmetic.
#include "rasterizer/fast/medium-inl.h"

#if defined(EDGECASE_FAST_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_BLOCKS_INL_H_
#undef EDGECASE_FAST_BLOCKS_INL_H_
#else
#define EDGECASE_FAST_BLOCKS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// Columns and rows of a block. Its strips are drawn without a question, and with the widest vectors as many rows as
/// most need; where there is nothing, nothing is added.
inline constexpr int kBlockRows = 64;
inline constexpr int kBlockColumns = 2 * kStripWidth;
inline constexpr int kUnaskedRows = 2 * kMaxLanes;
static_assert(kUnaskedRows <= kRowsBelow);
static_assert(kBlockRows <= kMediumExtent && kBlockColumns <= kMediumExtent);

// Exactness. A row's count is t = k / (2 dy) rounded, see small-inl.h, of any t that is off by less than 1 / (2 dy).
// Here t is not made from each row's k, but by steps: t0 + row * slope, with t0 = k0 * scale and slope = 2 dx * scale,
// which rounds five times, u = 2^-24 of the number at hand each: scale, t0, slope, row * slope where there is no
// multiply-add, and the sum. The error of scale is the same share of both terms. In the rows in which the edge is
// crossed |t| <= V; in row 0, from which the lower edge is continued, |t0| <= V + R |slope| with R rows; so t is off by
//
//   u (|t0| + 2 R |slope| + 2 V) <= u (3 V + 3 R |slope|) = u (6 V dy + 6 R dx) / (2 dy)
//
// and less than a thousandth of that more for products of errors.
constexpr bool steps_decide(int columns, int rows) {
  const double dx = (columns + 1) * 256.0, dy = (rows + 1) * 256.0;
  const double largest_count = columns + 1 + 32;
  return 0x1p-24 * (6 * (largest_count + 1) * dy + 6 * rows * dx) * 1.001 < 1;
}
static_assert(steps_decide(kBlockColumns, kBlockRows));

/// A LaneSetup in memory, a lane of which is a triangle that fits into a block.
struct StoredBlocks {
  HWY_ALIGN std::int32_t strip_left[kMaxLanes], top[kMaxLanes];
  HWY_ALIGN std::int32_t middle[kMaxLanes], rows[kMaxLanes];  ///< from the top on
  struct Edge {
    HWY_ALIGN float t[kMaxLanes], slope[kMaxLanes];  ///< t of the top row
  };
  Edge longer, upper, lower;
};

HWY_INLINE void store(F32 k, const LaneEdge& edge, StoredBlocks::Edge& to) {
  const auto d = DF32();
  hn::Store(hn::Mul(k, edge.scale), d, to.t);
  hn::Store(hn::Mul(edge.step, edge.scale), d, to.slope);
}

HWY_INLINE void store(const LaneSetup& s, StoredBlocks& to) {
  const auto d = DI32();
  const I32 middle = hn::Sub(s.middle, s.top);
  hn::Store(s.strip_left, d, to.strip_left);
  hn::Store(s.top, d, to.top);
  hn::Store(middle, d, to.middle);
  hn::Store(hn::Sub(s.bottom, s.top), d, to.rows);
  store(s.longer.k, s.longer, to.longer);
  store(s.upper.k, s.upper, to.upper);
  store(k_of_top(s.lower, middle), s.lower, to.lower);
}

/// Draws lane `lane`.
HWY_INLINE void draw_block(const StoredBlocks& s, std::size_t lane, const Strips& strips) {
  const auto di = DI32();
  const auto df = DF32();
  const auto all = [&](const float* lanes) HWY_ATTR { return hn::Set(df, lanes[lane]); };
  const F32 longer = all(s.longer.t), longer_slope = all(s.longer.slope);
  const F32 upper = all(s.upper.t), upper_slope = all(s.upper.slope);
  const F32 lower = all(s.lower.t), lower_slope = all(s.lower.slope);
  const I32 middle = hn::Set(di, s.middle[lane]), end = hn::Set(di, s.rows[lane]);
  std::uint32_t* left =
      strips.words + s.top[lane] + (s.strip_left[lane] >> 5) * static_cast<std::ptrdiff_t>(strips.stride);
  std::uint32_t* right = left + strips.stride;
  I32 row = hn::Iota(di, 0);
  F32 number = hn::ConvertTo(df, row);
  for (int first = 0; first < kBlockRows; first += kLaneRows) {
    if ((kLaneRows < kMaxLanes || first >= kUnaskedRows) && first >= s.rows[lane]) break;
    const auto above = cast(hn::Lt(row, middle));
    // Rows behind the last have both counts the same, hence nothing between them.
    const M32 live = hn::Lt(row, end);
    const F32 shorter =
        hn::MulAdd(number, hn::IfThenElse(above, upper_slope, lower_slope), hn::IfThenElse(above, upper, lower));
    const NarrowCounts count0 = narrow(hn::IfThenElseZero(live, rounded(hn::MulAdd(number, longer_slope, longer))));
    const NarrowCounts count1 = narrow(hn::IfThenElseZero(live, rounded(shorter)));
    add(bits_between(count0, count1), left + first);
    add(bits_between(count0, count1, kStripWidth), right + first);
    row = hn::Add(row, hn::Set(di, kLaneRows));
    number = hn::Add(number, hn::Set(df, static_cast<float>(kLaneRows)));
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
