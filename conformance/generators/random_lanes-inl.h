// Random (random.h) in lanes: the streams of consecutive items of a family, one to a lane, number by number the same.
#include "conformance/generators/random.h"
#include "hwy/highway.h"

#if defined(EDGECASE_RANDOM_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_RANDOM_LANES_INL_H_
#undef EDGECASE_RANDOM_LANES_INL_H_
#else
#define EDGECASE_RANDOM_LANES_INL_H_
#endif

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace edgecase::conformance::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::ScalableTag<std::uint64_t>;
using D32 = hn::Repartition<std::uint32_t, D64>;
/// Numbers modulo 2^64, signed ones among them.
using U64 = hn::Vec<D64>;

HWY_INLINE U64 all(std::uint64_t value) { return hn::Set(D64(), value); }
HWY_INLINE U64 all(std::int64_t value) { return hn::Set(D64(), static_cast<std::uint64_t>(value)); }

/// The product of the lower halves.
HWY_INLINE U64 multiply_halves(U64 a, U64 b) {
#if HWY_TARGET == HWY_SCALAR
  return all((hn::GetLane(a) & 0xffffffff) * (hn::GetLane(b) & 0xffffffff));
#else
  return hn::MulEven(hn::BitCast(D32(), a), hn::BitCast(D32(), b));
#endif
}

/// a * factor; where there is no such instruction, or Highway has no name for it, by halves.
HWY_INLINE U64 multiply(U64 a, std::uint64_t factor) {
#if HWY_TARGET <= HWY_AVX3
  return U64{_mm512_mullo_epi64(a.raw, all(factor).raw)};
#else
  const U64 low = all(factor & 0xffffffff), high = all(factor >> 32);
  const U64 crossed = hn::Add(multiply_halves(hn::ShiftRight<32>(a), low), multiply_halves(a, high));
  return hn::Add(multiply_halves(a, low), hn::ShiftLeft<32>(crossed));
#endif
}

class RandomLanes {
 public:
  /// What the streams of a family's items have in common.
  class Family {
   public:
    explicit Family(Random family) : first_(all(family.next())) {}

   private:
    friend class RandomLanes;
    U64 first_;
  };

  /// Items `first`, `first + 1` and so on.
  HWY_INLINE RandomLanes(const Family& family, std::uint64_t first)
      // Iota(D64(), first) may write its lanes to memory one by one and wait for them.
      : state_(hn::Xor(family.first_, hn::Add(hn::Iota(D64(), 0), all(first)))) {
    state_ = next();
  }

  HWY_INLINE U64 next() {
    state_ = hn::Add(state_, all(Random::kStep));
    U64 z = multiply(hn::Xor(state_, hn::ShiftRight<30>(state_)), Random::kFirstFactor);
    z = multiply(hn::Xor(z, hn::ShiftRight<27>(z)), Random::kSecondFactor);
    return hn::Xor(z, hn::ShiftRight<31>(z));
  }

  /// An integer from low to low + count - 1; count at most 2^31.
  HWY_INLINE U64 from(U64 low, U64 count) {
    return hn::Add(low, hn::ShiftRight<32>(multiply_halves(hn::ShiftRight<32>(next()), count)));
  }

  HWY_INLINE hn::Mask<D64> one_in(std::int64_t n) {
    return hn::Eq(from(all(std::uint64_t{1}), all(n)), all(std::uint64_t{1}));
  }

 private:
  U64 state_;
};

}  // namespace edgecase::conformance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
