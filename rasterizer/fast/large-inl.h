// Triangles of any size: the rows from the top to the middle vertex, then those to the bottom one, in bands of rows. A
// band has one left and one right edge; the strips between them are filled without being read.
//
// Counts (see small-inl.h) are the integer part of t(row) = (c - 1/2) / dy + 1, which is at least 1/(2 dy) away from
// every integer, in fixed point with 44 fraction bits. The fixed-point t and its slope are products of binary64 numbers
// with a rounded reciprocal: with |t| <= 2^16 + 1 px in the rows of the edge, R <= 2^14 rows and hence |slope| R <=
// 2^17 (a slope is used only if there are two rows), t is off by less than 2^17 2^-52 + 2^-44, the slope, R times, by
// less than 2^17 2^-52 + R 2^-44, together below 2^-29: less than 1/(2 dy) >= 2^-25.
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
inline constexpr int kStripBits = 5;
static_assert(1 << kStripBits == kStripWidth);

struct Point {
  std::int32_t x;
  std::int32_t y;
};

/// The crossings of an edge with rows, from some row on.
struct Crossings {
  std::int64_t t;      ///< in that row
  std::int64_t slope;  ///< from row to row

  /// `rows`: how many of them will be asked for, at least one.
  Crossings(const Point& a, const Point& b, int row, int rows) {
    const std::int64_t dx = b.x - a.x;
    const std::int64_t dy = b.y - a.y;
    const std::int64_t n = dy * (a.x - 128) + dx * (std::int64_t{row} * 256 + 128 - a.y);
    const std::int64_t c = (n + 255) >> 8;
    const double scale = 0x1p44 / static_cast<double>(2 * dy);
    t = static_cast<std::int64_t>(static_cast<double>(2 * c - 1 + 2 * dy) * scale);
    slope = rows > 1 ? static_cast<std::int64_t>(static_cast<double>(2 * dx) * scale) : 0;
  }

  /// In unsigned arithmetic, as what lies beyond the edge's end may wrap.
  void skip(int rows) {
    t = static_cast<std::int64_t>(static_cast<std::uint64_t>(t) +
                                  static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(slope));
  }
};

/// Whether the crossings of both move by less than a pixel from row to row.
inline bool are_steep(const Crossings& a, const Crossings& b) {
  constexpr std::int64_t kPixel = std::int64_t{1} << kFractionBits;
  return std::max(a.slope, b.slope) < kPixel && std::min(a.slope, b.slope) > -kPixel;
}

/// How far the crossings of `rows` rows come from the first one, to the left and to the right.
struct Drift {
  std::int64_t left;
  std::int64_t right;
  Drift(std::int64_t slope, int rows) {
    const std::int64_t change = (rows - 1) * slope;
    left = change < 0 ? change : 0;
    right = change < 0 ? 0 : change;
  }
};

// Bands.
//
// Within a band the rows are in lanes of 32 bits, 21 of them fraction bits, counted from the left side of the band's
// first strip: 0 <= count < 2^11. Dropping 23 fraction bits of t and of row * slope takes away less than 2^-20, so this
// needs 1/(2 dy) > 2^-20 + 2^-29. What is above 32 bits is lost, and need not be known. Of an edge of fewer rows than a
// band has, or even one, |slope| is below 2^11 px: a band's drift fits 64 bits.
inline constexpr int kLaneFractionBits = 21;
inline constexpr int kDroppedBits = kFractionBits - kLaneFractionBits;
inline constexpr int kMostBandExtent = (1 << (32 - kLaneFractionBits)) - 2 * kStripWidth;
/// Edges up to 2000 px high are drawn in bands.
inline constexpr std::int64_t kMostBandHeight = 2000 * 256;
static_assert(1 / (2.0 * kMostBandHeight) > 0x1p-20 + 0x1p-29);

inline constexpr int kLaneRows = static_cast<int>(kLanes);

/// A number for each row of a band.
template <int Rows, class Numbers = U32>
struct BandRows {
  static constexpr int kVectors = Rows / kLaneRows;
  static_assert(kVectors * kLaneRows == Rows && Rows <= kRowsBelow);
  Numbers vectors[kVectors];
};

/// The same as narrow counts.
template <int Rows>
HWY_INLINE decltype(auto) narrow(const BandRows<Rows>& counts) {
  using Narrow = BandRows<Rows, NarrowCounts>;
  if constexpr (std::is_same_v<Narrow, BandRows<Rows>>) {
    return (counts);
  } else {
    Narrow narrowed;
    for (int i = 0; i < Narrow::kVectors; ++i) narrowed.vectors[i] = narrow(counts.vectors[i]);
    return narrowed;
  }
}

/// An edge's crossings in bands of `Rows` rows.
template <int Rows>
class BandEdge {
 public:
  using Counts = BandRows<Rows>;

