// Triangles of any size: the rows from the top to the middle vertex, then those to the bottom one; in bands of rows
// where all of it is on the target and not too large.
#include "rasterizer/fast/bands-inl.h"
#include "rasterizer/fast/halves-inl.h"

#if defined(EDGECASE_FAST_LARGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_LARGE_INL_H_
#undef EDGECASE_FAST_LARGE_INL_H_
#else
#define EDGECASE_FAST_LARGE_INL_H_
#endif

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// An edge's crossings with kLanes rows at once. Counts beyond the edge's end are anything.
#if HWY_TARGET == HWY_SCALAR
class CrossedRows {
 public:
  explicit CrossedRows(const Crossings& c) : row_(c) {}
  I32 counts() const { return hn::Set(DI32(), static_cast<std::int32_t>(row_.t >> kFractionBits)); }
  void skip() { row_.skip(1); }

 private:
  Crossings row_;
};
#else
class CrossedRows {
 public:
  explicit CrossedRows(const Crossings& c) : step_(hn::Set(d, times<kLanes>(c.slope))) {
    // Row i is the sum of those of 1, 2 and 4 rows that are in i.
    alignas(64) static constexpr std::int64_t kOdd[] = {0, -1, 0, -1, 0, -1, 0, -1};
    alignas(64) static constexpr std::int64_t kTwo[] = {0, 0, -1, -1, 0, 0, -1, -1};
    alignas(64) static constexpr std::int64_t kFour[] = {0, 0, 0, 0, -1, -1, -1, -1};
    static_assert(kHalf <= 8);
    const auto rows = [](const std::int64_t* mask, std::int64_t slopes)
                          HWY_ATTR { return hn::And(hn::Load(d, mask), hn::Set(d, slopes)); };
    low_ = hn::Add(hn::Add(hn::Set(d, c.t), rows(kOdd, c.slope)),
                   hn::Add(rows(kTwo, times<2>(c.slope)), rows(kFour, times<4>(c.slope))));
    high_ = hn::Add(low_, hn::Set(d, times<kHalf>(c.slope)));
  }

  /// Shifted in two steps, the first of which is that only upper halves are taken.
  HWY_INLINE I32 counts() const {
    const auto halves = [](I64 v) HWY_ATTR { return hn::BitCast(DI32(), v); };
    return hn::ShiftRight<kFractionBits - 32>(hn::ConcatOdd(DI32(), halves(high_), halves(low_)));
  }
  HWY_INLINE void skip() {
    low_ = hn::Add(low_, step_);
    high_ = hn::Add(high_, step_);
  }

 private:
  static constexpr hn::Repartition<std::int64_t, DI32> d{};
  using I64 = hn::Vec<decltype(d)>;
  static constexpr std::size_t kHalf = kLanes / 2;

  /// In unsigned arithmetic, as what lies beyond the edge's end may wrap.
  template <std::uint64_t kRows>
  static std::int64_t times(std::int64_t slope) {
    return static_cast<std::int64_t>(kRows * static_cast<std::uint64_t>(slope));
  }

  I64 low_, high_, step_;
};
#endif

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
  CrossedRows left_rows(left), right_rows(right);
  for (; row < end; row += kBand) {
    const int rows = end - row < kBand ? end - row : kBand;
    const Drift left_drift(left.slope, rows), right_drift(right.slope, rows);
    // Rows behind the last have both counts the same, hence nothing between them.
    const M32 live = hn::Lt(hn::Iota(d, 0), hn::Set(d, rows));
    const I32 left_counts = hn::IfThenElseZero(live, left_rows.counts());
    const I32 right_counts = hn::IfThenElseZero(live, right_rows.counts());
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
    left_rows.skip();
    right_rows.skip();
  }
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
