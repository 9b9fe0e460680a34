// Bands: 32 rows of a triangle, crossed by one left and one right edge; the strips between these are filled without
// being read.
//
// Within a band the rows are in lanes of 32 bits, 21 of them fraction bits, counted from the left side of the band's
// first strip: 0 <= count < 2^11. Dropping 23 fraction bits of t and of row * slope takes away less than 2^-20, so this
// needs 1/(2 dy) > 2^-20 + 2^-29. What is above 32 bits is lost, and need not be known. Of an edge of fewer rows than a
// band has, or even one, |slope| is below 2^11 px: a band's drift fits 64 bits.
#include "rasterizer/fast/crossings-inl.h"
#include "rasterizer/fast/medium-inl.h"

#if defined(EDGECASE_FAST_BANDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_BANDS_INL_H_
#undef EDGECASE_FAST_BANDS_INL_H_
#else
#define EDGECASE_FAST_BANDS_INL_H_
#endif

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

inline constexpr int kLaneFractionBits = 21;
inline constexpr int kDroppedBits = kFractionBits - kLaneFractionBits;
inline constexpr int kMostBandExtent = (1 << (32 - kLaneFractionBits)) - 2 * kStripWidth;
/// Edges up to 2000 px high are drawn in bands.
inline constexpr std::int64_t kMostBandHeight = 2000 * 256;
static_assert(1 / (2.0 * kMostBandHeight) > 0x1p-20 + 0x1p-29);

/// Bands of 16 rows would draw less beside flat edges. But how many strips a band has, the processor has to guess, and
/// what it guesses wrongly costs as much as drawing several: fewer bands are faster, however flat the edges.
inline constexpr int kBandRows = 32;
inline constexpr int kBandVectors = kBandRows / kLaneRows;
static_assert(kBandVectors * kLaneRows == kBandRows && kBandRows <= kRowsBelow);

/// A number for each row of a band.
template <class Numbers = U32>
struct BandRows {
  Numbers vectors[kBandVectors];
};

/// The same as narrow counts.
HWY_INLINE decltype(auto) narrow(const BandRows<>& counts) {
  if constexpr (std::is_same_v<NarrowCounts, U32>) {
    return (counts);
  } else {
    BandRows<NarrowCounts> narrowed;
    for (int i = 0; i < kBandVectors; ++i) narrowed.vectors[i] = narrow(counts.vectors[i]);
    return narrowed;
  }
}

/// An edge's crossings in bands.
class BandEdge {
 public:
  explicit BandEdge(const Crossings& c) : t_(c.t), slope_(c.slope), drift_(c.slope, kBandRows) {
    const auto d = DI32();
    const auto whole = static_cast<std::int32_t>(slope_ >> kDroppedBits);
    const auto rest = static_cast<std::int32_t>(slope_ & ((std::int64_t{1} << kDroppedBits) - 1));
    static_assert((std::int64_t{kBandRows} << kDroppedBits) <= (std::int64_t{1} << 31));
    for (int i = 0; i < kBandVectors; ++i) {
      const I32 row = numbers_from(i * kLaneRows);
      const I32 rests = hn::ShiftRight<kDroppedBits>(hn::Mul(row, hn::Set(d, rest)));
      steps_.vectors[i] = hn::BitCast(DU32(), hn::Add(hn::Mul(row, hn::Set(d, whole)), rests));
    }
  }

  std::int64_t leftmost() const { return t_ + drift_.left; }
  std::int64_t rightmost() const { return t_ + drift_.right; }
  std::int64_t leftmost(int rows) const { return t_ + Drift(slope_, rows).left; }
  std::int64_t rightmost(int rows) const { return t_ + Drift(slope_, rows).right; }
  void skip_band() { t_ += kBandRows * slope_; }

  /// The counts of a band's rows, from strip `first` on.
  HWY_INLINE BandRows<> counts(int first) const {
    const std::int64_t from = t_ - (std::int64_t{first} << (kFractionBits + kStripBits));
    const U32 start = hn::Set(DU32(), static_cast<std::uint32_t>(from >> kDroppedBits));
    BandRows<> counts;
    for (int i = 0; i < kBandVectors; ++i) {
      counts.vectors[i] = hn::ShiftRight<kLaneFractionBits>(hn::Add(start, steps_.vectors[i]));
    }
    return counts;
  }

 private:
  std::int64_t t_;
  std::int64_t slope_;
  Drift drift_;
  BandRows<> steps_;
};

/// Up to that many strips of a band are not asked whether they hold an edge.
inline constexpr int kStripsToAdd = kNarrowColumns / kStripWidth;

