#include "conformance/scene/coordinates.h"

#include <bit>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "conformance/scene/coordinates.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace edgecase::conformance::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Magnitudes of binary32 compare as their bit patterns do, infinity and NaN above all others. A difference of two is
// negative where the first is less, and a coordinate is out of range if one of two numbers is: what exceeds `high`, or
// falls short of `low` and is not 0.
bool magnitudes_within(const float* coordinates, std::size_t count, std::int32_t low, std::int32_t high) {
  const hn::ScalableTag<std::int32_t> d;
  const hn::ScalableTag<float> df;
  using Vector = hn::Vec<decltype(d)>;
  const Vector most = hn::Set(d, high), least = hn::Set(d, low), one = hn::Set(d, 1), but_sign = hn::Set(d, 0x7fffffff);
  const auto fault = [&](Vector pattern) HWY_ATTR {
    const Vector magnitude = hn::And(pattern, but_sign);
    const Vector short_of_least = hn::AndNot(hn::Sub(magnitude, one), hn::Sub(magnitude, least));
    return hn::Or(hn::Sub(most, magnitude), short_of_least);
  };
  const auto patterns = [&](std::size_t i) HWY_ATTR { return hn::BitCast(d, hn::LoadU(df, coordinates + i)); };
  const std::size_t lanes = hn::Lanes(d);
  Vector faults = hn::Zero(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) faults = hn::Or(faults, fault(patterns(i)));
  std::int32_t rest = 0;
  for (; i < count; ++i) rest |= hn::GetLane(fault(hn::Set(d, std::bit_cast<std::int32_t>(coordinates[i]))));
  return rest >= 0 && hn::AllFalse(d, hn::Lt(faults, hn::Zero(d)));
}

}  // namespace edgecase::conformance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgecase::conformance {

HWY_EXPORT(magnitudes_within);

bool all_within(std::span<const Triangle> triangles, float most, float least) {
  static_assert(sizeof(Triangle) == 6 * sizeof(float));
  const auto low = std::bit_cast<std::int32_t>(least), high = std::bit_cast<std::int32_t>(most);
  if (high < 0) return triangles.empty();
  const auto* coordinates = reinterpret_cast<const float*>(triangles.data());
  return HWY_DYNAMIC_DISPATCH(magnitudes_within)(coordinates, 6 * triangles.size(), low, high);
}

}  // namespace edgecase::conformance
#endif
