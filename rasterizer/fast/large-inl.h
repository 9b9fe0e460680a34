// Triangles of any size: the rows from the top to the middle vertex, then those to the bottom one, in bands of as many
// rows as a vector has lanes. A band has one left and one right edge; the strips between them are filled without being
// read.
//
// Counts (see small-inl.h) are the integer part of t(row) = (c - 1/2) / dy + 1, which is at least 1/(2 dy) away from
// every integer, in fixed point with 44 fraction bits. The fixed-point t and its slope are rounded from quotients of
// binary64: with |t| <= 2^16 + 1 px in the rows of the edge, R <= 2^14 rows and hence |slope| R <= 2^17 (a slope is
// used only if there are two rows), t is off by less than 2^17 2^-52 + 2^-44, the slope, R times, by less than 2^17
// 2^-52 + R 2^-44, together below 2^-29: less than 1/(2 dy) >= 2^-25.
//
// Within a band the rows are in lanes of 32 bits: 21 fraction bits, the integer part counted from the first row's.
// Dropping 23 fraction bits of t and of row * slope takes away less than 2^-20, so this needs 1/(2 dy) > 2^-20 + 2^-29;
// and |row * slope| below 2^10. Edges that are higher or flatter have their counts made row by row.
#include "rasterizer/fast/medium-inl.h"

#if defined(EDGECASE_FAST_LARGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_LARGE_INL_H_
#undef EDGECASE_FAST_LARGE_INL_H_
#else
#define EDGECASE_FAST_LARGE_INL_H_
#endif

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

inline constexpr int kFractionBits = 44;
inline constexpr int kLaneFractionBits = 21;
inline constexpr int kDroppedBits = kFractionBits - kLaneFractionBits;
/// Edges up to 2000 px high and 32 px a row flat are drawn with their rows in lanes.
inline constexpr std::int64_t kMostLaneHeight = 2000 * 256;
inline constexpr std::int64_t kMostLaneSlope = std::int64_t{32} << kFractionBits;
static_assert(1 / (2.0 * kMostLaneHeight) > 0x1p-20 + 0x1p-29);
static_assert((kMostLaneSlope >> kDroppedBits) * kMaxLanes <= (std::int64_t{1} << 30));

struct Point {
  std::int32_t x;
  std::int32_t y;
};

/// The crossings of an edge with the rows from `row` on.
class Crossings {
 public:
  /// `rows`: how many of them will be asked for, at least one.
  Crossings(const Point& a, const Point& b, int row, int rows) {
    const std::int64_t dx = b.x - a.x;
    const std::int64_t dy = b.y - a.y;
    const std::int64_t n = dy * (a.x - 128) + dx * (std::int64_t{row} * 256 + 128 - a.y);
    const std::int64_t c = (n + 255) >> 8;
    const auto height = static_cast<double>(dy);
    t_ = static_cast<std::int64_t>(static_cast<double>(2 * c - 1 + 2 * dy) / (2 * height) * 0x1p44);
    slope_ = rows > 1 ? static_cast<std::int64_t>(static_cast<double>(dx) / height * 0x1p44) : 0;
    lanes_ = dy <= kMostLaneHeight && slope_ < kMostLaneSlope && slope_ > -kMostLaneSlope;
    if (!lanes_) return;
    const auto d = DI32();
    const I32 row_number = hn::Iota(d, 0);
    const auto whole = static_cast<std::int32_t>(slope_ >> kDroppedBits);
    const auto rest = static_cast<std::int32_t>(slope_ & ((std::int64_t{1} << kDroppedBits) - 1));
    const I32 rests = hn::ShiftRight<kDroppedBits>(hn::Mul(row_number, hn::Set(d, rest)));
    hn::Store(hn::Add(hn::Mul(row_number, hn::Set(d, whole)), rests), d, steps_);
  }

  /// The least and the greatest count of the next `rows` rows.
  void range(int rows, int& low, int& high) const {
    const int first = static_cast<int>(t_ >> kFractionBits);
    const int last = static_cast<int>((t_ + (rows - 1) * slope_) >> kFractionBits);
    low = std::min(first, last);
    high = std::max(first, last);
  }

  /// The counts of the next kLanes rows; beyond the edge's end they are anything.
  HWY_INLINE I32 counts() const {
    const auto d = DI32();
    if (HWY_LIKELY(lanes_)) {
      constexpr std::int64_t kFraction = (std::int64_t{1} << kFractionBits) - 1;
      const auto fraction = static_cast<std::int32_t>((t_ & kFraction) >> kDroppedBits);
      const I32 first = hn::Set(d, static_cast<std::int32_t>(t_ >> kFractionBits));
      return hn::Add(first, hn::ShiftRight<kLaneFractionBits>(hn::Add(hn::Load(d, steps_), hn::Set(d, fraction))));
    }
    HWY_ALIGN std::int32_t row_counts[kMaxLanes];
    auto t = static_cast<std::uint64_t>(t_);
    for (std::size_t i = 0; i < kLanes; ++i) {
      row_counts[i] = static_cast<std::int32_t>(static_cast<std::int64_t>(t) >> kFractionBits);
      t += static_cast<std::uint64_t>(slope_);
    }
    return hn::Load(d, row_counts);
  }

