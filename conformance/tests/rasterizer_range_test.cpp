// Coverage against the rule written down in 128-bit integers, sample by sample, over the whole range of the format.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <random>
#include <vector>

#include "rasterizer/rasterizer.h"

namespace edgecase::rasterizer {
namespace {

/// Whether a sample is inside, by definition: x and y of everything in units of 2^-bits px.
bool inside_by_definition(std::array<std::array<Int128, 2>, 3> v, Int128 x, Int128 y) {
  const auto cross = [](const auto& p, const auto& q, Int128 sx, Int128 sy) {
    return (q[0] - p[0]) * (sy - p[1]) - (q[1] - p[1]) * (sx - p[0]);
  };
  const Int128 area = cross(v[0], v[1], v[2][0], v[2][1]);
  if (area == 0) return false;
  if (area < 0) std::swap(v[1], v[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& p = v[i];
    const auto& q = v[(i + 1) % 3];
    const Int128 value = cross(p, q, x, y);
    const bool top_left = q[1] < p[1] || (q[1] == p[1] && q[0] > p[0]);
    if (value < 0 || (value == 0 && !top_left)) return false;
  }
  return true;
}

/// A triangle given in subpixels of F, drawn, and its mask held against the definition.
template <class F>
class Check {
 public:
  Check(int width, int height) : width_(width), height_(height), words_(target_.mask_words()) {}

  void draw(const std::array<std::array<std::int64_t, 2>, 3>& subpixels) {
    FixedTriangle<F> fixed;
    for (std::size_t i = 0; i < 3; ++i) {
      fixed[i] = {F::Coordinate::checked(subpixels[i][0]).value(), F::Coordinate::checked(subpixels[i][1]).value()};
      // Twice as fine as the samples' grid, in which a centre is an integer for every format.
      for (std::size_t k = 0; k < 2; ++k) vertices_[i][k] = Int128{subpixels[i][k]} * 2 * kFiner;
    }
    std::fill(words_.begin(), words_.end(), 0);
    const Mask mask = *Mask::over(target_, words_);
    cover<F>(fixed, target_, [&](int y, int word, std::uint64_t bits) { mask.add(y, word, bits); });
  }

  bool drawn(int x, int y) const {
    return words_[static_cast<std::size_t>(y) * target_.row_words() + static_cast<std::size_t>(x) / 64] >> (x % 64) & 1;
  }
  bool expected(int x, int y) const {
    constexpr Int128 kPixel = Int128{2} << F::kSampleBits;
    return inside_by_definition(vertices_, x * kPixel + kPixel / 2, y * kPixel + kPixel / 2);
  }

  /// Every pixel of the target.
  void expect_exact() const {
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) ASSERT_EQ(drawn(x, y), expected(x, y)) << x << ", " << y;
    }
  }

  /// As much as every pixel, for large targets: a triangle is convex, so a row is right if it is one run of covered
  /// pixels whose ends, and their neighbours outside, are right. An empty row is looked at in a few places.
  void expect_exact_rows() const {
    for (int y = 0; y < height_; ++y) {
      int first = width_, last = -1, count = 0;
      for (std::size_t word = 0; word < target_.row_words(); ++word) {
        const std::uint64_t bits = words_[static_cast<std::size_t>(y) * target_.row_words() + word];
        if (bits == 0) continue;
        const int base = static_cast<int>(word) * 64;
        if (last < 0) first = base + static_cast<int>(std::countr_zero(bits));
        last = base + 63 - static_cast<int>(std::countl_zero(bits));
        count += static_cast<int>(std::popcount(bits));
      }
      if (last < 0) {
        for (const int x : {0, 1, width_ / 2, width_ - 1}) ASSERT_FALSE(expected(x, y)) << x << ", " << y;
        continue;
      }
      ASSERT_EQ(count, last - first + 1) << "row " << y;
      ASSERT_TRUE(expected(first, y) && expected(last, y)) << "row " << y;
      if (first > 0) {
        ASSERT_FALSE(expected(first - 1, y)) << "row " << y;
      }
      if (last + 1 < width_) {
        ASSERT_FALSE(expected(last + 1, y)) << "row " << y;
      }
    }
  }

