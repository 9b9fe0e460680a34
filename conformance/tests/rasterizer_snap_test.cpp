#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "rasterizer/snap.h"

namespace edgecase::rasterizer {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// On the 16.8 grid.
std::int64_t snapped(float pixels) { return snap_coordinate<Format16_8>(pixels).value().value(); }

TEST(RasterizerSnap, TiesGoToTheEvenNeighbour) {
  EXPECT_EQ(snapped(0.5f / 256), 0);
  EXPECT_EQ(snapped(1.5f / 256), 2);
  EXPECT_EQ(snapped(2.5f / 256), 2);
  EXPECT_EQ(snapped(-0.5f / 256), 0);
  EXPECT_EQ(snapped(-1.5f / 256), -2);
  EXPECT_EQ(snapped(-2.5f / 256), -2);
  EXPECT_EQ(snapped(100.0f + 0.5f / 256), 25600);
  EXPECT_EQ(snapped(100.0f + 1.5f / 256), 25602);
}

TEST(RasterizerSnap, EverythingElseGoesToTheNearest) {
  EXPECT_EQ(snapped(std::nextafter(0.5f / 256, 1.0f)), 1);
  EXPECT_EQ(snapped(std::nextafter(1.5f / 256, 0.0f)), 1);
  EXPECT_EQ(snapped(std::nextafter(-0.5f / 256, -1.0f)), -1);
  EXPECT_EQ(snapped(-0.0f), 0);
  EXPECT_EQ(snapped(std::numeric_limits<float>::denorm_min()), 0);
  EXPECT_EQ(snapped(1.0f), 256);
}

TEST(RasterizerSnap, TheWholeRangeAndNothingBeyond) {
  EXPECT_EQ(snapped(-32768.0f), -8388608);
  EXPECT_EQ(snapped(32767.99609375f), 8388607);  // 32767 + 255/256
  // Binary32 has nothing between this and 32768 but 32767.998046875, the tie, which goes to the even 32768: refused.
  EXPECT_FALSE(snap_coordinate<Format16_8>(32767.998046875f));
  EXPECT_FALSE(snap_coordinate<Format16_8>(32768.0f));
  EXPECT_FALSE(snap_coordinate<Format16_8>(std::nextafter(-32768.0f, -40000.0f)));
  // 12.4 below -2048 px: what rounds back into the format is taken.
  using Format12_4 = Format<12, 4>;
  EXPECT_EQ(snap_coordinate<Format12_4>(-2048.03125f).value().value(), -32768);  // a tie: to even
  EXPECT_FALSE(snap_coordinate<Format12_4>(std::nextafter(-2048.03125f, -3000.0f)));
}

TEST(RasterizerSnap, WhatIsNoNumberIsRefused) {
  for (const float value :
       {kNan, -kNan, kInfinity, -kInfinity, std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()}) {
    EXPECT_FALSE(snap_coordinate<Format16_8>(value)) << value;
    EXPECT_FALSE((snap_coordinate<Format<24, 16>>(value))) << value;
  }
}

TEST(RasterizerSnap, OtherFormatsRoundOnTheirOwnGrid) {
  EXPECT_EQ((snap_coordinate<Format<12, 4>>(0.5f / 16).value().value()), 0);
  EXPECT_EQ((snap_coordinate<Format<12, 4>>(0.5625f).value().value()), 9);
  EXPECT_EQ((snap_coordinate<Format<16, 0>>(2.5f).value().value()), 2);
  EXPECT_EQ((snap_coordinate<Format<16, 0>>(3.5f).value().value()), 4);
  EXPECT_EQ((snap_coordinate<Format<16, 16>>(-32768.0f).value().value()), std::numeric_limits<std::int32_t>::min());
}

TEST(RasterizerSnap, AgreesWithTheFloatingPointUnit) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> twelfths(-32767 * 4096, 32767 * 4096);
  for (int i = 0; i < 200'000; ++i) {
    // Multiples of 2^-12 px in a small range are ties often, rounded to binary32 at the large ones.
    const float value = static_cast<float>(twelfths(random) >> (random() % 24)) / 4096;
    ASSERT_EQ(snapped(value), std::llrint(static_cast<double>(value) * 256)) << value;
  }
}

TEST(RasterizerSnap, TheErrorNamesTheFirstBadCoordinate) {
  FixedTriangle<Format16_8> out;
  const auto expect = [&](const Triangle& triangle, const std::string& text) {
    const auto error = snap<Format16_8>(triangle, out, 7);
    ASSERT_TRUE(error);
    EXPECT_EQ(describe(*error), text);
  };
  expect({{{0, 0}, {kNan, kInfinity}, {1, 1}}}, "triangle 7, vertex 1: x is NaN");
  expect({{{0, 0}, {0, 0}, {1, -kInfinity}}}, "triangle 7, vertex 2: y is infinite");
  expect({{{0, 32768.5f}, {0, 0}, {1, 1}}}, "triangle 7, vertex 0: y = 32768.5 px lies outside the coordinate format");
  EXPECT_FALSE(snap<Format16_8>({{{0, 1}, {2, 3}, {4, 5}}}, out));
  EXPECT_EQ(out[2].y.value(), 5 * 256);
}

// Lists of every length up to a few blocks of eight, one vertex in so many off the grid, and ends of the range.
TEST(RasterizerSnap, AListIsSnappedAsItsTrianglesAre) {
  std::mt19937 random(3);
  const auto check = [&]<class F>(F) {
    for (std::size_t length = 0; length < 40; ++length) {
      std::vector<Triangle> triangles(length);
      for (Triangle& triangle : triangles) {
        for (Vertex& v : triangle) {
          const auto coordinate = [&] {
            const bool off_grid = length % 3 == 0 && random() % 16 == 0;
            const auto fine = static_cast<int>(random() % 65536) - 32768;
            const float on_grid = std::ldexp(static_cast<float>(fine), -static_cast<int>(random() % 9));
            return off_grid ? on_grid + std::ldexp(1.0f, -11) : random() % 50 == 0 ? -32768.0f : on_grid;
          };
          v = {coordinate(), coordinate()};
        }
      }
      std::vector<FixedTriangle<F>> snapped(length);
      ASSERT_FALSE(snap_list<F>(triangles, snapped));
      for (std::size_t i = 0; i < length; ++i) {
        FixedTriangle<F> expected;
        ASSERT_FALSE(snap<F>(triangles[i], expected));
        for (std::size_t v = 0; v < 3; ++v) {
          ASSERT_EQ(snapped[i][v].x.value(), expected[v].x.value()) << length << ' ' << i;
          ASSERT_EQ(snapped[i][v].y.value(), expected[v].y.value()) << length << ' ' << i;
        }
      }
    }
  };
  check(Format16_8());
  check(Format<16, 0>());
  check(Format<16, 16>());
  check(Format<24, 16>());
}

TEST(RasterizerSnap, AListsErrorNamesTheFirstBadCoordinate) {
  std::vector<Triangle> triangles(20);
  std::vector<FixedTriangle<Format16_8>> snapped(20);
  for (const float bad : {kNan, -kInfinity, 32768.0f, -32769.0f, std::numeric_limits<float>::max()}) {
    triangles.assign(20, {});
    triangles[17][1].y = bad;
    triangles[19][0].x = bad;
    const auto error = snap_list<Format16_8>(triangles, snapped);
    ASSERT_TRUE(error) << bad;
    EXPECT_EQ(error->triangle, 17u);
    EXPECT_EQ(error->vertex, 1);
    EXPECT_EQ(error->axis, Axis::y);
  }
}

}  // namespace
}  // namespace edgecase::rasterizer
