// From a row's count, the number of its samples left of a crossing, to the bits of a strip from there on.
#include "rasterizer/fast/lanes-inl.h"

#if defined(EDGECASE_FAST_BITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_BITS_INL_H_
#undef EDGECASE_FAST_BITS_INL_H_
#else
#define EDGECASE_FAST_BITS_INL_H_
#endif

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// max(counts - columns, 0) of counts below 2^16.
HWY_INLINE U32 beyond(U32 counts, int columns) {
#if HWY_TARGET == HWY_SCALAR
  return hn::BitCast(DU32(), hn::Max(hn::Sub(hn::BitCast(DI32(), counts), hn::Set(DI32(), columns)), hn::Zero(DI32())));
#else
  const hn::Repartition<std::uint16_t, DU32> halves;
  const U32 wide = hn::Set(DU32(), static_cast<std::uint32_t>(columns));
  return hn::BitCast(DU32(), hn::SaturatedSub(hn::BitCast(halves, counts), hn::BitCast(halves, wide)));
#endif
}

#if HWY_TARGET == HWY_SSE4

// These vectors have no shift by a number of each lane's own, but look up bytes. Of a word's byte b those bits are set
// that are 8 b + i >= count: 0xff << max(count - 8 b, 0). With the count in each of a word's bytes, a subtraction that
// stops at zero leaves the number to shift by, of which every one from 8 on gives nothing.

using DU8 = hn::Repartition<std::uint8_t, DU32>;
/// The count in each of its lane's bytes.
using NarrowCounts = hn::Vec<DU8>;
/// They are compared with columns up to this one.
inline constexpr int kNarrowColumns = 7 * kStripWidth;

/// 0 <= count < 2^8; of any other count anything.
HWY_INLINE NarrowCounts narrow(U32 counts) {
  const DU8 d;
  alignas(16) static constexpr std::uint8_t kLowest[16] = {0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12};
  return hn::TableLookupBytes(hn::BitCast(d, counts), hn::Load(d, kLowest));
}

/// The strip's bits that begins `columns` right of where counts are taken from; 0 <= columns <= kNarrowColumns.
HWY_INLINE U32 bits_from(NarrowCounts counts, int columns) {
  const DU8 d;
  static_assert(kNarrowColumns + 24 < 256);
  alignas(16) static constexpr std::uint8_t kBegins[16] = {0, 8, 16, 24, 0, 8, 16, 24, 0, 8, 16, 24, 0, 8, 16, 24};
  alignas(16) static constexpr std::uint8_t kShifted[16] = {0xff, 0xfe, 0xfc, 0xf8, 0xf0, 0xe0, 0xc0, 0x80};
  const auto begins = hn::Add(hn::Load(d, kBegins), hn::Set(d, static_cast<std::uint8_t>(columns)));
  const auto shift = hn::Min(hn::SaturatedSub(counts, begins), hn::Set(d, 15));
  return hn::BitCast(DU32(), hn::TableLookupBytes(hn::Load(d, kShifted), shift));
}

HWY_INLINE U32 bits_from(NarrowCounts counts) { return bits_from(counts, 0); }

/// The bits from any count on.
HWY_INLINE U32 bits_from_wide(U32 counts) { return bits_from(narrow(hn::Min(counts, hn::Set(DU32(), kStripWidth)))); }

#else

using NarrowCounts = U32;
inline constexpr int kNarrowColumns = 16 * kStripWidth;
HWY_INLINE NarrowCounts narrow(U32 counts) { return counts; }

/// The bits from any count on: none for a count of 32 and above.
HWY_INLINE U32 bits_from_wide(U32 counts) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(DU32(), static_cast<std::uint32_t>(~std::uint64_t{0} << std::min(hn::GetLane(counts), 32u)));
#elif HWY_TARGET <= HWY_AVX2
  // These shift by any number.
  return hn::Shl(hn::Set(DU32(), ~std::uint32_t{0}), counts);
#else
  const auto below = hn::Lt(counts, hn::Set(DU32(), kStripWidth));
  const U32 bits = hn::Shl(hn::Set(DU32(), ~std::uint32_t{0}), hn::And(counts, hn::Set(DU32(), kStripWidth - 1)));
  return hn::IfThenElseZero(below, bits);
#endif
}

HWY_INLINE U32 bits_from(NarrowCounts counts) { return bits_from_wide(counts); }
HWY_INLINE U32 bits_from(NarrowCounts counts, int columns) { return bits_from_wide(beyond(counts, columns)); }

#endif

HWY_INLINE NarrowCounts narrow(I32 counts) { return narrow(hn::BitCast(DU32(), counts)); }

/// What lies between two counts, of the strip from which they are taken.
HWY_INLINE U32 bits_between(NarrowCounts a, NarrowCounts b) { return hn::Xor(bits_from(a), bits_from(b)); }

/// The same of the strip that begins `columns` right of it.
HWY_INLINE U32 bits_between(NarrowCounts a, NarrowCounts b, int columns) {
  return hn::Xor(bits_from(a, columns), bits_from(b, columns));
}

/// The same of counts below 2^16 and any column.
HWY_INLINE U32 wide_bits_between(U32 a, U32 b, int columns) {
  return hn::Xor(bits_from_wide(beyond(a, columns)), bits_from_wide(beyond(b, columns)));
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
