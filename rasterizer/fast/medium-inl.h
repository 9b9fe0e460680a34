// Triangles up to 64 x 64 px, rows in lanes: the setup and the arithmetic of small-inl.h, anywhere on the target.
#include "rasterizer/fast/small-inl.h"

#if defined(EDGECASE_FAST_MEDIUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_MEDIUM_INL_H_
#undef EDGECASE_FAST_MEDIUM_INL_H_
#else
#define EDGECASE_FAST_MEDIUM_INL_H_
#endif

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// A LaneSetup in memory, a lane of which is one triangle.
struct StoredSetup {
  HWY_ALIGN std::int32_t strip_left[kMaxLanes], right[kMaxLanes], top[kMaxLanes];
  HWY_ALIGN std::int32_t middle[kMaxLanes], rows[kMaxLanes];  ///< from the top on
  struct StoredEdge {
    HWY_ALIGN float k[kMaxLanes], step[kMaxLanes], scale[kMaxLanes];  ///< k of the top row
  };
  StoredEdge longer, upper, lower;
};

HWY_INLINE void store(const LaneEdge& edge, StoredSetup::StoredEdge& to) {
  const auto d = DF32();
  hn::Store(edge.k, d, to.k);
  hn::Store(edge.step, d, to.step);
  hn::Store(edge.scale, d, to.scale);
}

/// The lower edge continued upwards by `middle` rows: float_decides() regards an edge in all rows of its triangle.
HWY_INLINE F32 k_of_top(const LaneEdge& lower, I32 middle) {
  return hn::NegMulAdd(hn::ConvertTo(DF32(), middle), lower.step, lower.k);
}

HWY_INLINE void store(const LaneSetup& s, StoredSetup& to) {
  const auto d = DI32();
  const I32 middle = hn::Sub(s.middle, s.top);
  hn::Store(s.strip_left, d, to.strip_left);
  hn::Store(s.right, d, to.right);
  hn::Store(s.top, d, to.top);
  hn::Store(middle, d, to.middle);
  hn::Store(hn::Sub(s.bottom, s.top), d, to.rows);
  store(s.longer, to.longer);
  store(s.upper, to.upper);
  LaneEdge lower = s.lower;
  lower.k = k_of_top(lower, middle);
  store(lower, to.lower);
}

/// Adds `words` to the rows from `to` on.
HWY_INLINE void add(U32 words, std::uint32_t* to) {
  const auto d = DU32();
  hn::StoreU(hn::Or(hn::LoadU(d, to), words), d, to);
}

/// An edge of a stored triangle, the same in every lane.
struct RowEdge {
  F32 k, step, scale;
  RowEdge(const StoredSetup::StoredEdge& edge, std::size_t lane)
      : k(hn::Set(DF32(), edge.k[lane])),
        step(hn::Set(DF32(), edge.step[lane])),
        scale(hn::Set(DF32(), edge.scale[lane])) {}
};

/// A stored triangle with its rows in lanes.
class RowCounts {
 public:
  RowCounts(const StoredSetup& s, std::size_t lane)
      : longer_(s.longer, lane),
        upper_(s.upper, lane),
        lower_(s.lower, lane),
        middle_(hn::Set(DI32(), s.middle[lane])) {}

  /// The counts of the kLanes rows from `first` on; equal to each other from row `end` on.
  HWY_INLINE void at(int first, I32 end, I32& count0, I32& count1) const {
    const I32 row = numbers_from(first);
    const F32 frow = hn::ConvertTo(DF32(), row);
    const auto above = cast(hn::Lt(row, middle_));
    const M32 live = hn::Lt(row, end);
    const F32 k0 = hn::MulAdd(frow, longer_.step, longer_.k);
    const F32 k1 =
        hn::MulAdd(frow, hn::IfThenElse(above, upper_.step, lower_.step), hn::IfThenElse(above, upper_.k, lower_.k));
    count0 = hn::IfThenElseZero(live, round_count(k0, longer_.scale));
    count1 = hn::IfThenElseZero(live, round_count(k1, hn::IfThenElse(above, upper_.scale, lower_.scale)));
  }

 private:
  RowEdge longer_, upper_, lower_;
  I32 middle_;
};

/// Draws lane `lane`, which has rows and columns in the target.
HWY_NOINLINE void draw_medium(const StoredSetup& s, std::size_t lane, const Strips& strips) {
  const int top = s.top[lane];
  const int begin = std::max(-top, 0);
  const int end = std::min(s.rows[lane], strips.height - top);
  const int first_strip = s.strip_left[lane] >> 5;
  const int strip_begin = std::max(first_strip, 0);
  const int strip_end = std::min((s.right[lane] + kStripWidth - 1) >> 5, strips.count);
  const RowCounts rows(s, lane);
  const std::size_t stride = strips.stride;
  for (int first = begin; first < end; first += static_cast<int>(kLanes)) {
    I32 count0, count1;
    rows.at(first, hn::Set(DI32(), end), count0, count1);
    const NarrowCounts narrow0 = narrow(count0), narrow1 = narrow(count1);
    std::uint32_t* to = strips.words + top + first + static_cast<std::size_t>(strip_begin) * stride;
    for (int strip = strip_begin; strip < strip_end; ++strip, to += stride) {
      add(bits_between(narrow0, narrow1, (strip - first_strip) * kStripWidth), to);
    }
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
