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
  HWY_ALIGN std::int32_t strip_left[kMaxLanes], right[kMaxLanes], top[kMaxLanes], middle[kMaxLanes], bottom[kMaxLanes];
  struct StoredEdge {
    HWY_ALIGN float k[kMaxLanes], step[kMaxLanes], scale[kMaxLanes];
  };
  StoredEdge longer, upper, lower;
};

HWY_INLINE void store(const LaneEdge& edge, StoredSetup::StoredEdge& to) {
  const auto d = DF32();
  hn::Store(edge.k, d, to.k);
  hn::Store(edge.step, d, to.step);
  hn::Store(edge.scale, d, to.scale);
}

HWY_INLINE void store(const LaneSetup& s, StoredSetup& to) {
  const auto d = DI32();
  hn::Store(s.strip_left, d, to.strip_left);
  hn::Store(s.right, d, to.right);
  hn::Store(s.top, d, to.top);
  hn::Store(s.middle, d, to.middle);
  hn::Store(s.bottom, d, to.bottom);
  store(s.longer, to.longer);
  store(s.upper, to.upper);
  store(s.lower, to.lower);
}

/// Adds `words` to the rows from `to` on.
HWY_INLINE void add(U32 words, std::uint32_t* to) {
  const auto d = DU32();
  hn::StoreU(hn::Or(hn::LoadU(d, to), words), d, to);
}

/// Draws lane `lane`, which has rows and columns in the target.
HWY_INLINE void draw_medium(const StoredSetup& s, std::size_t lane, const Strips& strips) {
  const auto di = DI32();
  const auto df = DF32();
  const int top = s.top[lane];
  const int middle = s.middle[lane] - top;
  const int begin = std::max(-top, 0);
  const int end = std::min(s.bottom[lane], strips.height) - top;
  const int first_strip = s.strip_left[lane] >> 5;
  const int strip_begin = std::max(first_strip, 0);
  const int strip_end = std::min((s.right[lane] + kStripWidth - 1) >> 5, strips.count);

  const F32 longer_k = hn::Set(df, s.longer.k[lane]);
  const F32 longer_step = hn::Set(df, s.longer.step[lane]);
  const F32 longer_scale = hn::Set(df, s.longer.scale[lane]);
  const F32 upper_k = hn::Set(df, s.upper.k[lane]);
  const F32 upper_step = hn::Set(df, s.upper.step[lane]);
  const F32 upper_scale = hn::Set(df, s.upper.scale[lane]);
  // Continued upwards, to the first row of the triangle: an integer that float_decides() has regarded.
  const F32 lower_k = hn::Set(df, s.lower.k[lane] - s.lower.step[lane] * static_cast<float>(middle));
  const F32 lower_step = hn::Set(df, s.lower.step[lane]);
  const F32 lower_scale = hn::Set(df, s.lower.scale[lane]);

  for (int first = begin; first < end; first += static_cast<int>(kLanes)) {
    const I32 row = hn::Iota(di, first);
    const F32 frow = hn::ConvertTo(df, row);
    const auto below = cast(hn::Lt(row, hn::Set(di, middle)));
    const F32 k0 = hn::MulAdd(frow, longer_step, longer_k);
    const F32 k1 =
        hn::MulAdd(frow, hn::IfThenElse(below, upper_step, lower_step), hn::IfThenElse(below, upper_k, lower_k));
    I32 count0 = round_count(k0, longer_scale);
    I32 count1 = round_count(k1, hn::IfThenElse(below, upper_scale, lower_scale));
    // Rows behind the last have none left of either.
    const M32 live = hn::Lt(row, hn::Set(di, end));
    count0 = hn::IfThenElseZero(live, count0);
    count1 = hn::IfThenElseZero(live, count1);
    std::uint32_t* to = strips.words + top + first;
    for (int strip = strip_begin; strip < strip_end; ++strip) {
      const I32 before = hn::Set(di, (strip - first_strip) * kStripWidth);
      const I32 right0 = hn::Max(hn::Sub(count0, before), hn::Zero(di));
      const I32 right1 = hn::Max(hn::Sub(count1, before), hn::Zero(di));
      add(hn::Xor(bits_from(right0), bits_from(right1)), to + static_cast<std::size_t>(strip) * strips.stride);
    }
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