  /// In unsigned arithmetic, as what lies beyond the edge's end may wrap.
  void skip(int rows) {
    t_ = static_cast<std::int64_t>(static_cast<std::uint64_t>(t_) +
                                   static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(slope_));
  }

 private:
  std::int64_t t_;
  std::int64_t slope_;
  bool lanes_;
  HWY_ALIGN std::int32_t steps_[kMaxLanes];
};

/// The counts of a band from the strip's left side on.
HWY_INLINE U32 bits_from(I32 counts, int strip) {
  const auto d = DI32();
  return bits_from(hn::Max(hn::Sub(counts, hn::Set(d, strip * kStripWidth)), hn::Zero(d)));
}

/// Rows begin <= row < end, crossed by both edges.
HWY_INLINE void draw_rows(Crossings& one, Crossings& other, int begin, int end, const Strips& strips) {
  const auto du = DU32();
  const U32 ones = hn::Set(du, ~std::uint32_t{0});
  constexpr int kBand = static_cast<int>(kLanes);
  for (int row = begin; row < end; row += kBand) {
    const int rows = std::min(end - row, kBand);
    int low0, high0, low1, high1;
    one.range(rows, low0, high0);
    other.range(rows, low1, high1);
    const I32 counts0 = one.counts();
    const I32 counts1 = other.counts();
    const bool in_order = low0 + high0 <= low1 + high1;
    const I32 left = in_order ? counts0 : counts1;
    const I32 right = in_order ? counts1 : counts0;
    const int left_low = in_order ? low0 : low1, left_high = in_order ? high0 : high1;
    const int right_low = in_order ? low1 : low0, right_high = in_order ? high1 : high0;

    // Strips from `touched` to `gone` hold samples; left of `full` the left edge, from `ending` on the right edge
    // shows.
    const auto clipped = [&](int strip) { return std::clamp(strip, 0, strips.count); };
    const int touched = clipped(left_low >> 5);
    const int full = clipped((left_high + kStripWidth - 1) >> 5);
    const int ending = clipped(right_low >> 5);
    const int gone = clipped((right_high + kStripWidth - 1) >> 5);
    std::uint32_t* to = strips.words + row + static_cast<std::size_t>(touched) * strips.stride;
    const M32 live = hn::Lt(hn::Iota(DI32(), 0), hn::Set(DI32(), rows));
    int strip = touched;
    if (full <= ending) {
      for (; strip < full; ++strip, to += strips.stride) add(keep(live, bits_from(left, strip)), to);
      if (rows == kBand) {
        for (; strip < ending; ++strip, to += strips.stride) hn::StoreU(ones, du, to);
      } else {
        for (; strip < ending; ++strip, to += strips.stride) add(keep(live, ones), to);
      }
      for (; strip < gone; ++strip, to += strips.stride) add(keep(live, hn::Not(bits_from(right, strip))), to);
    } else {
      for (; strip < gone; ++strip, to += strips.stride) {
        add(keep(live, hn::Xor(bits_from(left, strip), bits_from(right, strip))), to);
      }
    }
    one.skip(kBand);
    other.skip(kBand);
  }
}

inline void draw_large(const FixedTriangle<Format16_8>& triangle, const Strips& strips) {
  Point v[3];
  for (std::size_t i = 0; i < 3; ++i) v[i] = {triangle[i].x.value(), triangle[i].y.value()};
  if (v[1].y < v[0].y) std::swap(v[0], v[1]);
  if (v[2].y < v[1].y) std::swap(v[1], v[2]);
  if (v[1].y < v[0].y) std::swap(v[0], v[1]);
  const auto first_row = [&](const Point& p) { return std::clamp((p.y + 127) >> 8, 0, strips.height); };
  const int top = first_row(v[0]), middle = first_row(v[1]), bottom = first_row(v[2]);
  if (top >= bottom) return;
  Crossings longer(v[0], v[2], top, bottom - top);
  if (top < middle) {
    Crossings upper(v[0], v[1], top, middle - top);
    Crossings same = longer;
    draw_rows(same, upper, top, middle, strips);
  }
  if (middle < bottom) {
    longer.skip(middle - top);
    Crossings lower(v[1], v[2], middle, bottom - middle);
    draw_rows(longer, lower, middle, bottom, strips);
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
