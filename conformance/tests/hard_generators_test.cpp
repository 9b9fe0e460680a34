// The generators of the category `hard` make the shapes that they are named after, at the sizes that count.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "conformance/generators/generator.h"

namespace edgecase::conformance {
namespace {

Scene scenes(const std::string& name, std::uint64_t count) {
  const Generator& generator = *find_generator(name);
  Scene scene;
  scene.setting = generator.setting;
  for (std::uint64_t i = 0; i < count; ++i) append_scene(generator, 3, i, scene);
  return scene;
}

struct Span {
  float low, high;
  float size() const { return high - low; }
};

Span span_of(const Triangle& t, float Position::*axis) {
  const auto [low, high] = std::minmax({t[0].*axis, t[1].*axis, t[2].*axis});
  return {low, high};
}

TEST(HardGenerators, BoxesStraddleEveryPowerOfTwo) {
  for (const auto& [name, axis] :
       {std::pair("straddle_wide", &Position::x), std::pair("straddle_tall", &Position::y)}) {
    const Scene scene = scenes(name, 4000);
    for (const float power : {4.0F, 8.0F, 16.0F, 32.0F, 64.0F, 128.0F}) {
      std::array<int, 3> sides{};  // less, equal, more, all within a pixel and a bit
      for (const Triangle& t : scene.triangles) {
        const float off = span_of(t, axis).size() - power;
        if (std::abs(off) < 1.25F) ++sides[static_cast<std::size_t>(off < 0 ? 0 : off > 0 ? 2 : 1)];
      }
      for (const int count : sides) EXPECT_GT(count, 10) << name << ' ' << power;
    }
  }
}

// Of the pixels of the target's longer side, those with a centre in some row, or column, that an edge passes within a
// subpixel of.
int centres_passed(const Triangle& t, const Extent& target, float Position::*along, float Position::*across) {
  const bool wide = target.width >= target.height;
  const int length = wide ? target.width : target.height;
  int passed = 0;
  for (int i = 0; i < length; ++i) {
    const double at = i + 0.5;
    bool close = false;
    for (std::size_t e = 0; e < 3; ++e) {
      const Position& a = t[e];
      const Position& b = t[(e + 1) % 3];
      const double da = static_cast<double>(a.*along);
      const double db = static_cast<double>(b.*along);
      if (da == db || at < std::min(da, db) || at > std::max(da, db)) continue;
      const double ca = static_cast<double>(a.*across);
      const double cb = static_cast<double>(b.*across);
      const double c = ca + (cb - ca) * (at - da) / (db - da);
      close = close || std::abs(c - std::floor(c) - 0.5) <= 1.0 / 256;
    }
    passed += close ? 1 : 0;
  }
  return passed;
}

TEST(HardGenerators, NeedlesPassThousandsOfCentresWithinASubpixel) {
  for (const auto& [name, along, across] : {std::tuple("needle_row", &Position::x, &Position::y),
                                            std::tuple("needle_column", &Position::y, &Position::x)}) {
    const Scene scene = scenes(name, 300);
    int thousands = 0;
    float thinnest = 1;
    for (const Triangle& t : scene.triangles) {
      EXPECT_GT(span_of(t, along).size(), 15'999);
      EXPECT_LE(span_of(t, across).size(), 4.0F / 256);
      if (span_of(t, across).size() > 0) thinnest = std::min(thinnest, span_of(t, across).size());
      thousands += centres_passed(t, scene.setting.target, along, across) >= 2000 ? 1 : 0;
    }
    EXPECT_EQ(thinnest, 1.0F / 256);
    EXPECT_GT(thousands, 100) << name;
  }
}

TEST(HardGenerators, FansHaveThousandsOfSpokes) {
  std::size_t most = 0;
  for (const Mesh& mesh : scenes("spokes", 8).meshes) {
    EXPECT_GE(mesh.count, 900U);
    most = std::max(most, mesh.count);
  }
  EXPECT_GT(most, 3000U);
}

TEST(HardGenerators, CoordinatesTouchBothEndsOfTheRange) {
  for (const auto& [name, low, high] :
       {std::tuple("range_ends", -32768.0F, 32767.99609375F), std::tuple("viewport_ends", -8192.0F, 8192.0F)}) {
    std::map<float, int> seen;
    for (const Triangle& t : scenes(name, 300).triangles) {
      for (const Position& p : t) {
        ++seen[p.x];
        ++seen[p.y];
      }
    }
    EXPECT_EQ(seen.begin()->first, low);
    EXPECT_EQ(seen.rbegin()->first, high);
    EXPECT_GT(seen.begin()->second, 100) << name;
    EXPECT_GT(seen.rbegin()->second, 100) << name;
  }
}

TEST(HardGenerators, BoxesEndAtEverySampleOnAPixelsBorder) {
  const Scene scene = scenes("border16", 3000);
  ASSERT_EQ(scene.setting.samples(), 16);
  std::set<std::pair<int, int>> touched;  // the sample, and the side of the box that goes through it
  for (const Triangle& t : scene.triangles) {
    const Span x = span_of(t, &Position::x);
    const Span y = span_of(t, &Position::y);
    const auto sixteenths = [](float v) {
      const float fraction = (v - std::floor(v)) * 16;
      return fraction == std::floor(fraction) ? static_cast<int>(fraction) : -1;
    };
    for (int s = 0; s < 16; ++s) {
      const SampleLocation at = scene.setting.sample_locations[static_cast<std::size_t>(s)];
      const std::array<bool, 4> sides{sixteenths(x.low) == at.x, sixteenths(x.high) == at.x, sixteenths(y.low) == at.y,
                                      sixteenths(y.high) == at.y};
      for (int side = 0; side < 4; ++side) {
        if (sides[static_cast<std::size_t>(side)]) touched.insert({s, side});
      }
    }
  }
  for (const int s : {12, 13, 14, 15}) {
    for (int side = 0; side < 4; ++side) EXPECT_TRUE(touched.contains({s, side})) << s << ' ' << side;
  }
}

TEST(HardGenerators, RectanglesReachFarAndEndInTheTarget) {
  const Scene scene = scenes("far_rectangle", 300);
  ASSERT_EQ(scene.meshes.size(), 300U);
  for (const Triangle& t : scene.triangles) {
    EXPECT_LT(span_of(t, &Position::x).low, -999);
    EXPECT_LT(span_of(t, &Position::y).low, -999);
    EXPECT_LE(span_of(t, &Position::x).high, 31);
  }
}

}  // namespace
}  // namespace edgecase::conformance
