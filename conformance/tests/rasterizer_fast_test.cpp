// The fast rasterizer against the scalar one, bit for bit, for every instruction set of this machine.
#include "rasterizer/fast/fast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "conformance/tests/snapped_triangles.h"
#include "rasterizer/rasterizer.h"
#include "rasterizer/snap.h"

namespace edgecase::rasterizer {
namespace {

using namespace snapped;
using Words = std::vector<std::uint64_t>;

Words scalar(std::span<const Fixed> triangles, const Target& target) {
  Words words(target.mask_words());
  const Mask mask = *Mask::over(target, words);
  for (const Fixed& triangle : triangles) {
    cover<Format16_8>(triangle, target, [&](int y, int word, std::uint64_t bits) { mask.add(y, word, bits); });
  }
  return words;
}

Words fast_union(const FastRasterizer& fast, std::span<const Fixed> triangles, const Target& target) {
  StripMask mask(target);
  fast.cover_union(triangles, mask);
  Words words(target.mask_words());
  mask.to_rows(words);
  return words;
}

class FastRasterizerTest : public testing::TestWithParam<Isa> {
 protected:
  /// Each triangle by cover_each() against the scalar one, then a few of them at a time by cover_union().
  void expect_exact(std::span<const Fixed> triangles, const Target& target) const {
    Words each(triangles.size() * target.mask_words(), ~std::uint64_t{0});
    fast_.cover_each(triangles, target, each);
    ASSERT_EQ(fast_.first_difference(triangles, target, each), triangles.size());
    if (target.width().value() <= 32) {
      const std::vector<std::uint32_t> rows(each.begin(), each.end());
      ASSERT_EQ(fast_.first_difference(triangles, target, rows), triangles.size());
    }
    // As many as leave a vector of the widest kind half filled, and few enough to leave the mask partly empty.
    constexpr std::size_t kUnited = 3 * kMaxLanes / 2;
    Words united(target.mask_words());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const Words expected = scalar(triangles.subspan(i, 1), target);
      const auto observed = std::span(each).subspan(i * expected.size(), expected.size());
      ASSERT_TRUE(std::ranges::equal(observed, expected)) << "triangle " << i << ": " << text(triangles[i]);
      for (std::size_t word = 0; word < united.size(); ++word) united[word] |= expected[word];
      if ((i + 1) % kUnited != 0) continue;
      ASSERT_EQ(fast_union(fast_, triangles.subspan(i + 1 - kUnited, kUnited), target), united) << "up to " << i;
      std::ranges::fill(united, 0);
    }
  }