inline int strip_of(std::int64_t t) { return static_cast<int>(t >> (kFractionBits + kStripBits)); }
/// That of the last pixel before the count of t.
inline int last_strip_before(std::int64_t t) { return strip_of(t - (std::int64_t{1} << kFractionBits)); }

/// Adds what lies between both counts of a band's rows to the strip that begins `columns` right of where they are taken
/// from.
HWY_INLINE void add_between(const BandRows<>& left, const BandRows<>& right, int columns, std::uint32_t* to) {
  for (int i = 0; i < kBandVectors; ++i) {
    add(wide_bits_between(left.vectors[i], right.vectors[i], columns), to + i * kLaneRows);
  }
}

/// The same for the first `count` strips, at most kStripsToAdd. Two are drawn without asking, in which thin and small
/// triangles show in most bands, and the others two by two: one more than there are has nothing added to it.
HWY_INLINE void add_strips(const BandRows<NarrowCounts>& left, const BandRows<NarrowCounts>& right, int count,
                           std::size_t stride, std::uint32_t* to) {
  const auto add_strip = [&](int columns, std::uint32_t* words) HWY_ATTR {
    for (int i = 0; i < kBandVectors; ++i) {
      add(bits_between(left.vectors[i], right.vectors[i], columns), words + i * kLaneRows);
    }
  };
  for (int i = 0; i < kBandVectors; ++i) add(bits_between(left.vectors[i], right.vectors[i]), to + i * kLaneRows);
  add_strip(kStripWidth, to + stride);
  for (int strip = 2; strip < count; strip += 2) {
    to += 2 * stride;
    add_strip(strip * kStripWidth, to);
    add_strip((strip + 1) * kStripWidth, to + stride);
  }
}

/// Draws rows begin <= row < end, crossed by both edges, inside the target.
HWY_INLINE void draw_bands(const Crossings& left_crossings, const Crossings& right_crossings, int begin, int end,
                           const Strips& strips) {
  BandEdge left(left_crossings), right(right_crossings);
  std::uint32_t* words = strips.words + begin;
  // A copy, as vectors that are stored may alias anything.
  const std::size_t stride = strips.stride;
  const auto word = [&](int strip) { return words + static_cast<std::size_t>(strip) * stride; };
  int rows = end - begin;
  for (; rows >= kBandRows; rows -= kBandRows, words += kBandRows, left.skip_band(), right.skip_band()) {
    const int first = strip_of(left.leftmost());
    const int last = last_strip_before(right.rightmost());
    if (last < first) continue;
    const BandRows<> left_counts = left.counts(first), right_counts = right.counts(first);
    if (last < first + kStripsToAdd) {
      add_strips(narrow(left_counts), narrow(right_counts), last - first + 1, stride, word(first));
      continue;
    }
    // Strips from `full` to `ending` hold no edge.
    const int full = strip_of(left.rightmost()) + 1;
    const int ending = strip_of(right.leftmost());
    int strip = first;
    std::uint32_t* to = word(first);
    for (; strip < full; ++strip, to += stride) {
      add_between(left_counts, right_counts, (strip - first) * kStripWidth, to);
    }
    for (; strip < ending; ++strip, to += stride) {
      for (int i = 0; i < kBandRows; i += kLaneRows) hn::StoreU(hn::Set(DU32(), ~std::uint32_t{0}), DU32(), to + i);
    }
    for (; strip <= last; ++strip, to += stride) {
      add_between(left_counts, right_counts, (strip - first) * kStripWidth, to);
    }
  }
  if (rows == 0) return;
  const int first = strip_of(left.leftmost(rows));
  const int last = last_strip_before(right.rightmost(rows));
  if (last < first) return;
  BandRows<> left_counts = left.counts(first), right_counts = right.counts(first);
  for (int i = 0; i < kBandVectors; ++i) {
    // Rows behind the last get both counts the same, hence nothing between them.
    const M32 live = hn::Lt(numbers_from(i * kLaneRows), hn::Set(DI32(), rows));
    left_counts.vectors[i] = keep(live, left_counts.vectors[i]);
    right_counts.vectors[i] = keep(live, right_counts.vectors[i]);
  }
  if (last < first + kStripsToAdd) {
    return add_strips(narrow(left_counts), narrow(right_counts), last - first + 1, stride, word(first));
  }
  for (int strip = first; strip <= last; ++strip) {
    add_between(left_counts, right_counts, (strip - first) * kStripWidth, word(strip));
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