  explicit BandEdge(const Crossings& c) : t_(c.t), slope_(c.slope), drift_(c.slope, Rows) {
    const auto d = DI32();
    const auto whole = static_cast<std::int32_t>(slope_ >> kDroppedBits);
    const auto rest = static_cast<std::int32_t>(slope_ & ((std::int64_t{1} << kDroppedBits) - 1));
    static_assert((std::int64_t{Rows} << kDroppedBits) <= (std::int64_t{1} << 31));
    for (int i = 0; i < Counts::kVectors; ++i) {
      const I32 row = hn::Iota(d, i * kLaneRows);
      const I32 rests = hn::ShiftRight<kDroppedBits>(hn::Mul(row, hn::Set(d, rest)));
      steps_.vectors[i] = hn::BitCast(DU32(), hn::Add(hn::Mul(row, hn::Set(d, whole)), rests));
    }
  }

  std::int64_t leftmost() const { return t_ + drift_.left; }
  std::int64_t rightmost() const { return t_ + drift_.right; }
  std::int64_t leftmost(int rows) const { return t_ + Drift(slope_, rows).left; }
  std::int64_t rightmost(int rows) const { return t_ + Drift(slope_, rows).right; }
  void skip_band() { t_ += Rows * slope_; }

  /// The counts of a band's rows, from strip `first` on.
  HWY_INLINE Counts counts(int first) const {
    const std::int64_t from = t_ - (std::int64_t{first} << (kFractionBits + kStripBits));
    const U32 start = hn::Set(DU32(), static_cast<std::uint32_t>(from >> kDroppedBits));
    Counts counts;
    for (int i = 0; i < Counts::kVectors; ++i) {
      counts.vectors[i] = hn::ShiftRight<kLaneFractionBits>(hn::Add(start, steps_.vectors[i]));
    }
    return counts;
  }

 private:
  std::int64_t t_;
  std::int64_t slope_;
  Drift drift_;
  Counts steps_;
};

/// Up to that many strips of a band are not asked whether they hold an edge.
inline constexpr int kStripsToAdd = kNarrowColumns / kStripWidth;

inline int strip_of(std::int64_t t) { return static_cast<int>(t >> (kFractionBits + kStripBits)); }
/// That of the last pixel before the count of t.
inline int last_strip_before(std::int64_t t) { return strip_of(t - (std::int64_t{1} << kFractionBits)); }

/// Adds what lies between both counts of a band's rows to the strip that begins `columns` right of where they are taken
/// from.
template <int Rows>
HWY_INLINE void add_between(const BandRows<Rows>& left, const BandRows<Rows>& right, int columns, std::uint32_t* to) {
  for (int i = 0; i < BandRows<Rows>::kVectors; ++i) {
    add(wide_bits_between(left.vectors[i], right.vectors[i], columns), to + i * kLaneRows);
  }
}

/// The same for the first `count` strips, at most kStripsToAdd. Two are drawn without asking, in which thin and small
/// triangles show in most bands, and the others two by two: one more than there are has nothing added to it.
template <int Rows>
HWY_INLINE void add_strips(const BandRows<Rows, NarrowCounts>& left, const BandRows<Rows, NarrowCounts>& right,
                           int count, std::size_t stride, std::uint32_t* to) {
  constexpr int kVectors = BandRows<Rows>::kVectors;
  const auto add_strip = [&](int columns, std::uint32_t* words) HWY_ATTR {
    for (int i = 0; i < kVectors; ++i) {
      add(bits_between(left.vectors[i], right.vectors[i], columns), words + i * kLaneRows);
    }
  };
  for (int i = 0; i < kVectors; ++i) add(bits_between(left.vectors[i], right.vectors[i]), to + i * kLaneRows);
  add_strip(kStripWidth, to + stride);
  for (int strip = 2; strip < count; strip += 2) {
    to += 2 * stride;
    add_strip(strip * kStripWidth, to);
    add_strip((strip + 1) * kStripWidth, to + stride);
  }
}