  const FastRasterizer fast_ = *FastRasterizer::make(GetParam());
};

TEST_P(FastRasterizerTest, TargetsOfEveryWidth) {
  for (int width = 1; width <= 200; ++width) {
    const Target target = *Target::make(width, 1 + width * 7 % 40);
    Triangles stream(static_cast<unsigned>(width), target);
    std::vector<Fixed> triangles(24 * 9);
    for (Fixed& triangle : triangles) triangle = stream.next();
    ASSERT_NO_FATAL_FAILURE(expect_exact(triangles, target)) << "width " << width;
  }
}

TEST_P(FastRasterizerTest, ManyTrianglesOnOneTarget) {
  const Target target = *Target::make(100, 90);
  Triangles stream(1, target);
  std::vector<Fixed> triangles(20'000);
  for (Fixed& triangle : triangles) triangle = stream.next();
  ASSERT_NO_FATAL_FAILURE(expect_exact(triangles, target));
}

// The binning mistakes of "Depth buffers done quick, part 2": a negative coordinate divided by truncation falls into
// the first strip, an end taken as included into the next one. Here strips and bands are what triangles are sorted
// into.
TEST_P(FastRasterizerTest, TrianglesThatEndOnTheBordersOfStripsAndBands) {
  const Target target = *Target::make(200, 150);
  std::mt19937_64 random(6);
  const auto coordinate = [&] {
    constexpr std::array kBorders{-64, -33, -32, -16, -1, 0, 1, 16, 32, 64, 96, 128, 150, 160, 192, 200, 224};
    // At a border, half a pixel from it where the samples are, and a subpixel to either side of both.
    constexpr std::array kOffsets{-129, -128, -127, -1, 0, 1, 127, 128, 129};
    return kBorders[random() % kBorders.size()] * 256 + kOffsets[random() % kOffsets.size()];
  };
  std::vector<Fixed> triangles(24 * 200);
  for (Fixed& triangle : triangles) {
    for (auto& v : triangle) v = vertex(coordinate(), coordinate());
    if (random() % 2 == 0) triangle[1].x = triangle[0].x, triangle[2].y = triangle[0].y;
  }
  ASSERT_NO_FATAL_FAILURE(expect_exact(triangles, target));
}

// Larger than a block, in bands of every kind: wide ones, slivers, edges of every slope.
TEST_P(FastRasterizerTest, LargeTrianglesInsideTheTarget) {
  const Target target = *Target::make(420, 310);
  std::mt19937_64 random(7);
  const auto between = [&](std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(high - low + 1));
  };
  std::vector<Fixed> triangles(24 * 40);
  for (Fixed& triangle : triangles) {
    const std::int64_t step = random() % 3 == 0 ? 128 : 1;
    const auto point = [&](std::int64_t x, std::int64_t y) {
      return vertex(std::clamp<std::int64_t>(x, 0, 420 * 256) / step * step,
                    std::clamp<std::int64_t>(y, 0, 310 * 256) / step * step);
    };
    const std::int64_t x0 = between(0, 420 * 256), y0 = between(0, 310 * 256);
    const std::int64_t x1 = between(0, 420 * 256), y1 = between(0, 310 * 256);
    const std::int64_t along = between(0, 256), off = random() % 2 == 0 ? 420 * 256 : 1 << between(4, 14);
    triangle = {
        point(x0, y0), point(x1, y1),
        point(x0 + (x1 - x0) * along / 256 + between(-off, off), y0 + (y1 - y0) * along / 256 + between(-off, off))};
  }
  ASSERT_NO_FATAL_FAILURE(expect_exact(triangles, target));
}

// Bands are exact up to an extent and a height: triangles on both sides of these limits, of which one edge passes a
// pixel's centre as closely as an edge of its height can without touching it.
TEST_P(FastRasterizerTest, TrianglesAboutAsLargeAsBandsReach) {
  const Target target = *Target::make(2600, 2600);
  std::mt19937_64 random(8);
  const auto between = [&](std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(high - low + 1));
  };
  std::vector<Fixed> triangles;
  while (triangles.size() < 24 * 8) {
    // From (x, y), dy down, the edge is dx * down / dy right of x where it passes the row of a centre. That is 1 / dy
    // off a whole number if dx * down = 1 modulo dy.
    if (random() % 8 == 0) {
      // One whose widest band is about as wide as they may be.
      const std::int64_t top = between(0, 2500 * 256), right = between(1970, 2080) * 256;
      triangles.push_back({vertex(between(0, 64), top), vertex(right, top), vertex(right / 2, between(0, 2600 * 256))});
      continue;
    }
    const std::int64_t dy = random() % 4 == 0 ? between(300, 2100) * 256 + 1 : between(1980, 2010) * 256 + 1;
    const std::int64_t down = between(1, dy - 1);
    std::int64_t dx = 0, next = 1;
    for (std::int64_t r = dy, next_r = down; next_r != 0;) {
      const std::int64_t quotient = r / next_r;
      dx = std::exchange(next, dx - quotient * next);
      r = std::exchange(next_r, r - quotient * next_r);
      if (next_r == 0 && r != 1) dx = 0;
    }
    if (dx == 0) continue;
    dx += between(-1, 1) * dy;        // the same modulo dy, and wider
    if (random() % 2 == 0) dx = -dx;  // to the left of the centre, or of the edge
    const std::int64_t crossing = dx * down / dy;
    const std::int64_t y = between(1, 100) * 256 + 128 - down % 256;
    const std::int64_t x =
        (random() % 2 == 0 ? 128 - crossing % 256 : between(0, 255)) + between(1290, 1310) * 256 - dx / 512 * 256;
    const std::int64_t third = random() % 2 == 0 ? between(0, 2600 * 256) : x + between(-600, 600) * 256;
    triangles.push_back({vertex(x, y), vertex(x + dx, y + dy), vertex(third, y + between(0, dy))});
    const auto outside = [](const auto& v) { return v.x.value() < 0 || v.x.value() > 2600 * 256; };
    if (std::ranges::any_of(triangles.back(), outside)) triangles.pop_back();
  }
  ASSERT_NO_FATAL_FAILURE(expect_exact(triangles, target));
}

TEST_P(FastRasterizerTest, EndsOfTheRangeOnLargeTargets) {
  for (const auto& [width, height] : {std::array{16384, 48}, std::array{48, 16384}, std::array{2500, 2500}}) {
    const Target target = *Target::make(width, height);
    std::vector<Fixed> triangles{{vertex(kLow, kLow), vertex(kHigh, kLow), vertex(kLow, kHigh)},
                                 {vertex(kHigh, kHigh), vertex(kLow, kHigh), vertex(kHigh, kLow)},
                                 {vertex(kLow, kLow), vertex(kHigh, kHigh - 1), vertex(kHigh, kHigh)}};
    std::mt19937_64 random(9);
    while (triangles.size() < 48) {
      const auto coordinate = [&] { return static_cast<std::int64_t>(random() >> 40) + kLow; };
      triangles.push_back(
          {vertex(coordinate(), coordinate()), vertex(coordinate(), coordinate()), vertex(coordinate(), coordinate())});
    }
    ASSERT_NO_FATAL_FAILURE(expect_exact(triangles, target)) << width << "x" << height;
  }
}

