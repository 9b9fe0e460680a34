// The two oracles against hand-checked triangles, against each other, and by exhaustion.
#include "conformance/oracle/oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "conformance/generators/generator.h"

namespace edgecase::conformance {
namespace {

std::vector<std::string> rows(const Setting& setting, MaskView mask) {
  const MaskLayout layout(setting);
  std::vector<std::string> result;
  for (int y = 0; y < setting.target.height; ++y) {
    std::string row;
    for (int x = 0; x < setting.target.width; ++x) row.push_back(covered(mask, layout.bit(x, y, 0)) ? '#' : '.');
    result.push_back(row);
  }
  return result;
}

void expect_rows(const Triangle& triangle, const std::vector<std::string>& expected) {
  Setting setting;
  setting.target = {static_cast<int>(expected[0].size()), static_cast<int>(expected.size())};
  std::vector<std::uint64_t> mask(MaskLayout(setting).words(), ~std::uint64_t{0});
  oracle::cover_by_definition(setting, {}, triangle, mask);
  EXPECT_EQ(rows(setting, mask), expected) << "by definition";
  mask.assign(mask.size(), ~std::uint64_t{0});
  oracle::cover_by_shift(setting, {}, triangle, mask);
  EXPECT_EQ(rows(setting, mask), expected) << "by shift";
}

TEST(Oracle, LeftEdgeOnCentresIsInsideRightEdgeIsNot) {
  expect_rows({{{0.5f, 0}, {2.5f, 0}, {0.5f, 8}}}, {"##..", "##..", "##..", "##.."});
  expect_rows({{{2.5f, 0}, {0.5f, 0}, {2.5f, 8}}}, {".#..", ".#..", ".#..", ".#.."});
}

TEST(Oracle, TopEdgeOnCentresIsInsideBottomEdgeIsNot) {
  expect_rows({{{0, 1.5f}, {8, 1.5f}, {0, 9.5f}}}, {"....", "####", "####", "####"});
  expect_rows({{{0, 1.5f}, {8, 1.5f}, {0, -6.5f}}}, {"####", "....", "....", "...."});
}

TEST(Oracle, ACornerNeedsBothOfItsEdges) {
  // The sample (1.5, 1.5) is the corner where a top and a left edge meet, where a top and a right edge meet, ...
  expect_rows({{{1.5f, 1.5f}, {2.5f, 1.5f}, {1.5f, 2.5f}}}, {"...", ".#.", "..."});
  expect_rows({{{1.5f, 1.5f}, {0.5f, 1.5f}, {1.5f, 2.5f}}}, {"...", "#..", "..."});
  expect_rows({{{1.5f, 1.5f}, {0.5f, 1.5f}, {1.5f, 0.5f}}}, {"...", "...", "..."});
}

TEST(Oracle, ZeroAreaCoversNothing) {
  expect_rows({{{0.5f, 0.5f}, {2.5f, 2.5f}, {1.5f, 1.5f}}}, {"...", "...", "..."});
  expect_rows({{{1.5f, 1.5f}, {1.5f, 1.5f}, {1.5f, 1.5f}}}, {"...", "...", "..."});
  // An area that only snapping takes away: the third vertex is 1/1024 px off the line.
  expect_rows({{{0.5f, 0.5f}, {2.5f, 0.5f}, {1.5f, 0.5f + 1.f / 1024}}}, {"...", "...", "..."});
}

struct Rounded {
  float value;
  std::int64_t nearest_even, half_up, half_away, truncate;
};

TEST(Oracle, SnapsTiesAndTheirNeighboursAsEachRuleSays) {
  const float tiny = std::numeric_limits<float>::denorm_min();
  const float tie = 0.5f / 256;
  const Rounded table[] = {
      {0, 0, 0, 0, 0},
      {-0.f, 0, 0, 0, 0},
      {tiny, 0, 0, 0, 0},
      {-tiny, 0, 0, 0, 0},
      {tie, 0, 1, 1, 0},
      {-tie, 0, 0, -1, 0},
      {3 * tie, 2, 2, 2, 1},
      {-3 * tie, -2, -1, -2, -1},
      {5 * tie, 2, 3, 3, 2},
      {-5 * tie, -2, -2, -3, -2},
      {std::nextafter(tie, 0.f), 0, 0, 0, 0},
      {std::nextafter(tie, 1.f), 1, 1, 1, 0},
      {std::nextafter(-tie, 0.f), 0, 0, 0, 0},
      {std::nextafter(-tie, -1.f), -1, -1, -1, 0},
      {16383.99609375f, 4194303, 4194303, 4194303, 4194303},
      {-32768.f, -8388608, -8388608, -8388608, -8388608},
  };
  for (const Rounded& row : table) {
    SCOPED_TRACE(row.value);
    EXPECT_EQ(oracle::snap({8, SnapRounding::nearest_even}, {row.value, 0}).x, row.nearest_even);
    EXPECT_EQ(oracle::snap({8, SnapRounding::half_up}, {row.value, 0}).x, row.half_up);
    EXPECT_EQ(oracle::snap({8, SnapRounding::half_away}, {0, row.value}).y, row.half_away);
    EXPECT_EQ(oracle::snap({8, SnapRounding::truncate}, {0, row.value}).y, row.truncate);
  }
}

TEST(Oracle, ExplainsTheEdgeValues) {
  Setting setting;
  setting.target = {4, 4};
  // Counterclockwise on the screen: the edges are named in the order that has the inside on their right.
  const Explanation e = oracle::explain(setting, {}, {{{1.5f, 0}, {1.5f, 3}, {4, 3}}}, 1, 1, 0);
  EXPECT_TRUE(e.inside);
  EXPECT_FALSE(e.degenerate);
  EXPECT_EQ(e.scale, 256);
  EXPECT_EQ(e.snapped[2], (GridPoint{1024, 768}));
  EXPECT_EQ(e.edges[2].from, 1);
  EXPECT_EQ(e.edges[2].to, 0);
  EXPECT_EQ(e.edges[2].value, "0");
  EXPECT_TRUE(e.edges[2].left);
  EXPECT_EQ(e.edges[1].value, std::to_string((1024 - 384) * (768 - 384)));
  EXPECT_FALSE(e.edges[1].top);
}

struct Pair {
  explicit Pair(const Setting& s) : setting(s), definition(MaskLayout(s).words()), shift(MaskLayout(s).words()) {}

