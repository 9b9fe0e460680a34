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

// Everything below is in sixteenths of a grid unit, which hold the grid, half a pixel and the sample locations all:
// below 2^44, slopes quotients of 2^45, the crossing of a row below 2^91 over 2^65. Should that be wrong, checked
// arithmetic throws.
using Integer = boost::multiprecision::checked_int128_t;

struct IntegerPoint {
  Integer x;
  Integer y;
};

// Smallest integer that is not below n / d, d being positive.
Integer ceil(const Integer& n, const Integer& d) {
  const Integer quotient = n / d;  // truncated
  return n > 0 && quotient * d != n ? Integer(quotient + 1) : quotient;
}

// The grid point that the rules move `value` to. In binary64 each step is exact, but for a distance from the grid point
// below that is rounded to 1 from less than 2^-53 under it, which decides what 1 does.
Integer snapped(const Rules& rules, float value) {
  constexpr int kUnit = 1 << kSampleGridBits;
  if (rules.half_pixel_first) {
    Rules plain = rules;
    plain.half_pixel_first = false;
    return snapped(plain, value - 0.5f) + (std::int64_t{kUnit} << rules.subpixel_bits) / 2;
  }
  const double scaled = std::ldexp(static_cast<double>(value), rules.subpixel_bits);
  const double below = std::floor(scaled);
  const double above_by = scaled - below;
  bool up = above_by > 0.5;
  if (above_by == 0.5) {
    switch (rules.rounding) {
      case SnapRounding::nearest_even:
        up = std::fmod(below, 2) != 0;
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
  return Integer(static_cast<std::int64_t>(below) + (up ? 1 : 0)) * kUnit;
}

// An edge that is not horizontal, from its upper end down. In row y it lies at x = upper.x + (y - upper.y) * dx / dy.
struct Slope {
  IntegerPoint upper;
  Integer end;  // y of the lower end
  Integer dx;
  Integer dy;  // positive
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
int area_sign(const std::array<IntegerPoint, 3>& points) {
  Integer area = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const IntegerPoint& from = points[i];
    const IntegerPoint& to = points[(i + 1) % 3];
    area += (from.x + to.x) * (to.y - from.y);
  }
  return area.sign();
}

// The first pixel of `within` whose sample, `offset` into its pixel, does not lie below n / d, or its end if there is
// none; d is positive and a pixel has 2^bits units.
int first_from(const Integer& n, const Integer& d, int offset, int bits, const Pixels& within) {
  const Integer pixel = ceil(n - offset * d, d << bits);
  if (pixel <= within.begin) return within.begin;
  return pixel >= within.end ? within.end : static_cast<int>(pixel);
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

  std::array<IntegerPoint, 3> points;
  for (std::size_t i = 0; i < 3; ++i) points[i] = {snapped(rules, triangle[i].x), snapped(rules, triangle[i].y)};
  if (const int dropped = dropped_sign(setting); dropped != 0 && area_sign(points) == dropped) return;

  std::vector<Slope> slopes;
  for (std::size_t i = 0; i < 3; ++i) {
    const IntegerPoint* upper = &points[i];
    const IntegerPoint* lower = &points[(i + 1) % 3];
    if (upper->y == lower->y) continue;
    if (upper->y > lower->y) std::swap(upper, lower);
    slopes.push_back({*upper, lower->y, lower->x - upper->x, lower->y - upper->y});
  }
  const Pixels across = left_by_scissor(setting.target.width, setting.scissor, &Rect::x, &Rect::width);
  const Pixels down = left_by_scissor(setting.target.height, setting.scissor, &Rect::y, &Rect::height);
  const auto [top, bottom] = std::minmax({points[0].y, points[1].y, points[2].y});
  const int bits = rules.subpixel_bits + kSampleGridBits;

  for (int s = 0; s < setting.samples(); ++s) {
    const SampleLocation& location = setting.sample_locations[static_cast<std::size_t>(s)];
    const int offset_x = location.x << rules.subpixel_bits;
    const int offset_y = location.y << rules.subpixel_bits;
    const int row_begin = first_from(top, 1, offset_y, bits, down);
    const int row_end = first_from(bottom, 1, offset_y, bits, down);
    for (int row = row_begin; row < row_end; ++row) {
      const Integer y = (Integer(row) << bits) + offset_y;
      // The columns that the crossings begin are in the order in which the crossings are.
      std::array<int, 2> columns{};
      std::size_t found = 0;
      for (const Slope& slope : slopes) {
        if (y < slope.upper.y || slope.end <= y) continue;
        const Integer crossing = slope.upper.x * slope.dy + (y - slope.upper.y) * slope.dx;  // over dy
        columns.at(found++) = first_from(crossing, slope.dy, offset_x, bits, across);
      }
      const auto [begin, end] = std::minmax(columns[0], columns[1]);
      for (int x = begin; x < end; ++x) cover(mask, layout.bit(x, row, s));
    }
  }
}

}  // namespace edgecase::conformance::oracle