TEST_P(FastRasterizerTest, FindsEveryBitThatDiffers) {
  for (const auto& [width, height] : {std::array{1, 1}, {31, 9}, {32, 32}, {33, 5}, {64, 8}, {65, 17}, {200, 3}}) {
    const Target target = *Target::make(width, height);
    Triangles stream(3, target);
    std::vector<Fixed> triangles(2 * kMaxLanes + 3);
    for (Fixed& triangle : triangles) triangle = stream.next();
    Words each(triangles.size() * target.mask_words());
    fast_.cover_each(triangles, target, each);
    // Bits right of the target, too: cover_each() leaves them clear.
    for (std::size_t word = 0; word < each.size(); ++word) {
      for (const int bit : {0, 17, 31, 32, 63}) {
        each[word] ^= std::uint64_t{1} << bit;
        ASSERT_EQ(fast_.first_difference(triangles, target, each), word / target.mask_words())
            << width << "x" << height << ", word " << word << ", bit " << bit;
        each[word] ^= std::uint64_t{1} << bit;
      }
    }
    ASSERT_EQ(fast_.first_difference({}, target, std::span<const std::uint64_t>()), 0U);
    if (width > 32) continue;
    std::vector<std::uint32_t> rows(each.begin(), each.end());
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (const int bit : {0, 17, 30, 31}) {
        rows[row] ^= std::uint32_t{1} << bit;
        ASSERT_EQ(fast_.first_difference(triangles, target, rows), row / target.mask_words())
            << width << "x" << height << ", row " << row << ", bit " << bit;
        rows[row] ^= std::uint32_t{1} << bit;
      }
    }
    ASSERT_EQ(fast_.first_difference(triangles, target, rows), triangles.size());
    ASSERT_EQ(fast_.first_difference({}, target, std::span<const std::uint32_t>()), 0U);
  }
}

class SnapOnGridTest : public FastRasterizerTest {
 protected:
  void SetUp() override {
    for (Triangle& triangle : on_grid_) {
      for (Vertex& v : triangle) v = {coordinate(), coordinate()};
    }
  }
  float coordinate() {
    const auto reach = static_cast<int>(FastRasterizer::kGridReach) * 256;
    return static_cast<float>(static_cast<int>(random_() % static_cast<unsigned>(2 * reach - 1)) - reach + 1) / 256;
  }

  std::mt19937_64 random_{11};
  std::vector<Triangle> on_grid_ = std::vector<Triangle>(2 * kMaxLanes + 5);
};

TEST_P(SnapOnGridTest, TakesListsOfEveryLength) {
  for (std::size_t count = 0; count <= on_grid_.size(); ++count) {
    const auto list = std::span(on_grid_).first(count);
    std::vector<Fixed> expected(count), observed(count + 1);
    ASSERT_FALSE(snap_list<Format16_8>(list, std::span(expected)));
    ASSERT_TRUE(fast_.snap_on_grid(list, std::span(observed).first(count)));
    expected.emplace_back();  // which is no more than the list
    for (std::size_t i = 0; i <= count; ++i) EXPECT_EQ(text(observed[i]), text(expected[i])) << count;
  }
}

TEST_P(SnapOnGridTest, RefusesWhatLiesOffTheGridOrTooFarOut) {
  using Limits = std::numeric_limits<float>;
  constexpr float kReach = FastRasterizer::kGridReach;
  std::vector<Fixed> snapped(on_grid_.size());
  ASSERT_TRUE(fast_.snap_on_grid(on_grid_, snapped));
  for (const float bad : {1.0F / 512, 3 + 1.0F / 512, std::nextafter(5.0F, 6.0F), Limits::denorm_min(), kReach, -kReach,
                          0x1p23F, -0x1p23F, 0x1p31F, Limits::max(), Limits::infinity(), Limits::quiet_NaN()}) {
    for (std::size_t i = 0; i < 6 * on_grid_.size(); ++i) {
      Vertex& v = on_grid_[i / 6][i / 2 % 3];
      float& at = i % 2 == 0 ? v.x : v.y;
      const float good = std::exchange(at, bad);
      ASSERT_FALSE(fast_.snap_on_grid(on_grid_, snapped)) << bad << " at " << i;
      at = good;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Isas, SnapOnGridTest, testing::ValuesIn(available_isas().begin(), available_isas().end()),
                         [](const auto& isa) { return std::string(name_of(isa.param)); });

INSTANTIATE_TEST_SUITE_P(Isas, FastRasterizerTest, testing::ValuesIn(available_isas().begin(), available_isas().end()),
                         [](const auto& isa) { return std::string(name_of(isa.param)); });

}  // namespace
}  // namespace edgecase::rasterizer