  bool agree(const Rules& rules, const Triangle& triangle) {
    oracle::cover_by_definition(setting, rules, triangle, definition);
    oracle::cover_by_shift(setting, rules, triangle, shift);
    return definition == shift;
  }
  Setting setting;
  std::vector<std::uint64_t> definition;
  std::vector<std::uint64_t> shift;
};

void agree_on_generators(std::size_t triangles_each) {
  for (const Generator& generator : generators()) {
    Pair pair(generator.setting);
    Scene scene;
    scene.setting = generator.setting;
    std::size_t done = 0;
    for (std::uint64_t index = 0; done < triangles_each; ++index) {
      scene.triangles.clear();
      append_scene(generator, 1, index, scene);
      done += scene.triangles.size();
      for (const Triangle& triangle : scene.triangles) {
        ASSERT_TRUE(pair.agree(scene.rules, triangle)) << generator.name << ", seed 1, scene " << index;
      }
    }
  }
}

TEST(Oracles, AgreeOnEveryGenerator) { agree_on_generators(2'000); }
TEST(LongOracles, AgreeOnAMillionTrianglesOfEveryGenerator) { agree_on_generators(1'000'000); }

TEST(Oracles, AgreeOnFloatsUnderEverySnapRule) {
  Pair pair({{16, 16}, {{8, 8}}});
  Random random(2);
  for (int i = 0; i < 40'000; ++i) {
    const Rules rules{static_cast<int>(random.between(0, 16)), static_cast<SnapRounding>(random.between(0, 3))};
    // Half of the coordinates are ties of the snap, or next to one; the rest have all 24 bits.
    const auto coordinate = [&] {
      const auto any = static_cast<float>(static_cast<double>(random.between(0, 1 << 30)) / (1 << 30) * 24 - 4);
      if (random.one_in(2)) return any;
      const float tie = std::ldexp(std::floor(std::ldexp(any, rules.subpixel_bits)) + 0.5f, -rules.subpixel_bits);
      return random.one_in(2) ? tie : std::nextafter(tie, random.one_in(2) ? -100.f : 100.f);
    };
    Triangle triangle;
    for (Position& p : triangle) p = {coordinate(), coordinate()};
    ASSERT_TRUE(pair.agree(rules, triangle)) << i;
  }
}

TEST(Oracles, AgreeFarOutAndOnEverySamplePosition) {
  Setting setting{{24, 24}, {}};
  for (int i = 0; i < 16; ++i) setting.sample_locations.push_back({i, (i * 7 + 3) % 16});
  Pair pair(setting);
  Random random(3);
  for (int i = 0; i < 2'000; ++i) {
    const std::int64_t reach = std::int64_t{1} << random.between(4, 15);
    const auto coordinate = [&] { return static_cast<float>(random.between(-reach * 256, reach * 256)) / 256; };
    Triangle triangle;
    for (Position& p : triangle) p = {coordinate(), coordinate()};
    ASSERT_TRUE(pair.agree({8, SnapRounding::nearest_even}, triangle)) << i;
  }
}

// Every triangle, each once, with vertices on the quarter-pixel lattice over 4x4 pixels: 289 points, 3,981,600
// triangles taken with their vertices in ascending order, so that the windings come up as they fall.
TEST(Oracles, AgreeOnEveryTriangleOfTheTwoBitLattice) {
  constexpr int side = 4 * 4 + 1;
  constexpr int points = side * side;
  Pair pair({{4, 4}, {{8, 8}}});
  const auto position = [](int i) {
    return Position{static_cast<float>(i % side) / 4, static_cast<float>(i / side) / 4};
  };
  std::size_t triangles = 0;
  for (int a = 0; a < points; ++a) {
    for (int b = a + 1; b < points; ++b) {
      for (int c = b + 1; c < points; ++c) {
        ++triangles;
        ASSERT_TRUE(pair.agree({2, SnapRounding::nearest_even}, {position(a), position(b), position(c)}))
            << a << " " << b << " " << c;
      }
    }
  }
  EXPECT_EQ(triangles, 3'981'264u);
}

}  // namespace
}  // namespace edgecase::conformance
