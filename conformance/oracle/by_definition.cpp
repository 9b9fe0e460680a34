#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <utility>

#include "conformance/oracle/oracle.h"

namespace edgecase::conformance::oracle {
namespace {

// 2^24 px with 16 subpixel bits are 2^40 grid units; differences have 42 bits with sign, their products 84, sums 85.
__extension__ using Wide = __int128;

struct Point {
  Wide x = 0;
  Wide y = 0;
};

// A finite binary32 is mantissa * 2^exponent with an integer mantissa of at most 24 bits, so that times 2^bits it is an
// integer plus a fraction of -(exponent + bits) bits, and every rounding is a comparison of that fraction with one
// half.
std::int64_t snap_coordinate(const Rules& rules, float coordinate) {
  const auto pattern = std::bit_cast<std::uint32_t>(coordinate);
  const bool negative = (pattern >> 31) != 0;
  const int biased = static_cast<int>(pattern >> 23 & 0xff);
  const std::int64_t mantissa = (pattern & 0x7fffff) | (biased == 0 ? 0 : 0x800000);
  const int shift = std::max(biased, 1) - 150 + rules.subpixel_bits;
  assert(biased <= 127 + 24);

  if (shift >= 0) return (negative ? -mantissa : mantissa) * (std::int64_t{1} << shift);
  // 26 fraction bits already put the whole mantissa below one quarter: whatever lies below decides no rounding.
  const int fraction_bits = std::min(-shift, 26);
  const std::int64_t magnitude = mantissa >> fraction_bits;
  const std::int64_t fraction = mantissa & ((std::int64_t{1} << fraction_bits) - 1);
  const std::int64_t half = std::int64_t{1} << (fraction_bits - 1);

  bool away = false;  // from zero, to magnitude + 1
  switch (rules.rounding) {
    case SnapRounding::nearest_even:
      away = fraction > half || (fraction == half && magnitude % 2 != 0);
      break;
    case SnapRounding::half_up:
      away = fraction > half || (fraction == half && !negative);
      break;
    case SnapRounding::half_away:
      away = fraction >= half;
      break;
    case SnapRounding::truncate:
      break;
  }
  const std::int64_t rounded = magnitude + (away ? 1 : 0);
  return negative ? -rounded : rounded;
}

// Everything below is in units of 1/2^bits px, bits being fine enough for the vertices and the sample locations both.
int common_bits(const Rules& rules) { return std::max(rules.subpixel_bits, kSampleGridBits); }

Point sample_point(const Rules& rules, const SampleLocation& location, int x, int y) {
  const int bits = common_bits(rules);
  const int sample_shift = bits - kSampleGridBits;
  return {(Wide{x} << bits) + (Wide{location.x} << sample_shift),
          (Wide{y} << bits) + (Wide{location.y} << sample_shift)};
}

struct Edge {
  int from = 0;
  int to = 0;
  Point start;
  Wide dx = 0;
  Wide dy = 0;

  // Positive on the right-hand side of start -> end as seen on the screen (y down).
  Wide at(const Point& p) const { return dx * (p.y - start.y) - dy * (p.x - start.x); }
  // With the inside on its right, a horizontal edge above the triangle runs to the right, a left edge upwards.
  bool is_top() const { return dy == 0 && dx > 0; }
  bool is_left() const { return dy < 0; }
  bool accepts(Wide value) const { return value > 0 || (value == 0 && (is_top() || is_left())); }
};

// The triangle's edges in an order that has the inside on their right.
struct Outline {
  std::array<GridPoint, 3> snapped;
  std::array<Point, 3> vertices;
  std::array<Edge, 3> edges;
  bool degenerate = false;
  bool clockwise = false;

  Outline(const Rules& rules, const Triangle& triangle) {
    const int shift = common_bits(rules) - rules.subpixel_bits;
    for (std::size_t i = 0; i < 3; ++i) {
      snapped[i] = snap(rules, triangle[i]);
      vertices[i] = {Wide{snapped[i].x} << shift, Wide{snapped[i].y} << shift};
    }
    const Wide area = edge(0, 1).at(vertices[2]);
    degenerate = area == 0;
    clockwise = area > 0;
    edges = area >= 0 ? std::array{edge(0, 1), edge(1, 2), edge(2, 0)} : std::array{edge(0, 2), edge(2, 1), edge(1, 0)};
  }

