#include <bit>

#include "conformance/oracle/allowed.h"
#include "conformance/oracle/definition.h"
#include "conformance/oracle/oracle.h"

namespace edgecase::conformance::oracle {
namespace {

using namespace definition;

// With f = fraction / 2^fraction_bits, the grid points are f and 1 - f away. No f is 0.4 or 0.6: both are no binary
// fractions.
std::vector<std::int64_t> choices(const Rules& rules, const RuleSet& rule_set, float coordinate) {
  const Split split(coordinate, rules.subpixel_bits);
  const std::int64_t one = std::int64_t{1} << split.fraction_bits;
  const bool any = rule_set.snap == SnapFreedom::neighbour;
  std::vector<std::int64_t> result;
  if (split.fraction == 0 || any || 5 * split.fraction < 3 * one) result.push_back(split.with_sign(split.whole));
  if (split.fraction != 0 && (any || 5 * split.fraction > 2 * one)) {
    result.push_back(split.with_sign(split.whole + 1));
  }
  return result;
}

// Every way to snap the three vertices.
std::vector<Outline> outlines(const Rules& rules, const RuleSet& rule_set, const Triangle& t) {
  std::vector<Outline> result;
  for (const GridPoint& a : snap_choices(rules, rule_set, t[0])) {
    for (const GridPoint& b : snap_choices(rules, rule_set, t[1])) {
      if (t[1] == t[0] && b != a) continue;
      for (const GridPoint& c : snap_choices(rules, rule_set, t[2])) {
        if ((t[2] == t[0] && c != a) || (t[2] == t[1] && c != b)) continue;
        result.emplace_back(rules, std::array{a, b, c});
      }
    }
  }
  return result;
}

}  // namespace

std::vector<GridPoint> snap_choices(const Rules& rules, const RuleSet& rule_set, const Position& position) {
  if (rule_set.snap == SnapFreedom::none) return {snap(rules, position)};
  std::vector<GridPoint> result;
  for (const std::int64_t x : choices(rules, rule_set, position.x)) {
    for (const std::int64_t y : choices(rules, rule_set, position.y)) result.push_back({x, y});
  }
  return result;
}

void allow_by_definition(const Setting& setting, const Rules& rules, const RuleSet& rule_set, const Triangle& triangle,
                         MaskView asked, MutableMaskView must, MutableMaskView may) {
  std::fill(must.begin(), must.end(), 0);
  std::fill(may.begin(), may.end(), 0);
  const MaskLayout layout(setting);
  const std::vector<Outline> all = outlines(rules, rule_set, triangle);
  const bool open_edges = rule_set.on_edge != OnEdge::top_left;
  const bool faces_one_way = std::all_of(all.begin(), all.end(), [&](const Outline& outline) {
    return !outline.degenerate && outline.clockwise == all.front().clockwise;
  });
  const bool open_facing = setting.cull != CullMode::none && !rule_set.facing_is_snapped && !faces_one_way;

  const auto row_bits = static_cast<int>(layout.row_words() * 64);
  for (std::size_t word = 0; word < asked.size(); ++word) {
    for (std::uint64_t left = asked[word]; left != 0; left &= left - 1) {
      const std::size_t bit = word * 64 + static_cast<std::size_t>(std::countr_zero(left));
      const int y = static_cast<int>(bit) / row_bits;
      const int in_row = static_cast<int>(bit) % row_bits;
      const int x = in_row / layout.samples;
      if (!scissor_holds(setting, x, y)) continue;
      const SampleLocation& location = setting.sample_locations[static_cast<std::size_t>(in_row % layout.samples)];
      const Point p = sample_point(rules, location, x, y);
      bool by_all = true;
      bool by_any = false;
      for (const Outline& outline : all) {
        const bool drawn = open_facing || !is_culled(setting, outline);
        by_all = by_all && !open_facing && drawn && (open_edges ? outline.strictly_holds(p) : outline.covers(p));
        by_any = by_any || (drawn && (open_edges ? outline.reaches(p) : outline.covers(p)));
      }
      if (by_all) cover(must, bit);
      if (by_any && !by_all) cover(may, bit);
    }
  }
}

}  // namespace edgecase::conformance::oracle
