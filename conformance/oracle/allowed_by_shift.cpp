#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "conformance/oracle/allowed.h"
#include "conformance/oracle/oracle.h"

namespace edgecase::conformance::oracle {
namespace {

// Products of two differences of coordinates in sixteenths of a grid unit, each below 2^45 + 2.
using Wide = boost::multiprecision::checked_int128_t;

// The window coordinates on the grid that `value` may go to. Between two grid points a binary32 number has bits below
// the grid's, so that both, having fewer, are binary32 numbers too; in binary64 each step is exact, but for a distance
// that is rounded to 1 from less than 2^-53 below it.
std::vector<float> choices(const Rules& rules, const RuleSet& rule_set, float value) {
  const double scale = std::ldexp(1.0, rules.subpixel_bits);
  const double scaled = static_cast<double>(value) * scale;
  const double below = std::floor(scaled);
  if (below == scaled) return {value};
  std::vector<float> result;
  for (const double grid : {below, below + 1}) {
    const bool legal = rule_set.snap == SnapFreedom::neighbour || std::abs(scaled - grid) * 5 < 3;
    if (legal) result.push_back(static_cast<float>(grid / scale));
  }
  return result;
}

std::vector<Position> choices(const Rules& rules, const RuleSet& rule_set, const Position& position) {
  std::vector<Position> result;
  for (const float x : choices(rules, rule_set, position.x)) {
    for (const float y : choices(rules, rule_set, position.y)) result.push_back({x, y});
  }
  return result;
}

// Every triangle on the grid that `t` may become; with nothing left open, itself.
std::vector<Triangle> snapped_triangles(const Rules& rules, const RuleSet& rule_set, const Triangle& t) {
  if (rule_set.snap == SnapFreedom::none) return {t};
  std::vector<Triangle> result;
  for (const Position& a : choices(rules, rule_set, t[0])) {
    for (const Position& b : choices(rules, rule_set, t[1])) {
      for (const Position& c : choices(rules, rule_set, t[2])) {
        const Triangle snapped{a, b, c};
        bool alike = true;
        for (std::size_t i = 0; i < 3; ++i)
          alike = alike && (t[i] != t[(i + 1) % 3] || snapped[i] == snapped[(i + 1) % 3]);
        if (alike) result.push_back(snapped);
      }
    }
  }
  return result;
}

// In sixteenths of a grid unit, which hold the grid and the sample locations both.
struct LinePoint {
  Wide x;
  Wide y;
};

std::array<LinePoint, 3> line_points(const Rules& rules, const Triangle& t) {
  const auto units = [&](float v) {
    return Wide(static_cast<std::int64_t>(std::ldexp(static_cast<double>(v), rules.subpixel_bits + kSampleGridBits)));
  };
  return {{{units(t[0].x), units(t[0].y)}, {units(t[1].x), units(t[1].y)}, {units(t[2].x), units(t[2].y)}}};
}

// 1 if clockwise on the screen, 0 without area: by the slopes of two edges.
int turn(const std::array<LinePoint, 3>& v) {
  const Wide area = (v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[1].y - v[0].y) * (v[2].x - v[0].x);
  return area.sign();
}

// Whether p lies on the line segment from a to b: it is as far from a to p as from a to b times some t, 0 <= t <= 1.
bool on_segment(const LinePoint& p, const LinePoint& a, const LinePoint& b) {
  const auto between = [](const Wide& v, const Wide& from, const Wide& to) {
    return std::min(from, to) <= v && v <= std::max(from, to);
  };
  return between(p.x, a.x, b.x) && between(p.y, a.y, b.y) &&
         Wide((p.x - a.x) * (b.y - a.y)) == Wide((p.y - a.y) * (b.x - a.x));
}

// The samples that lie on an edge.
void find_border(const Setting& setting, const Rules& rules, const std::array<LinePoint, 3>& v, MaskView asked,
                 MutableMaskView mask) {
  std::fill(mask.begin(), mask.end(), 0);
  const MaskLayout layout(setting);
  const int bits = rules.subpixel_bits + kSampleGridBits;
  const Rect within = setting.scissor.value_or(Rect{0, 0, layout.target.width, layout.target.height});
  for (int y = within.y; y < within.y + within.height; ++y) {
    for (int x = within.x; x < within.x + within.width; ++x) {
      for (int s = 0; s < layout.samples; ++s) {
        if (!covered(asked, layout.bit(x, y, s))) continue;
        const SampleLocation& at = setting.sample_locations[static_cast<std::size_t>(s)];
        const LinePoint p{(Wide(x) << bits) + (Wide(at.x) << rules.subpixel_bits),
                          (Wide(y) << bits) + (Wide(at.y) << rules.subpixel_bits)};
        if (on_segment(p, v[0], v[1]) || on_segment(p, v[1], v[2]) || on_segment(p, v[2], v[0])) {
          cover(mask, layout.bit(x, y, s));
        }
      }
    }
  }
}

// The smallest rectangle of pixels that has all samples asked for and allowed by the setting's own scissor.
Rect asked_pixels(const Setting& setting, MaskView asked) {
  const MaskLayout layout(setting);
  const Rect scissor = setting.scissor.value_or(Rect{0, 0, layout.target.width, layout.target.height});
  int left = layout.target.width, top = layout.target.height, right = 0, bottom = 0;
  for (int y = 0; y < layout.target.height; ++y) {
    for (int x = 0; x < layout.target.width; ++x) {
      const bool left_in = x >= scissor.x && x < std::int64_t{scissor.x} + scissor.width && y >= scissor.y &&
                           y < std::int64_t{scissor.y} + scissor.height;
      bool any = false;
      for (int s = 0; left_in && s < layout.samples; ++s) any = any || covered(asked, layout.bit(x, y, s));
      if (!any) continue;
      left = std::min(left, x), right = std::max(right, x + 1);
      top = std::min(top, y), bottom = std::max(bottom, y + 1);
    }
  }
  return left < right ? Rect{left, top, right - left, bottom - top} : Rect{};
}

}  // namespace

void allow_by_shift(const Setting& setting, const Rules& rules, const RuleSet& rule_set, const Triangle& triangle,
                    MaskView asked, MutableMaskView must, MutableMaskView may) {
  std::fill(must.begin(), must.end(), 0);
  std::fill(may.begin(), may.end(), 0);
  Setting drawn = setting;  // the cover of every choice where anything is asked
  drawn.scissor = asked_pixels(setting, asked);
  drawn.cull = CullMode::none;
  if (drawn.scissor->width == 0) return;

  const std::vector<Triangle> triangles = snapped_triangles(rules, rule_set, triangle);
  std::vector<int> turns;
  for (const Triangle& t : triangles) turns.push_back(turn(line_points(rules, t)));
  const int front = setting.front_face == FrontFace::clockwise ? 1 : -1;
  const int dropped = setting.cull == CullMode::none ? 0 : setting.cull == CullMode::front ? front : -front;
  const bool differ = turns.front() == 0 || std::ranges::adjacent_find(turns, std::not_equal_to<>()) != turns.end();
  const bool open_facing = dropped != 0 && !rule_set.facing_is_snapped && differ;

  // By all choices: none may leave it out. By any: one may cover it.
  const std::size_t words = asked.size();
  std::vector<std::uint64_t> inside(words), border(words), by_all(asked.begin(), asked.end()), by_any(words);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const bool culled = !open_facing && dropped != 0 && turns[i] == dropped;
    std::ranges::fill(inside, 0);
    std::ranges::fill(border, 0);
    if (!culled) cover_by_shift(drawn, rules, triangles[i], inside);
    if (!culled && rule_set.on_edge != OnEdge::top_left) {
      find_border(drawn, rules, line_points(rules, triangles[i]), asked, border);
    }
    for (std::size_t w = 0; w < words; ++w) {
      by_all[w] &= open_facing ? 0 : inside[w] & ~border[w];
      by_any[w] |= (inside[w] | border[w]) & asked[w];
    }
  }
  for (std::size_t w = 0; w < words; ++w) {
    must[w] = by_all[w];
    may[w] = by_any[w] & ~by_all[w];
  }
}

}  // namespace edgecase::conformance::oracle