  Edge edge(int from, int to) const {
    const Point& a = vertices[static_cast<std::size_t>(from)];
    const Point& b = vertices[static_cast<std::size_t>(to)];
    return {from, to, a, b.x - a.x, b.y - a.y};
  }

  bool covers(const Point& p) const {
    return !degenerate && std::all_of(edges.begin(), edges.end(), [&](const Edge& e) { return e.accepts(e.at(p)); });
  }
};

std::string decimal(Wide value) {
  if (value == 0) return "0";
  const bool negative = value < 0;
  std::string digits;
  for (; value != 0; value /= 10) {
    const int digit = static_cast<int>(value % 10);
    digits.push_back(static_cast<char>('0' + (digit < 0 ? -digit : digit)));
  }
  if (negative) digits.push_back('-');
  std::reverse(digits.begin(), digits.end());
  return digits;
}

// The pixels of one axis, clamped to the target, that the closed interval [low, high] touches. A triangle lies inside
// its closed bounding box, so every sample in other pixels is outside.
std::pair<int, int> touched_pixels(Wide low, Wide high, int bits, int extent) {
  const Wide first = std::max<Wide>(low >> bits, 0);
  const Wide last = std::min<Wide>(high >> bits, extent - 1);
  if (first > last) return {0, 0};
  return {static_cast<int>(first), static_cast<int>(last) + 1};
}

// By definition again: the scissor is asked pixel by pixel.
bool scissor_holds(const Setting& setting, int x, int y) {
  if (!setting.scissor) return true;
  const Rect& r = *setting.scissor;
  return x >= r.x && x < std::int64_t{r.x} + r.width && y >= r.y && y < std::int64_t{r.y} + r.height;
}

// By definition, too: the front is whichever winding the setting calls so.
bool is_culled(const Setting& setting, const Outline& outline) {
  const bool front = outline.clockwise == (setting.front_face == FrontFace::clockwise);
  return setting.cull != CullMode::none && front == (setting.cull == CullMode::front);
}

}  // namespace

GridPoint snap(const Rules& rules, const Position& position) {
  if (!rules.half_pixel_first) return {snap_coordinate(rules, position.x), snap_coordinate(rules, position.y)};
  const std::int64_t half = (std::int64_t{1} << rules.subpixel_bits) / 2;
  return {snap_coordinate(rules, position.x - 0.5f) + half, snap_coordinate(rules, position.y - 0.5f) + half};
}

void cover_by_definition(const Setting& setting, const Rules& rules, const Triangle& triangle, MutableMaskView mask) {
  std::fill(mask.begin(), mask.end(), 0);
  const MaskLayout layout(setting);
  const Outline outline(rules, triangle);
  if (is_culled(setting, outline)) return;
  const auto [left, right] = std::minmax({outline.vertices[0].x, outline.vertices[1].x, outline.vertices[2].x});
  const auto [top, bottom] = std::minmax({outline.vertices[0].y, outline.vertices[1].y, outline.vertices[2].y});
  const auto [x_begin, x_end] = touched_pixels(left, right, common_bits(rules), setting.target.width);
  const auto [y_begin, y_end] = touched_pixels(top, bottom, common_bits(rules), setting.target.height);

  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; ++x) {
      if (!scissor_holds(setting, x, y)) continue;
      for (int s = 0; s < setting.samples(); ++s) {
        const SampleLocation& location = setting.sample_locations[static_cast<std::size_t>(s)];
        if (outline.covers(sample_point(rules, location, x, y))) cover(mask, layout.bit(x, y, s));
      }
    }
  }
}

Explanation explain(const Setting& setting, const Rules& rules, const Triangle& triangle, int x, int y, int sample) {
  const Outline outline(rules, triangle);
  const Point p = sample_point(rules, setting.sample_locations[static_cast<std::size_t>(sample)], x, y);
  Explanation result;
  result.subpixel_bits = rules.subpixel_bits;
  result.snapped = outline.snapped;
  result.scale = std::int64_t{1} << common_bits(rules);
  result.degenerate = outline.degenerate;
  result.culled = !outline.degenerate && is_culled(setting, outline);
  for (std::size_t i = 0; i < 3; ++i) {
    const Edge& edge = outline.edges[i];
    result.edges[i] = {edge.from, edge.to, decimal(edge.at(p)), edge.is_top(), edge.is_left()};
  }
  result.inside = !result.culled && scissor_holds(setting, x, y) && outline.covers(p);
  return result;
}

}  // namespace edgecase::conformance::oracle