/// Draws rows begin <= row < end, crossed by both edges, inside the target.
template <int Rows>
HWY_INLINE void draw_bands(const Crossings& left_crossings, const Crossings& right_crossings, int begin, int end,
                           const Strips& strips) {
  using Counts = BandRows<Rows>;
  BandEdge<Rows> left(left_crossings), right(right_crossings);
  std::uint32_t* words = strips.words + begin;
  const auto word = [&](int strip) { return words + static_cast<std::size_t>(strip) * strips.stride; };
  int rows = end - begin;
  for (; rows >= Rows; rows -= Rows, words += Rows, left.skip_band(), right.skip_band()) {
    const int first = strip_of(left.leftmost());
    const int last = last_strip_before(right.rightmost());
    if (last < first) continue;
    const Counts left_counts = left.counts(first), right_counts = right.counts(first);
    if (last < first + kStripsToAdd) {
      add_strips<Rows>(narrow(left_counts), narrow(right_counts), last - first + 1, strips.stride, word(first));
      continue;
    }
    // Strips from `full` to `ending` hold no edge.
    const int full = strip_of(left.rightmost()) + 1;
    const int ending = strip_of(right.leftmost());
    int strip = first;
    for (; strip < full; ++strip) add_between(left_counts, right_counts, (strip - first) * kStripWidth, word(strip));
    for (; strip < ending; ++strip) {
      for (int i = 0; i < Rows; i += kLaneRows) {
        hn::StoreU(hn::Set(DU32(), ~std::uint32_t{0}), DU32(), word(strip) + i);
      }
    }
    for (; strip <= last; ++strip) add_between(left_counts, right_counts, (strip - first) * kStripWidth, word(strip));
  }
  if (rows == 0) return;
  const int first = strip_of(left.leftmost(rows));
  const int last = last_strip_before(right.rightmost(rows));
  if (last < first) return;
  Counts left_counts = left.counts(first), right_counts = right.counts(first);
  for (int i = 0; i < Counts::kVectors; ++i) {
    // Rows behind the last get both counts the same, hence nothing between them.
    const M32 live = hn::Lt(hn::Iota(DI32(), i * kLaneRows), hn::Set(DI32(), rows));
    left_counts.vectors[i] = keep(live, left_counts.vectors[i]);
    right_counts.vectors[i] = keep(live, right_counts.vectors[i]);
  }
  if (last < first + kStripsToAdd) {
    return add_strips<Rows>(narrow(left_counts), narrow(right_counts), last - first + 1, strips.stride, word(first));
  }
  for (int strip = first; strip <= last; ++strip) {
    add_between(left_counts, right_counts, (strip - first) * kStripWidth, word(strip));
  }
}

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
    std::uint32_t* to = strips.words + row + static_cast<std::size_t>(first) * strips.stride;
    const auto draw_edges = [&](int strip) HWY_ATTR {
      const I32 begin = hn::Set(d, strip * kStripWidth);
      const auto bits = [&](I32 counts) HWY_ATTR {
        return bits_from_wide(hn::BitCast(du, hn::Max(hn::Sub(counts, begin), hn::Zero(d))));
      };
      add(hn::Xor(bits(left_counts), bits(right_counts)), to);
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

HWY_INLINE void sort_by_y(Point& a, Point& b) {
  const bool swap = b.y < a.y;
  const Point upper{swap ? b.x : a.x, swap ? b.y : a.y};
  b = {swap ? a.x : b.x, swap ? a.y : b.y};
  a = upper;
}

/// Never inlined, so that its code is the same whoever calls it.
HWY_NOINLINE void draw_large(const FixedTriangle<ShiftedFormat>& triangle, int width, const Strips& strips) {
  Point v[3];
  for (std::size_t i = 0; i < 3; ++i) v[i] = {triangle[i].x.value(), triangle[i].y.value()};
  sort_by_y(v[0], v[1]);
  sort_by_y(v[1], v[2]);
  sort_by_y(v[0], v[1]);
  const auto first_row = [&](const Point& p) { return std::clamp((p.y + 127) >> 8, 0, strips.height); };
  const int top = first_row(v[0]), middle = first_row(v[1]), bottom = first_row(v[2]);
  if (top >= bottom) return;
  const auto [leftmost, rightmost] = std::minmax({v[0].x, v[1].x, v[2].x});
  const bool in_bands = leftmost >= 0 && rightmost <= width * 256 && rightmost - leftmost <= kMostBandExtent * 256 &&
                        v[2].y - v[0].y <= kMostBandHeight;
  // Which of the edges is left; where they lie in one line it does not matter.
  const bool longer_is_left =
      std::int64_t{v[2].x - v[0].x} * (v[1].y - v[0].y) < std::int64_t{v[1].x - v[0].x} * (v[2].y - v[0].y);
  const auto draw_rows = [&](const Crossings& longer, const Crossings& shorter, int begin, int end) {
    const Crossings& left = longer_is_left ? longer : shorter;
    const Crossings& right = longer_is_left ? shorter : longer;
    if (!in_bands) {
      draw_anywhere(left, right, begin, end, strips);
    } else if (are_steep(left, right)) {
      draw_bands<2 * kMaxLanes>(left, right, begin, end, strips);
    } else {
      draw_bands<kMaxLanes>(left, right, begin, end, strips);
    }
  };
  Crossings longer(v[0], v[2], top, bottom - top);
  if (top < middle) draw_rows(longer, Crossings(v[0], v[1], top, middle - top), top, middle);
  if (middle < bottom) {
    longer.skip(middle - top);
    draw_rows(longer, Crossings(v[1], v[2], middle, bottom - middle), middle, bottom);
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
