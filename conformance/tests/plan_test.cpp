#include "rasterizer/threads/plan.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <numeric>
#include <random>
#include <string>

#include "rasterizer/threads/waking.h"

namespace edgecase::rasterizer {
namespace {

using Fixed = FixedTriangle<Format16_8>;

/// Triangles of about `size` px anywhere in the part of `target` left of `right`.
std::vector<Fixed> triangles(const Target& target, std::size_t count, int size, int right) {
  std::mt19937_64 random(1);
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<std::uint64_t>(end)); };
  std::vector<Fixed> list(count);
  for (Fixed& fixed : list) {
    const int x = below((right - size) * 256), y = below((target.height().value() - size) * 256);
    for (auto& v : fixed) v = {*Int<24>::checked(x + below(size * 256)), *Int<24>::checked(y + below(size * 256))};
  }
  return list;
}

Fixed triangle(const std::array<std::array<int, 2>, 3>& pixels) {
  Fixed fixed;
  for (std::size_t i = 0; i < 3; ++i) {
    fixed[i] = {*Int<24>::checked(pixels[i][0] * 256), *Int<24>::checked(pixels[i][1] * 256)};
  }
  return fixed;
}

TEST(Plan, ALittleWorkIsForOneThread) {
  const Target screen = *Target::make(1920, 1080);
  EXPECT_EQ(make_plan({}, screen, 8).threads, 1);
  for (const std::size_t count : {1u, 10u, 100u}) {
    const auto small = triangles(screen, count, 10, 1920);
    EXPECT_FALSE(may_pay(small, screen, 8)) << count;
    EXPECT_EQ(make_plan(small, screen, 8).threads, 1) << count;
  }
  EXPECT_EQ(make_plan(triangles(screen, 100'000, 10, 1920), screen, 8).threads, 8);
  EXPECT_EQ(make_plan(triangles(screen, 100'000, 10, 1920), screen, 1).threads, 1);
  // As many triangles cost less than adding up the masks of a target that large.
  const Target large = *Target::make(16'384, 16'384);
  EXPECT_EQ(make_plan(triangles(large, 10'000, 10, 16'384), large, 2).threads, 1);
}

// What two threads would save of drawing them, moving the target's words costs them; 64 threads save more.
TEST(Plan, OnALargeTargetMoreWorkIsNeeded) {
  const Target large = *Target::make(16'384, 16'384);
  const auto list = triangles(large, 100'000, 200, 16'384);
  const auto first = [&](std::size_t count) { return std::span(list).first(count); };
  EXPECT_FALSE(may_pay(first(2'000), large, 2));
  EXPECT_TRUE(may_pay(first(2'000), large, 64));
  EXPECT_TRUE(may_pay(list, large, 2));
  EXPECT_GT(make_plan(list, large, 2).threads, 1);
}

TEST(Plan, AsMuchWorkAsItTakesToWakeAThreadIsShared) {
  const Target screen = *Target::make(1920, 1080);
  const std::vector<Fixed> whole(100, triangle({{{0, 0}, {1920, 0}, {0, 1080}}}));
  const auto first = [&](std::size_t count) { return std::span(whole).first(count); };
  EXPECT_FALSE(may_pay(first(10), screen, 2));
  EXPECT_EQ(make_plan(first(10), screen, 2).threads, 1);
  EXPECT_TRUE(may_pay(first(100), screen, 2));
  EXPECT_EQ(make_plan(first(100), screen, 2).threads, 2);
  // The last parts of few triangles are single ones, or they would keep the other threads waiting.
  EXPECT_EQ(make_plan(first(100), screen, 2).chunk, 1u);
  // What pays if the other thread is there need not pay if it must be woken.
  EXPECT_EQ(make_plan(first(35), screen, 2).threads, 2);
  EXPECT_FALSE(pays_to_wake(make_plan(first(35), screen, 2)));
  EXPECT_TRUE(pays_to_wake(make_plan(first(100), screen, 2)));
}

// Draws that each save half of what waking costs, soon after each other and with pauses; and draws that save more.
TEST(Waking, WaitsForDrawsThatFollowEachOther) {
  using std::chrono::microseconds;
  const Target screen = *Target::make(1920, 1080);
  Plan plan = make_plan({}, screen, 2, 1, 1);
  plan.estimate = 1e6;
  plan.alone = plan.estimate + delay_by_waking(2) / 2;
  ASSERT_FALSE(pays_to_wake(plan));
  const auto draws = [&](microseconds pause) {
    Waking waking;
    Waking::Time now{std::chrono::hours(1)};
    std::string shared;
    for (int i = 0; i < 12; ++i) {
      const bool shares = waking.shares(plan, now);
      now += microseconds(1000);
      waking.end(shares, now);
      now += pause;
      shared += shares ? '2' : '1';
    }
    return shared;
  };
  EXPECT_EQ(draws(microseconds(99)), "111111112222");
  EXPECT_EQ(draws(microseconds(101)), "111111111111");
  plan.alone = 2 * (plan.estimate + delay_by_waking(2));
  ASSERT_TRUE(pays_to_wake(plan));
  EXPECT_EQ(draws(microseconds(101)), "222222222222");
}

TEST(Plan, AFewLargeTrianglesAmongSmallOnesAreSeen) {
  const Target screen = *Target::make(1920, 1080);
  auto list = triangles(screen, 1'000, 10, 1920);
  for (std::size_t i = 1; i < list.size(); i += 3) list[i] = triangle({{{0, 0}, {1920, 0}, {0, 1080}}});
  EXPECT_EQ(make_plan(list, screen, 2).threads, 2);
}

TEST(Plan, TilesAreForLargeTargetsAndManyThreads) {
  const Target screen = *Target::make(1920, 1080), large = *Target::make(16'384, 16'384);
  const auto on_screen = triangles(screen, 200'000, 30, 1920), on_large = triangles(large, 200'000, 30, 16'384);
  EXPECT_EQ(make_plan(on_screen, screen, 2).grid.count(), 1);
  const int tiles = make_plan(on_large, large, 2).grid.count();
  EXPECT_GT(tiles, 1);
  EXPECT_GT(make_plan(on_large, large, 64).grid.count(), tiles);
}

TEST(Plan, TheWorkIsWhereTheTrianglesAre) {
  const Target large = *Target::make(4'096, 4'096);
  const auto list = triangles(large, 50'000, 30, 1'024);
  const Plan plan = make_plan(list, large, 4, 4, 2);
  ASSERT_EQ(plan.tile_work.size(), 8u);
  for (std::size_t tile = 0; tile < 8; ++tile) {
    if (tile % 4 == 0) {
      EXPECT_GT(plan.tile_work[tile], 1e5);
    } else {
      EXPECT_EQ(plan.tile_work[tile], 0);
    }
  }
  // Of cuts only the costs depend on the grid, not the work.
  const auto sum = [](const Plan& p) { return std::accumulate(p.tile_work.begin(), p.tile_work.end(), 0.0); };
  EXPECT_NEAR(sum(plan) / sum(make_plan(list, large, 4, 1, 1)), 1, 1e-6);
}

TEST(Plan, ListsSortedBySizeAreSharedByWork) {
  const Target screen = *Target::make(1920, 1080);
  std::vector<Fixed> list(100, triangle({{{0, 0}, {1920, 0}, {0, 1080}}}));
  const auto small = triangles(screen, 900, 10, 1920);
  list.insert(list.end(), small.begin(), small.end());
  // A quarter of the work, which is the large ones', for each of two threads; of the list it would be 250.
  const Plan plan = make_plan(list, screen, 2, 1, 1);
  EXPECT_GT(plan.parts.begin(1) * plan.chunk, 10u);
  EXPECT_LT(plan.parts.begin(2) * plan.chunk, 100u);
}

TEST(Plan, ChunksAndPartsSufficeForAllThreads) {
  const Target screen = *Target::make(1920, 1080);
  for (const std::size_t count : {1u, 30u, 2'000u, 100'000u}) {
    const auto list = triangles(screen, count, 30, 1920);
    for (const int side : {1, 2, 16}) {
      const Plan plan = make_plan(list, screen, 16, side, side);
      const auto tiles = static_cast<std::size_t>(plan.grid.count());
      EXPECT_EQ(plan.threads, 16);
      EXPECT_GE(plan.chunk, 1u);
      const std::size_t chunks = (count + plan.chunk - 1) / plan.chunk;
      EXPECT_GE(chunks, std::min<std::size_t>(count, 16 * 8));
      EXPECT_EQ(plan.parts.chunks(), chunks);
      if (side > 1) {
        EXPECT_GE(plan.parts.count() * tiles, std::min<std::size_t>(chunks * tiles, 16 * 32));
      }
    }
  }
}

}  // namespace
}  // namespace edgecase::rasterizer
