// Where the edges of triangles of any size cross rows, and how far that moves from row to row.
//
// Counts (see small-inl.h) are the integer part of t(row) = (c - 1/2) / dy + 1, which is at least 1/(2 dy) away from
// every integer, in fixed point with 44 fraction bits. The fixed-point t and its slope are products of binary64 numbers
// with a rounded reciprocal: with |t| <= 2^16 + 1 px in the rows of the edge, R <= 2^14 rows and hence |slope| R <=
// 2^17 (a slope is used only if there are two rows), t is off by less than 2^17 2^-52 + 2^-44, the slope, R times, by
// less than 2^17 2^-52 + R 2^-44, together below 2^-29: less than 1/(2 dy) >= 2^-25.
#include "rasterizer/fast/lanes-inl.h"

#if defined(EDGECASE_FAST_CROSSINGS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_CROSSINGS_INL_H_
#undef EDGECASE_FAST_CROSSINGS_INL_H_
#else
#define EDGECASE_FAST_CROSSINGS_INL_H_
#endif

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

inline constexpr int kFractionBits = 44;
inline constexpr int kStripBits = 5;
static_assert(1 << kStripBits == kStripWidth);

/// The crossings of an edge with rows, from some row on.
struct Crossings {
  std::int64_t t;      ///< in that row
  std::int64_t slope;  ///< from row to row

  /// In unsigned arithmetic, as what lies beyond the edge's end may wrap.
  void skip(int rows) {
    t = static_cast<std::int64_t>(static_cast<std::uint64_t>(t) +
                                  static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(slope));
  }
};

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

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
