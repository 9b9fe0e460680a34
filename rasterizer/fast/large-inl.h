// Triangles of any size: the rows from the top to the middle vertex, then those to the
// bottom one, in bands of rows. A band has one left and one right edge; the strips between them are filled without
// being read.
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

/// The least and the greatest count of a band's rows.
struct Range {
  int low, high;
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
    falling_ = slope_ >> 63;
    lanes_ = dy <= kMostLaneHeight && slope_ < kMostLaneSlope && slope_ > -kMostLaneSlope;
    if (!lanes_) return;
    const auto d = DI32();
    const I32 row_number = hn::Iota(d, 0);
    const auto whole = static_cast<std::int32_t>(slope_ >> kDroppedBits);
    const auto rest = static_cast<std::int32_t>(slope_ & ((std::int64_t{1} << kDroppedBits) - 1));
    const I32 rests = hn::ShiftRight<kDroppedBits>(hn::Mul(row_number, hn::Set(d, rest)));
    steps_ = hn::Add(hn::Mul(row_number, hn::Set(d, whole)), rests);
  }

  /// The least and the greatest count of the next `rows` rows. Which end has which is known before.
  Range range(int rows) const {
    const std::int64_t change = (rows - 1) * slope_;
    return {static_cast<int>((t_ + (change & falling_)) >> kFractionBits),
            static_cast<int>((t_ + (change & ~falling_)) >> kFractionBits)};
  }

  /// Twice the place in the middle of the next `rows` rows: what tells a left from a right edge.
  std::int64_t middle(int rows) const { return 2 * t_ + (rows - 1) * slope_; }

  /// The counts of the next kLanes rows; beyond the edge's end they are anything.
  HWY_INLINE I32 counts() const {
    const auto d = DI32();
    if (HWY_LIKELY(lanes_)) {
      constexpr std::int64_t kFraction = (std::int64_t{1} << kFractionBits) - 1;
      const auto fraction = static_cast<std::int32_t>((t_ & kFraction) >> kDroppedBits);
      const I32 first = hn::Set(d, static_cast<std::int32_t>(t_ >> kFractionBits));
      return hn::Add(first, hn::ShiftRight<kLaneFractionBits>(hn::Add(steps_, hn::Set(d, fraction))));
    }
    HWY_ALIGN std::int32_t row_counts[kMaxLanes];
    auto t = static_cast<std::uint64_t>(t_);
    for (std::size_t i = 0; i < kLanes; ++i) {
      row_counts[i] = static_cast<std::int32_t>(static_cast<std::int64_t>(t) >> kFractionBits);
      t += static_cast<std::uint64_t>(slope_);
    }
    return hn::Load(d, row_counts);
  }

  /// A whole number of pixels, at least 1, that a row moves the crossing by at most.
  int reach() const { return static_cast<int>((slope_ < 0 ? -slope_ : slope_) >> kFractionBits) + 1; }

  /// In unsigned arithmetic, as what lies beyond the edge's end may wrap.
  void skip(int rows) {
    t_ = static_cast<std::int64_t>(static_cast<std::uint64_t>(t_) +
                                   static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(slope_));
  }

 private:
  std::int64_t t_;
  std::int64_t slope_;
  std::int64_t falling_;  ///< all bits set if the crossings move to the left
  bool lanes_;
  I32 steps_ = hn::Zero(DI32());
};

/// The bits of a strip from the counts on.
HWY_INLINE U32 bits_from(I32 counts, int strip) {
  const auto d = DI32();
  return bits_from(hn::Max(hn::Sub(counts, hn::Set(d, strip * kStripWidth)), hn::Zero(d)));
}

/// Draws rows from `row` to before `end` in bands of Rows rows, of which neither edge moves further than a strip is
/// wide, inside the target. An edge then shows in at most two strips of a band, and these are drawn without asking: in
/// a strip without the edge the same expression gives all bits or none.
template <int Rows>
HWY_INLINE void draw_bands(Crossings& left, Crossings& right, int row, int end, const Strips& strips) {
  constexpr int kLaneRows = static_cast<int>(kLanes);
  constexpr int kVectors = Rows / kLaneRows;
  static_assert(kVectors * kLaneRows == Rows && Rows <= kRowsBelow);
  const auto d = DI32();
  const auto du = DU32();
  const U32 ones = hn::Set(du, ~std::uint32_t{0});
  for (; row < end; row += Rows) {
    const int rows = end - row < Rows ? end - row : Rows;
    const int first = left.range(rows).low >> 5;
    const int last = (right.range(rows).high - 1) >> 5;
    I32 left_counts[kVectors], right_counts[kVectors];
    for (int i = 0; i < kVectors; ++i) {
      left_counts[i] = left.counts();
      right_counts[i] = right.counts();
      left.skip(kLaneRows);
      right.skip(kLaneRows);
    }
    if (last < first) continue;
    std::uint32_t* const words = strips.words + row;
    const auto word = [&](int strip) { return words + static_cast<std::size_t>(strip) * strips.stride; };
    const bool whole = rows == Rows;
    if (last - first >= 3 && whole) {
      std::uint32_t* to = word(first);
      std::uint32_t* const stop = word(last - 1);
      for (int i = 0; i < kVectors; ++i) {
        add(bits_from(left_counts[i], first), to + i * kLaneRows);
        add(bits_from(left_counts[i], first + 1), to + strips.stride + i * kLaneRows);
        add(hn::Not(bits_from(right_counts[i], last - 1)), stop + i * kLaneRows);
        add(hn::Not(bits_from(right_counts[i], last)), stop + strips.stride + i * kLaneRows);
      }
      for (to += 2 * strips.stride; to != stop; to += strips.stride) {
        for (int i = 0; i < kVectors; ++i) hn::StoreU(ones, du, to + i * kLaneRows);
      }
      continue;
    }
    if (!whole) {
      // Rows behind the last get both counts the same, hence nothing between them.
      for (int i = 0; i < kVectors; ++i) {
        const M32 live = hn::Lt(hn::Iota(d, i * kLaneRows), hn::Set(d, rows));
        left_counts[i] = hn::IfThenElseZero(live, left_counts[i]);
        right_counts[i] = hn::IfThenElseZero(live, right_counts[i]);
      }
    }
    int strip = first;
    const auto draw_strip = [&] {
      for (int i = 0; i < kVectors; ++i) {
        add(hn::Xor(bits_from(left_counts[i], strip), bits_from(right_counts[i], strip)), word(strip) + i * kLaneRows);
      }
      ++strip;
    };
    draw_strip();
    do draw_strip();
    while (strip <= last);
  }
}

