// The subpixel lattice over a target: generators think in its integers, so that every vertex they make survives
// snapping.
#pragma once

#include <cstdint>

#include "conformance/generators/random.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// A point in units of 2^-bits pixels.
struct LatticePoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
  friend bool operator==(const LatticePoint&, const LatticePoint&) = default;
};

/// Twice the signed area of a, b, c: positive if they run clockwise on the screen (y down).
inline std::int64_t orientation(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

class Lattice {
 public:
  /// `bits` at least 1, so that pixel centres are lattice points.
  Lattice(const Extent& target, int bits)
      : target_(target), bits_(bits), unit_(1.0f / static_cast<float>(std::int64_t{1} << bits)) {}

  const Extent& target() const { return target_; }
  float unit() const { return unit_; }  ///< in pixels
  std::int64_t pixel() const { return std::int64_t{1} << bits_; }
  std::int64_t half_pixel() const { return pixel() / 2; }
  std::int64_t width() const { return target_.width * pixel(); }
  std::int64_t height() const { return target_.height * pixel(); }

  /// Exact: lattice coordinates of generated points have at most 24 bits.
  Position position(const LatticePoint& p) const {
    return {static_cast<float>(p.x) * unit_, static_cast<float>(p.y) * unit_};
  }
  Triangle triangle(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) const {
    return {position(a), position(b), position(c)};
  }

  /// A point within `margin` lattice units of the target.
  LatticePoint anywhere(Random& random, std::int64_t margin) const {
    return {random.between(-margin, width() + margin), random.between(-margin, height() + margin)};
  }
  /// The nearest pixel corner, and the centre of the pixel, of the point p.
  LatticePoint to_corner(const LatticePoint& p) const {
    return {(p.x + half_pixel()) >> bits_ << bits_, (p.y + half_pixel()) >> bits_ << bits_};
  }
  LatticePoint to_centre(const LatticePoint& p) const {
    return {(p.x >> bits_ << bits_) + half_pixel(), (p.y >> bits_ << bits_) + half_pixel()};
  }

 private:
  Extent target_;
  int bits_;
  float unit_;
};

}  // namespace edgecase::conformance
