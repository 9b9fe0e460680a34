// Several threads against one, bit for bit.
#include "rasterizer/threads/threads.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace edgecase::rasterizer {
namespace {

using Fixed = FixedTriangle<Format16_8>;

/// More threads than a small machine has processors: oneTBB would stop there.
const tbb::global_control kManyThreads(tbb::global_control::max_allowed_parallelism, 16);

/// Triangles of up to `extent` subpixels, some of them partly or wholly outside the target.
std::vector<Fixed> random_triangles(unsigned seed, const Target& target, std::size_t count, int extent) {
  std::mt19937_64 random(seed);
  const auto between = [&](std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(high - low + 1));
  };
  std::vector<Fixed> triangles(count);
  for (Fixed& triangle : triangles) {
    const std::int64_t x = between(-2 * extent, target.width().value() * 256 + extent);
    const std::int64_t y = between(-2 * extent, target.height().value() * 256 + extent);
    for (auto& v : triangle) {
      v = {*Int<24>::checked(x + between(0, extent)), *Int<24>::checked(y + between(0, extent))};
    }
  }
  return triangles;
}

std::vector<std::uint64_t> rows(const StripMask& mask) {
  std::vector<std::uint64_t> words(mask.target().mask_words());
  mask.to_rows(words);
  return words;
}

TEST(ThreadedRasterizer, AnyNumberOfThreadsGivesTheSameBits) {
  const FastRasterizer fast;
  for (const auto& [width, height] : {std::array{1, 1}, std::array{200, 100}, std::array{700, 33}}) {
    const Target target = *Target::make(width, height);
    for (const int extent : {1'000, 10'000, 200'000}) {
      // Enough of them for every thread, and few enough to leave pixels uncovered.
      const auto triangles = random_triangles(3, target, 3'000, extent);
      StripMask expected(target);
      fast.cover_union(triangles, expected);
      for (const int threads : {1, 2, 3, 7, 16}) {
        ThreadedRasterizer threaded(fast, threads);
        StripMask observed(target);
        threaded.cover_union(triangles, observed);
        ASSERT_EQ(rows(observed), rows(expected)) << width << "x" << height << ", " << threads << " threads";
      }
    }
  }
}

TEST(ThreadedRasterizer, OneCallLeavesNothingToTheNext) {
  const FastRasterizer fast;
  ThreadedRasterizer threaded(fast, 4);
  for (unsigned call = 0; call < 30; ++call) {
    // Two targets in turn, every list but a few of them long enough for all threads; sparse, so that a bit left behind
    // shows.
    const Target target = call / 3 % 2 == 0 ? *Target::make(90, 80) : *Target::make(80, 90);
    std::vector<Fixed> triangles = random_triangles(call, target, 400, 2'000);
    for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = triangles[i % 7];
    StripMask expected(target), observed(target);
    fast.cover_union(triangles, expected);
    threaded.cover_union(triangles, observed);
    ASSERT_EQ(rows(observed), rows(expected)) << "call " << call;
  }
}

TEST(ThreadedRasterizer, AddsToWhatTheMaskHolds) {
  const FastRasterizer fast;
  const Target target = *Target::make(100, 100);
  const auto before = random_triangles(8, target, 5, 3'000), after = random_triangles(9, target, 2'000, 500);
  StripMask expected(target), observed(target);
  fast.cover_union(before, expected);
  fast.cover_union(after, expected);
  ThreadedRasterizer threaded(fast, 3);
  threaded.cover_union(before, observed);
  threaded.cover_union(after, observed);
  EXPECT_EQ(rows(observed), rows(expected));
  threaded.cover_union({}, observed);
  EXPECT_EQ(rows(observed), rows(expected));
}

}  // namespace
}  // namespace edgecase::rasterizer
