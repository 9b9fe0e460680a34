// Several threads against one, bit for bit.
#include "rasterizer/threads/threads.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "conformance/bench/workloads.h"
#include "conformance/generators/generator.h"
#include "rasterizer/snap.h"

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

TEST(ThreadedRasterizer, OneCallLeavesNothingToTheNext) {
  const FastRasterizer fast;
  ThreadedRasterizer threaded(fast, 4);
  for (unsigned call = 0; call < 30; ++call) {
    // Two targets in turn; sparse, so that a bit left behind shows.
    const Target target = call / 3 % 2 == 0 ? *Target::make(90, 80) : *Target::make(80, 90);
    std::vector<Fixed> triangles = random_triangles(call, target, 400, 2'000);
    for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = triangles[i % 7];
    StripMask expected(target), observed(target);
    fast.cover_union(triangles, expected);
    const int tiles = call % 2 == 0 ? 1 : 3;
    threaded.cover_union(triangles, observed, make_plan(triangles, target, 4, tiles, tiles));
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
  threaded.cover_union(before, observed, make_plan(before, target, 3, 1, 2));
  threaded.cover_union(after, observed, make_plan(after, target, 3, 2, 2));
  EXPECT_EQ(rows(observed), rows(expected));
  threaded.cover_union({}, observed);
  EXPECT_EQ(rows(observed), rows(expected));
}

/// With whatever plan, and however many threads: nothing but the plan's fields decides who draws what.
void expect_same_for_all_plans(const std::vector<Fixed>& triangles, const Target& target, const std::string& what) {
  const FastRasterizer fast;
  StripMask expected(target);
  fast.cover_union(triangles, expected);
  for (const int threads : {1, 2, 3, 8}) {
    ThreadedRasterizer threaded(fast, threads);
    StripMask by_itself(target);
    threaded.cover_union(triangles, by_itself);
    ASSERT_EQ(rows(by_itself), rows(expected)) << what << ", " << threads << " threads";
    for (const auto& [tile_columns, tile_rows] : {std::array{1, 1}, std::array{2, 3}, std::array{5, 7}}) {
      Plan plan = make_plan(triangles, target, threads, tile_columns, tile_rows);
      plan.chunk = std::max<std::size_t>(plan.chunk / 3, 1);
      const std::size_t chunks = std::max<std::size_t>((triangles.size() + plan.chunk - 1) / plan.chunk, 1);
      plan.parts = tile_columns == 1   ? Parts::falling(chunks, static_cast<std::size_t>(threads), std::array{1.0, 5.0})
                   : tile_columns == 2 ? Parts::even(chunks, chunks / 2 + 1)
                                       : Parts::even(chunks, chunks);
      plan.least_help = 0;
      StripMask observed(target);
      threaded.cover_union(triangles, observed, plan);
      ASSERT_EQ(rows(observed), rows(expected))
          << what << ", " << threads << " threads, " << tile_columns << "x" << tile_rows << " tiles";
    }
  }
}

std::vector<Fixed> snapped(const conformance::Scene& scene) {
  std::vector<Fixed> triangles;
  for (const auto& [v0, v1, v2] : scene.triangles) {
    Fixed fixed;
    if (!snap<Format16_8>(Triangle{{{v0.x, v0.y}, {v1.x, v1.y}, {v2.x, v2.y}}}, fixed)) triangles.push_back(fixed);
  }
  return triangles;
}

TEST(ThreadedRasterizer, AnyNumberOfThreadsAndTilesGivesTheSameBits) {
  for (const auto& [width, height] : {std::array{1, 1}, std::array{200, 100}, std::array{700, 33}}) {
    const Target target = *Target::make(width, height);
    for (const int extent : {1'000, 10'000, 200'000}) {
      // Few enough to leave pixels uncovered.
      expect_same_for_all_plans(random_triangles(3, target, 1'000, extent), target,
                                std::to_string(width) + "x" + std::to_string(height));
    }
  }
}

TEST(ThreadedRasterizer, EveryWorkloadIsDrawnAlikeByAnyPlan) {
  for (const auto& workload : conformance::workloads()) {
    const auto scene = conformance::make_workload(workload, 1'500);
    expect_same_for_all_plans(snapped(scene), *Target::make(1920, 1080), std::string(workload.name));
  }
}

TEST(ThreadedRasterizer, EveryGeneratorIsDrawnAlikeByAnyPlan) {
  for (const auto& generator : conformance::generators()) {
    conformance::Scene scene;
    scene.setting = generator.setting;
    scene.rules.subpixel_bits = 8;
    for (std::uint64_t index = 0; scene.triangles.size() < 1'500; ++index) {
      conformance::append_scene(generator, 7, index, scene);
    }
    const auto& [width, height] = scene.setting.target;
    expect_same_for_all_plans(snapped(scene), *Target::make(width, height), std::string(generator.name));
  }
}

TEST(ThreadedRasterizer, AllTrianglesInOneTileAreSharedByThreads) {
  const Target target = *Target::make(1'000, 1'000);
  std::vector<Fixed> triangles = random_triangles(4, *Target::make(90, 90), 3'000, 1'000);
  triangles.push_back(random_triangles(5, target, 1, 200'000).front());
  expect_same_for_all_plans(triangles, target, "a crowded corner");
}

}  // namespace
}  // namespace edgecase::rasterizer