/// Draws rows from `row` to before `end`, kLanes at a time, anywhere.
HWY_INLINE void draw_flat_rows(Crossings& left, Crossings& right, int row, int end, const Strips& strips) {
  const auto d = DI32();
  const auto du = DU32();
  constexpr int kBand = static_cast<int>(kLanes);
  const auto clipped = [&](int strip) {
    const int positive = strip < 0 ? 0 : strip;
    return positive > strips.count ? strips.count : positive;
  };
  for (; row < end; row += kBand) {
    const int rows = end - row < kBand ? end - row : kBand;
    const Range left_range = left.range(rows), right_range = right.range(rows);
    // Rows behind the last have both counts the same, hence nothing between them.
    const M32 live = hn::Lt(hn::Iota(d, 0), hn::Set(d, rows));
    const I32 left_counts = hn::IfThenElseZero(live, left.counts());
    const I32 right_counts = hn::IfThenElseZero(live, right.counts());
    // Strips from `first` to `stop` hold samples, those from `full` to `ending` no edge.
    const int first = clipped(left_range.low >> 5);
    const int full = clipped((left_range.high + kStripWidth - 1) >> 5);
    const int ending = clipped(right_range.low >> 5);
    const int stop = clipped((right_range.high + kStripWidth - 1) >> 5);
    std::uint32_t* to = strips.words + row + static_cast<std::size_t>(first) * strips.stride;
    const auto draw_edges = [&](int strip) {
      add(hn::Xor(bits_from(left_counts, strip), bits_from(right_counts, strip)), to);
    };
    int strip = first;
    if (ending - full > 1 && rows == kBand) {
      for (; strip < full; ++strip, to += strips.stride) draw_edges(strip);
      for (; strip < ending; ++strip, to += strips.stride) hn::StoreU(hn::Set(du, ~std::uint32_t{0}), du, to);
    }
    for (; strip < stop; ++strip, to += strips.stride) draw_edges(strip);
    left.skip(kBand);
    right.skip(kBand);
  }
}

/// Rows begin <= row < end, crossed by both edges. `inside`: no sample lies left or right of the target.
HWY_INLINE void draw_rows(Crossings& one, Crossings& other, int begin, int end, bool inside, const Strips& strips) {
  // Where the two are equal but for rounding, so are their counts.
  const bool in_order = one.middle(end - begin) <= other.middle(end - begin);
  Crossings& left = in_order ? one : other;
  Crossings& right = in_order ? other : one;
  const int reach = inside ? std::max(left.reach(), right.reach()) : kStripWidth;
  if (reach <= 1) {
    draw_bands<kStripWidth>(left, right, begin, end, strips);
  } else if (reach <= 2) {
    draw_bands<kStripWidth / 2>(left, right, begin, end, strips);
  } else {
    draw_flat_rows(left, right, begin, end, strips);
  }
}

HWY_INLINE void sort_by_y(Point& a, Point& b) {
  const bool swap = b.y < a.y;
  const Point upper{swap ? b.x : a.x, swap ? b.y : a.y};
  b = {swap ? a.x : b.x, swap ? a.y : b.y};
  a = upper;
}

/// `origin`, in subpixels, is where the strips begin.
inline void draw_large(const FixedTriangle<Format16_8>& triangle, Point origin, int width, const Strips& strips) {
  Point v[3];
  for (std::size_t i = 0; i < 3; ++i) v[i] = {triangle[i].x.value() - origin.x, triangle[i].y.value() - origin.y};
  sort_by_y(v[0], v[1]);
  sort_by_y(v[1], v[2]);
  sort_by_y(v[0], v[1]);
  const auto first_row = [&](const Point& p) { return std::clamp((p.y + 127) >> 8, 0, strips.height); };
  const int top = first_row(v[0]), middle = first_row(v[1]), bottom = first_row(v[2]);
  if (top >= bottom) return;
  const auto [leftmost, rightmost] = std::minmax({v[0].x, v[1].x, v[2].x});
  const bool inside = leftmost >= 0 && rightmost <= width * 256;
  Crossings longer(v[0], v[2], top, bottom - top);
  if (top < middle) {
    Crossings down = longer;
    Crossings upper(v[0], v[1], top, middle - top);
    draw_rows(down, upper, top, middle, inside, strips);
  }
  if (middle < bottom) {
    longer.skip(middle - top);
    Crossings lower(v[1], v[2], middle, bottom - middle);
    draw_rows(longer, lower, middle, bottom, inside, strips);
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
