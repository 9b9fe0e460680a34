#include "conformance/oracle/definition.h"

#include <utility>

#include "conformance/oracle/oracle.h"

namespace edgecase::conformance::oracle {
namespace {

using namespace definition;

std::int64_t snap_coordinate(const Rules& rules, float coordinate) {
  const Split split(coordinate, rules.subpixel_bits);
  if (split.fraction == 0) return split.with_sign(split.whole);
  const std::int64_t half = std::int64_t{1} << (split.fraction_bits - 1);
  bool away = false;  // from zero, to whole + 1
  switch (rules.rounding) {
    case SnapRounding::nearest_even:
      away = split.fraction > half || (split.fraction == half && split.whole % 2 != 0);
      break;
    case SnapRounding::half_up:
      away = split.fraction > half || (split.fraction == half && !split.negative);
      break;
    case SnapRounding::half_away:
      away = split.fraction >= half;
      break;
    case SnapRounding::truncate:
      break;
  }
  return split.with_sign(split.whole + (away ? 1 : 0));
}

std::array<GridPoint, 3> snapped_vertices(const Rules& rules, const Triangle& triangle) {
  return {snap(rules, triangle[0]), snap(rules, triangle[1]), snap(rules, triangle[2])};
}

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
template <typename Number>
std::pair<int, int> touched_pixels(Number low, Number high, int bits, int extent) {
  const Number first = std::max<Number>(low >> bits, 0);
  const Number last = std::min<Number>(high >> bits, extent - 1);
  if (first > last) return {0, 0};
  return {static_cast<int>(first), static_cast<int>(last) + 1};
}

// Whether every vertex, and every sample of the target, lies within kNarrowReach.
bool is_narrow(const Setting& setting, const Rules& rules, const std::array<GridPoint, 3>& vertices) {
  const std::int64_t reach = kNarrowReach >> (common_bits(rules) - rules.subpixel_bits);
  const auto within = [&](std::int64_t v) { return -reach < v && v < reach; };
  return std::int64_t{std::max(setting.target.width, setting.target.height)} << common_bits(rules) < kNarrowReach &&
         std::all_of(vertices.begin(), vertices.end(), [&](const GridPoint& p) { return within(p.x) && within(p.y); });
}

template <typename Number>
void cover_outline(const Setting& setting, const Rules& rules, const OutlineIn<Number>& outline, MutableMaskView mask) {
  if (is_culled(setting, outline)) return;
  const MaskLayout layout(setting);
  const auto [left, right] = std::minmax({outline.vertices[0].x, outline.vertices[1].x, outline.vertices[2].x});
  const auto [top, bottom] = std::minmax({outline.vertices[0].y, outline.vertices[1].y, outline.vertices[2].y});
  const auto [x_begin, x_end] = touched_pixels(left, right, common_bits(rules), setting.target.width);
  const auto [y_begin, y_end] = touched_pixels(top, bottom, common_bits(rules), setting.target.height);

  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; ++x) {
      if (!scissor_holds(setting, x, y)) continue;
      for (int s = 0; s < setting.samples(); ++s) {
        const SampleLocation& location = setting.sample_locations[static_cast<std::size_t>(s)];
        if (outline.covers(sample_point<Number>(rules, location, x, y))) cover(mask, layout.bit(x, y, s));
      }
    }
  }
}

}  // namespace

GridPoint snap(const Rules& rules, const Position& position) {
  if (!rules.half_pixel_first) return {snap_coordinate(rules, position.x), snap_coordinate(rules, position.y)};
  const std::int64_t half = (std::int64_t{1} << rules.subpixel_bits) / 2;
  return {snap_coordinate(rules, position.x - 0.5f) + half, snap_coordinate(rules, position.y - 0.5f) + half};
}

void cover_by_definition(const Setting& setting, const Rules& rules, const Triangle& triangle, MutableMaskView mask) {
  std::fill(mask.begin(), mask.end(), 0);
  const std::array<GridPoint, 3> vertices = snapped_vertices(rules, triangle);
  if (is_narrow(setting, rules, vertices)) {
    cover_outline(setting, rules, OutlineIn<Narrow>(rules, vertices), mask);
  } else {
    cover_outline(setting, rules, OutlineIn<Wide>(rules, vertices), mask);
  }
}

Explanation explain(const Setting& setting, const Rules& rules, const Triangle& triangle, int x, int y, int sample) {
  const Outline outline(rules, snapped_vertices(rules, triangle));
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