 private:
  static constexpr std::int64_t kFiner = std::int64_t{1} << (F::kSampleBits - F::kSubpixelBits);
  int width_, height_;
  Target target_ = *Target::make(width_, height_);
  std::vector<std::uint64_t> words_;
  std::array<std::array<Int128, 2>, 3> vertices_{};
};

constexpr std::int64_t kLow = -8388608, kHigh = 8388607;  // 16.8

void check_the_corners_of_the_range(int width, int height) {
  Check<Format16_8> check(width, height);
  check.draw({{{kLow, kLow}, {kHigh, kLow}, {kLow, kHigh}}});
  check.expect_exact_rows();
  check.draw({{{kHigh, kHigh}, {kLow, kHigh}, {kHigh, kLow}}});
  check.expect_exact_rows();
  check.draw({{{kLow, kLow}, {kHigh, kHigh - 1}, {kHigh, kHigh}}});  // a sliver along the diagonal
  check.expect_exact_rows();
}

TEST(RasterizerRange, TheCornersOfTheRangeOnLargeTargets) {
  check_the_corners_of_the_range(16384, 512);
  check_the_corners_of_the_range(512, 16384);
}

TEST(LongRasterizerRange, TheCornersOfTheRangeOnTheLargestTarget) { check_the_corners_of_the_range(16384, 16384); }

TEST(RasterizerRange, EveryTriangleOfExtremeVertices) {
  Check<Format16_8> check(70, 5);
  const std::int64_t values[] = {kLow, kLow + 1, -1, 0, 128, 384, kHigh - 1, kHigh};
  std::vector<std::array<std::int64_t, 2>> vertices;
  for (const auto x : values) {
    for (const auto y : values) vertices.push_back({x, y});
  }
  std::mt19937 random(3);
  for (int i = 0; i < 5'000; ++i) {
    const auto pick = [&] { return vertices[random() % vertices.size()]; };
    check.draw({pick(), pick(), pick()});
    ASSERT_NO_FATAL_FAILURE(check.expect_exact());
  }
}

template <class F>
class RasterizerFormat : public testing::Test {};
using Formats = testing::Types<Format<16, 8>, Format<12, 4>, Format<16, 0>, Format<16, 1>, Format<16, 4>,
                               Format<16, 12>, Format<16, 16>, Format<24, 8>, Format<24, 16>, Format<2, 8>>;
TYPED_TEST_SUITE(RasterizerFormat, Formats);

TYPED_TEST(RasterizerFormat, RandomTrianglesOfEverySize) {
  Check<TypeParam> check(67, 9);
  std::mt19937_64 random(4);
  for (int i = 0; i < 3'000; ++i) {
    // A random number of bits: vertices from within one pixel out to the ends of the range.
    const int shift = static_cast<int>(random() % (TypeParam::kBits - 1));
    const auto coordinate = [&] { return static_cast<std::int64_t>(random()) >> (64 - TypeParam::kBits + shift); };
    check.draw({{{coordinate(), coordinate()}, {coordinate(), coordinate()}, {coordinate(), coordinate()}}});
    ASSERT_NO_FATAL_FAILURE(check.expect_exact());
  }
}

TEST(RasterizerRange, ExhaustiveOnTheHalfPixelLattice) {
  Check<Format<16, 1>> check(2, 2);
  constexpr int kSide = 6;  // -1/2 to 2 px
  const auto vertex = [](int i) { return std::array<std::int64_t, 2>{i % kSide - 1, i / kSide - 1}; };
  for (int i = 0; i < kSide * kSide; ++i) {
    for (int j = 0; j < kSide * kSide; ++j) {
      for (int k = 0; k < kSide * kSide; ++k) {
        check.draw({vertex(i), vertex(j), vertex(k)});
        ASSERT_NO_FATAL_FAILURE(check.expect_exact()) << i << ' ' << j << ' ' << k;
      }
    }
  }
}

TEST(RasterizerRange, LongAndThinTargets) {
  std::mt19937_64 random(5);
  Check<Format16_8> wide(16384, 1), high(1, 16384);
  for (int i = 0; i < 50; ++i) {
    const auto coordinate = [&] { return static_cast<std::int64_t>(random() % 16777216) + kLow; };
    const std::array<std::array<std::int64_t, 2>, 3> triangle{
        {{coordinate(), coordinate()}, {coordinate(), coordinate()}, {coordinate(), coordinate()}}};
    wide.draw(triangle);
    ASSERT_NO_FATAL_FAILURE(wide.expect_exact());
    high.draw(triangle);
    ASSERT_NO_FATAL_FAILURE(high.expect_exact());
  }
}

}  // namespace
}  // namespace edgecase::rasterizer
