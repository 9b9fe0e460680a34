// The viewport through which window positions reach a driver unchanged.
#pragma once

#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "conformance/scene/coordinates.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// A driver computes window positions as ndc * half + centre, in one rounding (fma) or two. Here the viewport spans
/// [-half, half] on both axes around the window's origin, `half` being a power of two: ndc = v / half then only changes
/// the exponent, ndc * half restores v, and + 0 leaves it, however often the driver rounds. Every |v| <= half lies
/// inside the viewport, hence no vertex is clipped; a scissor confines the drawing to the target.
class EnclosingViewport {
 public:
  /// The largest such viewport of at most `max_extent` pixels in width and height. max_extent >= 2.
  static EnclosingViewport within(unsigned max_extent) {
    return EnclosingViewport(static_cast<float>(std::bit_floor(max_extent) / 2));
  }
  /// `half`: a power of two, at least 1.
  explicit EnclosingViewport(float half) : half_(half), inverse_(1.0F / half) {}

  float half() const { return half_; }
  float ndc(float window) const { return window * inverse_; }

  /// Whether `window` survives the way to the driver and through its transform bit for bit. What fails is out of range,
  /// NaN, or so small that ndc is subnormal, which drivers flush to zero.
  bool carries(float window) const {
    constexpr float kCentre = 0.0F;
    const float n = ndc(window);
    const float rounded_once = std::fma(n, half_, kCentre);
    const float product = n * half_;
    return std::abs(n) <= 1.0F && rounded_once == window && product + kCentre == window &&
           (window == 0.0F || std::abs(n) >= std::numeric_limits<float>::min());
  }
  bool carries(const Position& p) const { return carries(p.x) && carries(p.y); }

  /// Whether carries() holds of every vertex. Between the least normal ndc and 1 scaling by a power of two is exact,
  /// there and back.
  bool carries(std::span<const Triangle> triangles) const {
    return all_within(triangles, half_, std::numeric_limits<float>::min() * half_);
  }

 private:
  float half_;
  float inverse_;
};

}  // namespace edgecase::conformance
