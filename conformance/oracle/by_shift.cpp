#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "conformance/oracle/oracle.h"

namespace edgecase::conformance::oracle {
namespace {

// 127 bits suffice: snapped coordinates are below 2^40 in units of 2^-16 px, slopes quotients of 2^41, a crossing has
// below 2^99 over 2^57. Should that be wrong, checked arithmetic throws; comparisons of rationals do not multiply.
using Integer = boost::multiprecision::checked_int128_t;
using Rational = boost::multiprecision::number<boost::multiprecision::rational_adaptor<Integer::backend_type>>;

struct RationalPoint {
  Rational x;
  Rational y;
};

Integer floor(const Rational& value) {
  const Integer& n = numerator(value);
  const Integer& d = denominator(value);  // positive
  Integer quotient = n / d;               // truncated
  if (n < 0 && quotient * d != n) --quotient;
  return quotient;
}

Integer ceil(const Rational& value) { return -floor(Rational(-value)); }

Rational exact(float value) {
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 24));
  exponent -= 24;
  return exponent >= 0 ? Rational(Integer(mantissa) << exponent) : Rational(Integer(mantissa), Integer(1) << -exponent);
}

// The multiple of 2^-subpixel_bits that the rules move `value` to.
Rational snapped(const Rules& rules, float value) {
  if (rules.half_pixel_first) {
    Rules plain = rules;
    plain.half_pixel_first = false;
    return snapped(plain, value - 0.5f) + Rational(1, 2);
  }
  const Integer scale = Integer(1) << rules.subpixel_bits;
  const Rational scaled = exact(value) * scale;
  if (denominator(scaled) == 1) return exact(value);
  const Integer below = floor(scaled);
  const Rational above_by = scaled - below;  // 0 <= above_by < 1
  const Rational half(1, 2);

  bool up = above_by > half;
  if (above_by == half) {
    switch (rules.rounding) {
      case SnapRounding::nearest_even:
        up = below % 2 != 0;
        break;
      case SnapRounding::half_up:
        up = true;
        break;
      case SnapRounding::half_away:
        up = scaled > 0;
        break;
      case SnapRounding::truncate:
        break;
    }
  }
  if (rules.rounding == SnapRounding::truncate) up = scaled < 0 && above_by != 0;
  return Rational(up ? Integer(below + 1) : below, scale);
}

// An edge that is not horizontal: the rows it crosses and where.
struct Slope {
  RationalPoint upper;
  Rational end;      // y of the lower end
  Rational inverse;  // dx / dy
  Rational at(const Rational& y) const { return upper.x + (y - upper.y) * inverse; }
};

// The pixels [begin, end) of one axis that may be covered.
struct Pixels {
  int begin;
  int end;
};

// Those of the target that the scissor, if there is one, leaves.
Pixels left_by_scissor(int extent, const std::optional<Rect>& scissor, int Rect::*start, int Rect::*size) {
  if (!scissor) return {0, extent};
  const Integer begin = (*scissor).*start;
  const Integer end = begin + (*scissor).*size;
  if (begin >= extent || end <= 0 || begin >= end) return {0, 0};
  return {begin < 0 ? 0 : static_cast<int>(begin), end > extent ? extent : static_cast<int>(end)};
}

// The sign that the enclosed area of a dropped triangle has: 1 if the setting drops what is clockwise on the screen, -1
// for counter-clockwise, 0 for neither.
int dropped_sign(const Setting& setting) {
  const int front = setting.front_face == FrontFace::clockwise ? 1 : -1;
  switch (setting.cull) {
    case CullMode::none:
      return 0;
    case CullMode::front:
      return front;
    case CullMode::back:
      return -front;
  }
  return 0;
}

// The sign of the enclosed area, 1 if clockwise on the screen: the sum over the edges of the trapezoids between edge
// and y axis, added where the edge goes down and taken away where it goes up.
int area_sign(const std::array<RationalPoint, 3>& points) {
  Rational area = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const RationalPoint& from = points[i];
    const RationalPoint& to = points[(i + 1) % 3];
    area += (from.x + to.x) * (to.y - from.y);
  }
  return area.sign();
}

// Those of them whose sample, `offset` into its pixel, lies in [low, high).
Pixels columns(const Rational& low, const Rational& high, const Rational& offset, const Pixels& within) {
  const auto clamped = [&](const Rational& bound) {
    const Integer column = ceil(Rational(bound - offset));
    if (column <= within.begin) return within.begin;
    return column >= within.end ? within.end : static_cast<int>(column);
  };
  return {clamped(low), clamped(high)};
}

}  // namespace

// The sample (x, y) moved by (e, e^2) lies in the row y + e^2. That row crosses an edge exactly if upper <= y < lower:
// at upper = y it has just entered it, at lower = y just left it, and horizontal edges it never meets. A triangle is
// convex, so it crosses none or two edges, at X1 <= X2 up to terms in e^2. As e outweighs every multiple of e^2, the
// moved sample is right of an edge crossing at X if x >= X, and left of it if x < X: the sample is covered if X1 <= x <
// X2.
void cover_by_shift(const Setting& setting, const Rules& rules, const Triangle& triangle, MutableMaskView mask) {
  std::fill(mask.begin(), mask.end(), 0);
  const MaskLayout layout(setting);

  std::array<RationalPoint, 3> points;
  for (std::size_t i = 0; i < 3; ++i) points[i] = {snapped(rules, triangle[i].x), snapped(rules, triangle[i].y)};
  if (const int dropped = dropped_sign(setting); dropped != 0 && area_sign(points) == dropped) return;

  std::vector<Slope> slopes;
  for (std::size_t i = 0; i < 3; ++i) {
    const RationalPoint* upper = &points[i];
    const RationalPoint* lower = &points[(i + 1) % 3];
    if (upper->y == lower->y) continue;
    if (upper->y > lower->y) std::swap(upper, lower);
    slopes.push_back({*upper, lower->y, (lower->x - upper->x) / (lower->y - upper->y)});
  }
  const Pixels across = left_by_scissor(setting.target.width, setting.scissor, &Rect::x, &Rect::width);
  const Pixels down = left_by_scissor(setting.target.height, setting.scissor, &Rect::y, &Rect::height);
  const auto [top, bottom] = std::minmax({points[0].y, points[1].y, points[2].y});

  for (int s = 0; s < setting.samples(); ++s) {
    const SampleLocation& location = setting.sample_locations[static_cast<std::size_t>(s)];
    const Rational offset_x(location.x, 1 << kSampleGridBits);
    const Rational offset_y(location.y, 1 << kSampleGridBits);
    const auto [row_begin, row_end] = columns(top, bottom, offset_y, down);
    for (int row = row_begin; row < row_end; ++row) {
      const Rational y = row + offset_y;
      std::array<Rational, 2> crossings;
      std::size_t found = 0;
      for (const Slope& slope : slopes) {
        if (slope.upper.y <= y && y < slope.end) crossings.at(found++) = slope.at(y);
      }
      if (crossings[1] < crossings[0]) std::swap(crossings[0], crossings[1]);
      const auto [begin, end] = columns(crossings[0], crossings[1], offset_x, across);
      for (int x = begin; x < end; ++x) cover(mask, layout.bit(x, row, s));
    }
  }
}

}  // namespace edgecase::conformance::oracle
