// What the rule sets allow: two methods and brute force agree, and the numbers of each specification hold.
#include "conformance/oracle/allowed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "conformance/oracle/oracle.h"
#include "conformance/scene/standard_samples.h"

namespace edgecase::conformance {
namespace {

using Masks = std::vector<std::uint64_t>;

struct Allowed {
  Masks must;
  Masks may;
  friend bool operator==(const Allowed&, const Allowed&) = default;
};

Masks everything(const Setting& setting) {
  const MaskLayout layout(setting);
  Masks all(layout.words());
  for (int y = 0; y < layout.target.height; ++y) {
    for (int x = 0; x < layout.target.width; ++x) {
      for (int s = 0; s < layout.samples; ++s) cover(all, layout.bit(x, y, s));
    }
  }
  return all;
}

using Method = decltype(&oracle::allow_by_definition);

Allowed by(Method method, const Setting& setting, const Rules& rules, const RuleSet& set, const Triangle& t) {
  const Masks asked = everything(setting);
  Allowed result{Masks(asked.size(), ~std::uint64_t{0}), Masks(asked.size(), ~std::uint64_t{0})};
  method(setting, rules, set, t, asked, result.must, result.may);
  return result;
}

// ---- Brute force, in 64-bit integers: every triple of grid points near the vertices that the set allows, and for each
// of them the sample, and the sample moved a very little in each of many directions.

struct Point {
  std::int64_t x = 0;
  std::int64_t y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

// A grid unit is so many steps, a step being what samples are moved by: smaller than any distance between a sample and
// an edge that does not pass through it, on the small targets used here.
constexpr std::int64_t kSteps = std::int64_t{1} << 16;

bool legal(const RuleSet& set, double scaled, double grid) {
  const double distance = std::abs(scaled - grid);
  if (set.snap == SnapFreedom::near_tie) return distance < 0.6;
  return std::floor(scaled) == scaled ? distance == 0 : distance < 1;
}

std::vector<Point> legal_points(const Rules& rules, const RuleSet& set, const Position& p) {
  const double scale = std::ldexp(1.0, rules.subpixel_bits);
  std::vector<Point> result;
  for (double x = std::floor(p.x * scale) - 1; x <= p.x * scale + 2; ++x) {
    for (double y = std::floor(p.y * scale) - 1; y <= p.y * scale + 2; ++y) {
      if (legal(set, p.x * scale, x) && legal(set, p.y * scale, y)) {
        result.push_back({static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)});
      }
    }
  }
  return result;
}

__extension__ using Wide = __int128;

// 1 if p is on the right of a -> b, with y down.
int side(const Point& a, const Point& b, const Point& p) {
  const Wide value = Wide{b.x - a.x} * (p.y - a.y) - Wide{b.y - a.y} * (p.x - a.x);
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

bool on_segment(const Point& a, const Point& b, const Point& p) {
  return side(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

struct Sample {
  bool for_certain = false;
  bool possibly = false;
};

// With open edges, what a choice covers is what some rule might: in for certain if the sample is in wherever it is
// moved, out for certain if it is out wherever and on no edge.
Sample covered_for(const RuleSet& set, const std::array<Point, 3>& t, const Point& p) {
  const auto in = [&](const Point& q) {
    const int turn = side(t[0], t[1], t[2]);
    return turn != 0 && side(t[0], t[1], q) == turn && side(t[1], t[2], q) == turn && side(t[2], t[0], q) == turn;
  };
  if (set.on_edge == OnEdge::top_left) {
    const bool moved = in({p.x + 2 * kSteps / 3, p.y + 1});
    return {moved, moved};
  }
  const bool on_edge = on_segment(t[0], t[1], p) || on_segment(t[1], t[2], p) || on_segment(t[2], t[0], p);
  bool wherever = true;
  for (std::int64_t x = -1; x <= 1; ++x) {
    for (std::int64_t y = -1; y <= 1; ++y) wherever = wherever && in({p.x + x, p.y + y});
  }
  return {wherever, wherever || on_edge || in(p)};
}

Allowed by_force(const Setting& setting, const Rules& rules, const RuleSet& set, const Triangle& triangle) {
  const MaskLayout layout(setting);
  const std::int64_t unit = kSteps * kSteps;
  std::vector<std::array<Point, 3>> choices;
  for (const Point& a : legal_points(rules, set, triangle[0])) {
    for (const Point& b : legal_points(rules, set, triangle[1])) {
      for (const Point& c : legal_points(rules, set, triangle[2])) {
        if ((triangle[0] == triangle[1] && a != b) || (triangle[1] == triangle[2] && b != c) ||
            (triangle[2] == triangle[0] && c != a)) {
          continue;
        }
        choices.push_back({{{a.x * unit, a.y * unit}, {b.x * unit, b.y * unit}, {c.x * unit, c.y * unit}}});
      }
    }
  }
  const auto turn = [](const std::array<Point, 3>& t) { return side(t[0], t[1], t[2]); };
  const int front = setting.front_face == FrontFace::clockwise ? 1 : -1;
  const int dropped = setting.cull == CullMode::none ? 2 : setting.cull == CullMode::front ? front : -front;
  const bool agree =
      turn(choices[0]) != 0 && std::ranges::all_of(choices, [&](const auto& t) { return turn(t) == turn(choices[0]); });
  const bool open_facing = dropped != 2 && !set.facing_is_snapped && !agree;

  Allowed result{Masks(layout.words()), Masks(layout.words())};
  for (int y = 0; y < layout.target.height; ++y) {
    for (int x = 0; x < layout.target.width; ++x) {
      for (int s = 0; s < layout.samples; ++s) {
        const SampleLocation& at = setting.sample_locations[static_cast<std::size_t>(s)];
        const std::int64_t sixteenth = (unit << rules.subpixel_bits) / 16;
        const Point p{(16 * x + at.x) * sixteenth, (16 * y + at.y) * sixteenth};
        bool all = !open_facing;
        bool any = false;
        for (const auto& t : choices) {
          const bool drawn = open_facing || turn(t) != dropped;
          const Sample sample = covered_for(set, t, p);
          all = all && drawn && sample.for_certain;
          any = any || (drawn && sample.possibly);
        }
        if (all) cover(result.must, layout.bit(x, y, s));
        if (any && !all) cover(result.may, layout.bit(x, y, s));
      }
    }
  }
  return result;
}

// ---- Triangles of all kinds: on the grid, through samples, on ties, beside ties, off the grid, slivers, points.

class Triangles {
 public:
  explicit Triangles(int bits, unsigned seed) : unit_(std::ldexp(1.0F, -bits)), random_(seed) {}

  Triangle next() {
    const int kind = between(0, 5);
    Triangle t{position(kind), position(kind), position(kind)};
    if (between(0, 9) == 0) t[1] = t[0];
    if (between(0, 9) == 0) t[2] = {t[0].x + unit_ * static_cast<float>(between(-1, 1)), t[1].y};
    return t;
  }

 private:
  int between(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }

  float coordinate(int kind) {
    const float eighth = static_cast<float>(between(-16, 48)) / 8;
    const float grid = eighth + unit_ * static_cast<float>(between(-1, 1));
    switch (kind) {
      case 0:
        return eighth;
      case 1:
        return grid;
      case 2:
        return grid + unit_ / 2;
      case 3:
        return grid + unit_ * (0.5F + 0.01F * static_cast<float>(between(-15, 15)));
      default:
        return std::uniform_real_distribution<float>(-2, 6)(random_);
    }
  }
  Position position(int kind) {
    if (kind == 5) kind = between(0, 4);
    return {coordinate(kind), coordinate(kind)};
  }

  float unit_;
  std::mt19937 random_;
};

Setting setting_of(int samples, CullMode cull) {
  Setting setting;
  setting.target = {4, 4};
  const auto locations = standard_sample_locations(samples);
  setting.sample_locations.assign(locations.begin(), locations.end());
  setting.cull = cull;
  return setting;
}

std::string named(const RuleSet& set, const Triangle& t) {
  std::string text(set.name);
  for (const Position& p : t) text += " (" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")";
  return text;
}

TEST(Allowed, MethodsAndBruteForceAgree) {
  std::size_t open = 0;
  for (const int bits : {4, 8}) {
    for (const int samples : {1, 4}) {
      for (const CullMode cull : {CullMode::none, CullMode::back}) {
        const Setting setting = setting_of(samples, cull);
        const Rules rules{bits};
        Triangles triangles(bits, 1);
        for (int i = 0; i < 60; ++i) {
          const Triangle t = triangles.next();
          for (const RuleSet& set : kRuleSets) {
            const Allowed allowed = by(oracle::allow_by_definition, setting, rules, set, t);
            ASSERT_EQ(allowed, by(oracle::allow_by_shift, setting, rules, set, t)) << named(set, t);
            if (set.exact()) continue;
            ASSERT_EQ(allowed, by_force(setting, rules, set, t)) << named(set, t);
            open += std::ranges::count_if(allowed.may, [](std::uint64_t word) { return word != 0; });
          }
        }
      }
    }
  }
  EXPECT_GT(open, 300U);
}

TEST(Allowed, ExactIsWhatTheOracleCovers) {
  for (const CullMode cull : {CullMode::none, CullMode::front}) {
    const Setting setting = setting_of(4, cull);
    for (const Rules& rules : {Rules{8}, Rules{4, SnapRounding::truncate}, Rules{8, SnapRounding::half_up, true}}) {
      Triangles triangles(rules.subpixel_bits, 2);
      for (int i = 0; i < 200; ++i) {
        const Triangle t = triangles.next();
        Masks covered(MaskLayout(setting).words());
        oracle::cover_by_definition(setting, rules, t, covered);
        const Allowed expected{covered, Masks(covered.size())};
        EXPECT_EQ(by(oracle::allow_by_definition, setting, rules, kExactRules, t), expected);
        EXPECT_EQ(by(oracle::allow_by_shift, setting, rules, kExactRules, t), expected);
      }
    }
  }
}

// Every set allows what snapping to nearest even and the top-left rule cover.
TEST(Allowed, NearestEvenAndTopLeftAreLegalEverywhere) {
  for (const CullMode cull : {CullMode::none, CullMode::front, CullMode::back}) {
    const Setting setting = setting_of(1, cull);
    Triangles triangles(8, 3);
    for (int i = 0; i < 500; ++i) {
      const Triangle t = triangles.next();
      Masks covered(MaskLayout(setting).words());
      oracle::cover_by_definition(setting, Rules{8}, t, covered);
      for (const RuleSet& set : kRuleSets) {
        const Allowed allowed = by(oracle::allow_by_definition, setting, Rules{8}, set, t);
        for (std::size_t w = 0; w < covered.size(); ++w) {
          EXPECT_EQ(allowed.must[w] & ~covered[w], 0U) << named(set, t);
          EXPECT_EQ(covered[w] & ~(allowed.must[w] | allowed.may[w]), 0U) << named(set, t);
        }
      }
    }
  }
}

std::vector<GridPoint> choices(const char* set, float x) {
  return oracle::snap_choices(Rules{8}, *find_rule_set(set), {x / 256, 0});
}

// D3D11.3 3.2.4.1: 0.6 units, so that two results are legal within 0.1 unit of a tie.
TEST(Allowed, Direct3dLeavesATenthOfAUnitOnEitherSideOfATie) {
  EXPECT_EQ(choices("d3d11", 7.5F), (std::vector<GridPoint>{{7, 0}, {8, 0}}));
  EXPECT_EQ(choices("d3d11", 7.40001F), (std::vector<GridPoint>{{7, 0}, {8, 0}}));
  EXPECT_EQ(choices("d3d11", 7.39999F), (std::vector<GridPoint>{{7, 0}}));
  EXPECT_EQ(choices("d3d11", 7.59999F), (std::vector<GridPoint>{{7, 0}, {8, 0}}));
  EXPECT_EQ(choices("d3d11", 7.60001F), (std::vector<GridPoint>{{8, 0}}));
  EXPECT_EQ(choices("d3d11", -7.60001F), (std::vector<GridPoint>{{-8, 0}}));
  EXPECT_EQ(choices("d3d11", 7), (std::vector<GridPoint>{{7, 0}}));
}

TEST(Allowed, VulkanLeavesEitherNeighbour) {
  EXPECT_EQ(choices("vulkan", 7.001F), (std::vector<GridPoint>{{7, 0}, {8, 0}}));
  EXPECT_EQ(choices("vulkan", -0x1p-140F), (std::vector<GridPoint>{{0, 0}, {-1, 0}}));
  EXPECT_EQ(choices("vulkan", 7), (std::vector<GridPoint>{{7, 0}}));
}

// Equal positions go to the same point: a triangle with two of them has no area, whatever is chosen.
TEST(Allowed, EqualPositionsAreSnappedAlike) {
  const Position p{1.5F + 0.5F / 256, 0.25F / 256};
  const Triangle t{p, p, {1.5F, 3.5F}};
  const Setting setting = setting_of(1, CullMode::none);
  const Allowed d3d = by(oracle::allow_by_definition, setting, Rules{8}, *find_rule_set("d3d11"), t);
  EXPECT_EQ(d3d, (Allowed{Masks(4), Masks(4)}));
}

// (0.5, 0.5) lies on the edge, (1.5, 0.5) inside.
TEST(Allowed, SamplesOnEdgesAreOpen) {
  const Triangle t{{{0.5F, 0}, {3, 0}, {0.5F, 2.5F}}};
  const Setting setting = setting_of(1, CullMode::none);
  for (const char* set : {"vulkan", "opengl", "webgpu"}) {
    const Allowed allowed = by(oracle::allow_by_definition, setting, Rules{8}, *find_rule_set(set), t);
    EXPECT_EQ(allowed.must[0], 0b0010U);
    EXPECT_EQ(allowed.may[0], 0b0001U | 0b0100U) << "(2.5, 0.5) lies on the slanted edge";
  }
  const Allowed d3d = by(oracle::allow_by_definition, setting, Rules{8}, *find_rule_set("d3d11"), t);
  EXPECT_EQ(d3d.must[0], 0b0011U);
  EXPECT_EQ(d3d.may[0], 0U);
}

TEST(RuleSets, AreFoundByName) {
  EXPECT_EQ(find_rule_set("opengl")->name, "opengl");
  EXPECT_EQ(find_rule_set("metal"), nullptr);
  EXPECT_TRUE(kExactRules.exact());
}

}  // namespace
}  // namespace edgecase::conformance
