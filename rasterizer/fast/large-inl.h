// Triangles of any size: the rows from the top to the middle vertex, then those to the bottom one; in bands of rows
// where all of it is on the target and not too large.
#include "rasterizer/fast/bands-inl.h"

#if defined(EDGECASE_FAST_LARGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_LARGE_INL_H_
#undef EDGECASE_FAST_LARGE_INL_H_
#else
#define EDGECASE_FAST_LARGE_INL_H_
#endif

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// The counts of the next kLanes rows; beyond the edge's end they are anything.
HWY_INLINE I32 row_counts(const Crossings& c) {
  HWY_ALIGN std::int32_t counts[kMaxLanes];
  auto t = static_cast<std::uint64_t>(c.t);
  for (std::size_t i = 0; i < kLanes; ++i) {
    counts[i] = static_cast<std::int32_t>(static_cast<std::int64_t>(t) >> kFractionBits);
    t += static_cast<std::uint64_t>(c.slope);
  }
  return hn::Load(DI32(), counts);
}

/// Draws rows from `row` to before `end`, kLanes at a time, anywhere.
inline void draw_anywhere(Crossings left, Crossings right, int row, int end, const Strips& strips) {
  const auto d = DI32();
  const auto du = DU32();
  constexpr int kBand = static_cast<int>(kLanes);
  const std::size_t stride = strips.stride;
  const auto clipped = [&](std::int64_t t) {
    return static_cast<int>(std::clamp<std::int64_t>(t >> (kFractionBits + kStripBits), 0, strips.count));
  };
  constexpr std::int64_t kAllButOne = ((std::int64_t{1} << kStripBits) - 1) << kFractionBits;
  for (; row < end; row += kBand) {
    const int rows = end - row < kBand ? end - row : kBand;
    const Drift left_drift(left.slope, rows), right_drift(right.slope, rows);
    // Rows behind the last have both counts the same, hence nothing between them.
    const M32 live = hn::Lt(hn::Iota(d, 0), hn::Set(d, rows));
    const I32 left_counts = hn::IfThenElseZero(live, row_counts(left));
    const I32 right_counts = hn::IfThenElseZero(live, row_counts(right));
    // Strips from `first` to `stop` hold samples, those from `full` to `ending` no edge.
    const int first = clipped(left.t + left_drift.left);
    const int full = clipped(left.t + left_drift.right + kAllButOne);
    const int ending = clipped(right.t + right_drift.left);
    const int stop = clipped(right.t + right_drift.right + kAllButOne);
    std::uint32_t* to = strips.words + row + static_cast<std::size_t>(first) * stride;
    const auto draw_edges = [&](int strip) HWY_ATTR {
      const I32 begin = hn::Set(d, strip * kStripWidth);
      const auto bits = [&](I32 counts) HWY_ATTR {
        return bits_from_wide(hn::BitCast(du, hn::Max(hn::Sub(counts, begin), hn::Zero(d))));
      };
      add(hn::Xor(bits(left_counts), bits(right_counts)), to);
    };
    int strip = first;
    if (ending - full > 1 && rows == kBand) {
      for (; strip < full; ++strip, to += stride) draw_edges(strip);
      for (; strip < ending; ++strip, to += stride) hn::StoreU(hn::Set(du, ~std::uint32_t{0}), du, to);
    }
    for (; strip < stop; ++strip, to += stride) draw_edges(strip);
    left.skip(kBand);
    right.skip(kBand);
  }
}

/// Without a branch: which of two vertices is above the other cannot be predicted.
HWY_INLINE void sort_by_y(Point& a, Point& b) {
  const std::int32_t exchange = b.y < a.y ? -1 : 0;
  const std::int32_t x = (a.x ^ b.x) & exchange, y = (a.y ^ b.y) & exchange;
  a = {a.x ^ x, a.y ^ y};
  b = {b.x ^ x, b.y ^ y};
}

/// A triangle above and below its middle vertex: rows that one left and one right edge cross, none or more of each.
struct Halves {
  struct Half {
    Crossings left, right;  ///< from row `begin` on, if that is before `end`
    int begin, end;
  };
  Half upper, lower;
  bool in_bands;  ///< how they are to be drawn
};

/// Of a triangle on a target of `width` by `height` pixels.
HWY_INLINE Halves halves_of(const FixedTriangle<ShiftedFormat>& triangle, int width, int height) {
  Point v[3];
  for (std::size_t i = 0; i < 3; ++i) v[i] = {triangle[i].x.value(), triangle[i].y.value()};
  sort_by_y(v[0], v[1]);
  sort_by_y(v[1], v[2]);
  sort_by_y(v[0], v[1]);
  const auto first_row = [&](const Point& p) { return std::clamp((p.y + 127) >> 8, 0, height); };
  Halves halves;
  const int top = halves.upper.begin = first_row(v[0]);
  const int middle = halves.upper.end = halves.lower.begin = first_row(v[1]);
  const int bottom = halves.lower.end = first_row(v[2]);
  const std::int32_t leftmost = std::min(std::min(v[0].x, v[1].x), v[2].x);
  const std::int32_t rightmost = std::max(std::max(v[0].x, v[1].x), v[2].x);
  halves.in_bands = leftmost >= 0 && rightmost <= width * 256 && rightmost - leftmost <= kMostBandExtent * 256 &&
                    v[2].y - v[0].y <= kMostBandHeight;
  if (top >= bottom) return halves;
  // Which of the edges is left; where they lie in one line it does not matter.
  const bool longer_is_left =
      std::int64_t{v[2].x - v[0].x} * (v[1].y - v[0].y) < std::int64_t{v[1].x - v[0].x} * (v[2].y - v[0].y);
  const auto set = [&](Halves::Half& half, const Crossings& longer, const Crossings& shorter) {
    half.left = longer_is_left ? longer : shorter;
    half.right = longer_is_left ? shorter : longer;
  };
  Crossings longer(v[0], v[2], top, bottom - top);
  if (top < middle) set(halves.upper, longer, Crossings(v[0], v[1], top, middle - top));
  longer.skip(middle - top);
  if (middle < bottom) set(halves.lower, longer, Crossings(v[1], v[2], middle, bottom - middle));
  return halves;
}

/// Never inlined, so that its code is the same whoever calls it.
HWY_NOINLINE void draw_halves(const Halves& halves, const Strips& strips) {
  for (const Halves::Half* half : {&halves.upper, &halves.lower}) {
    if (half->begin >= half->end) continue;
    if (halves.in_bands) {
      draw_bands(half->left, half->right, half->begin, half->end, strips);
    } else {
      draw_anywhere(half->left, half->right, half->begin, half->end, strips);
    }
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
