// The vectors of the fast rasterizer, for the instruction set that is being compiled.
#if defined(EDGECASE_FAST_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_LANES_INL_H_
#undef EDGECASE_FAST_LANES_INL_H_
#else
#define EDGECASE_FAST_LANES_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"
#include "rasterizer/fast/region.h"
#include "rasterizer/fast/strip_mask.h"

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF32 = hn::CappedTag<float, kMaxLanes>;
using DI32 = hn::CappedTag<std::int32_t, kMaxLanes>;
using DU32 = hn::CappedTag<std::uint32_t, kMaxLanes>;
using F32 = hn::Vec<DF32>;
using I32 = hn::Vec<DI32>;
using U32 = hn::Vec<DU32>;
using M32 = hn::Mask<DI32>;

inline constexpr std::size_t kLanes = hn::MaxLanes(DI32());
/// The same where rows are in lanes.
inline constexpr int kLaneRows = static_cast<int>(kLanes);
static_assert(kLanes <= kMaxLanes);

/// Columns of samples of the triangles that are drawn a triangle to a lane: counts in two strips stay below 64.
inline constexpr int kSmallColumns = 31;
inline constexpr int kSmallRows = 16;
/// Columns and rows of samples of the triangles whose setup is done in lanes, and whose rows are binary32.
inline constexpr int kMediumExtent = 64;

HWY_INLINE auto cast(M32 mask) { return hn::RebindMask(DF32(), mask); }
HWY_INLINE U32 keep(M32 mask, U32 words) { return hn::IfThenElseZero(hn::RebindMask(DU32(), mask), words); }

/// first, first + 1 ... hn::Iota(), of a number that the compiler does not know, may write its lanes to memory one by
/// one and then has to wait until all of them can be read at once.
HWY_INLINE I32 numbers_from(int first) { return hn::Add(hn::Iota(DI32(), 0), hn::Set(DI32(), first)); }

/// Bit i: lane i.
HWY_INLINE std::uint64_t bits_of(M32 mask) {
  std::uint64_t bits = 0;
  hn::StoreMaskBits(DI32(), mask, reinterpret_cast<std::uint8_t*>(&bits));
  return bits;
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
