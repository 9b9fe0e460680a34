// Rounding without a call, which std::nearbyint is where the build does not ask for SSE4.1.
#pragma once

#include <cmath>

namespace edgecase::conformance {

/// The nearest whole number, the even one of two, with the sign of `value`. Below 2^22 by a sum, which is rounded to
/// nearest even, too: beside 3 * 2^22 there is no bit for a fraction.
inline float nearest_even(float value) {
  constexpr float kNoFraction = 3 * 0x1p22F;
  if (!(std::abs(value) < 0x1p22F)) return std::nearbyint(value);
  return std::copysign((value + kNoFraction) - kNoFraction, value);
}

}  // namespace edgecase::conformance
