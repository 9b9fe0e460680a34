#include "rasterizer/threads/tiled_draw.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace edgecase::rasterizer {
namespace {

using Fixed = FixedTriangle<Format16_8>;

Fixed right_angle(int x, int y, int size) {
  const auto at = [](int pixel) { return *Int<24>::checked(pixel * 256); };
  return {{{at(x), at(y)}, {at(x + size), at(y)}, {at(x), at(y + size)}}};
}

std::vector<std::uint64_t> rows(const StripMask& mask) {
  std::vector<std::uint64_t> words(mask.target().mask_words());
  mask.to_rows(words);
  return words;
}

struct Drawing {
  Target target = *Target::make(128, 64);
  std::vector<Fixed> triangles{right_angle(5, 5, 9), right_angle(70, 40, 20), right_angle(60, 20, 30),
                               right_angle(10, 10, 3), right_angle(100, 1, 5)};
  FastRasterizer fast;
  StripMask mask{target};
  TiledDraw::Memory memory;
  Plan plan{TileGrid(target, 2, 2), 2, 2, Parts::even(3, 3), std::vector<double>(4, 1), 0, 0, 0};
};

TEST(TiledDraw, PartsMayBeDrawnInAnyOrder) {
  Drawing d;
  StripMask expected(d.target);
  d.fast.cover_union(d.triangles, expected);
  TiledDraw draw(d.fast, d.triangles, d.plan, d.mask, d.memory);
  ASSERT_EQ(draw.chunks(), 3u);
  for (const std::size_t chunk : {2u, 0u, 1u}) draw.bin(chunk);
  TiledDraw::Canvas one(0), other(1);
  // Both canvases have parts of every tile.
  for (const int tile : {3, 1, 0, 2}) {
    draw.draw({tile, 1}, other);
    draw.draw({tile, 2}, one);
    draw.draw({tile, 0}, one);
  }
  EXPECT_NE(rows(d.mask), rows(expected));
  draw.finish(one);
  draw.finish(other);
  EXPECT_EQ(rows(d.mask), rows(expected));
}

// Without oneTBB, whose library hides from a race detector what its threads wait for: the preset `tsan` runs this test
// and the agenda's. Of rasterizer_threads_test it reports what oneTBB's fork and join order, as it does not see them:
// with both annotated by __tsan_release and __tsan_acquire, only oneTBB's own task objects, and the stack frame that
// holds what the task captures, are left.
TEST(TiledDraw, AnyThreadsCanDoTheWork) {
  Drawing d;
  for (int i = 0; i < 2'000; ++i) d.triangles.push_back(right_angle(i * 7 % 120, i * 5 % 60, i % 11));
  StripMask expected(d.target);
  d.fast.cover_union(d.triangles, expected);
  for (const int side : {1, 2, 3}) {
    for (int round = 0; round < 10; ++round) {
      d.mask.clear();
      const Plan plan{TileGrid(d.target, side, side),
                      4,
                      64,
                      side == 1 ? Parts::falling(32, 4, std::array{2.0, 1.0}) : Parts::even(32, 11),
                      std::vector<double>(static_cast<std::size_t>(side * side), 1),
                      0,
                      0,
                      0};
      std::vector<TiledDraw::Canvas> canvases;
      for (std::size_t i = 0; i < 4; ++i) canvases.emplace_back(i);
      TiledDraw draw(d.fast, d.triangles, plan, d.mask, d.memory);
      {
        std::vector<std::jthread> threads;
        for (auto& canvas : canvases) threads.emplace_back([&] { draw.work(canvas); });
      }
      ASSERT_EQ(rows(d.mask), rows(expected));
    }
  }
}

TEST(TiledDraw, ASingleTileIsDrawnInPlaceAndNobodyWaitsForWhoHasNotBegun) {
  Drawing d;
  StripMask expected(d.target);
  d.fast.cover_union(d.triangles, expected);
  const Plan plan{TileGrid(d.target, 1, 1), 2, 1, Parts::even(5, 5), {5}, 0, 0, 2.5};
  TiledDraw::Canvas own(0), other(1);
  {
    TiledDraw draw(d.fast, d.triangles, plan, d.mask, d.memory);
    draw.draw({0, 0}, other);
    EXPECT_EQ(rows(d.mask), std::vector<std::uint64_t>(d.target.mask_words()));
    for (const std::size_t part : {1u, 4u, 2u}) draw.draw({0, part}, own);
    EXPECT_NE(rows(d.mask), std::vector<std::uint64_t>(d.target.mask_words()));
    EXPECT_NE(rows(d.mask), rows(expected));
    draw.draw({0, 3}, other);
    std::jthread other_thread([&] { draw.finish(other); });
    draw.finish(own);  // waits for the other one
    other_thread.join();
    EXPECT_EQ(rows(d.mask), rows(expected));
  }
  d.mask.clear();
  TiledDraw draw(d.fast, d.triangles, plan, d.mask, d.memory);
  draw.work(own);
  EXPECT_EQ(rows(d.mask), rows(expected));
  draw.work(other);
  EXPECT_EQ(rows(d.mask), rows(expected));
}

TEST(TiledDraw, DrawingWaitsForBins) {
  using namespace std::chrono_literals;
  Drawing d;
  StripMask expected(d.target);
  d.fast.cover_union(d.triangles, expected);
  TiledDraw::Canvas canvas(0);
  // The second drawing finds the first one's bins in the memory, which must not be taken for its own.
  for (int round = 0; round < 2; ++round) {
    d.mask.clear();
    TiledDraw draw(d.fast, d.triangles, d.plan, d.mask, d.memory);
    std::atomic<bool> drawn = false;
    std::jthread drawer([&] {
      for (int tile = 0; tile < 4; ++tile) {
        for (std::size_t part = 0; part < 3; ++part) draw.draw({tile, part}, canvas);
      }
      draw.finish(canvas);
      drawn = true;
    });
    std::this_thread::sleep_for(5ms);
    draw.bin(0);
    draw.bin(2);
    std::this_thread::sleep_for(5ms);
    EXPECT_FALSE(drawn);
    draw.bin(1);
    drawer.join();
    EXPECT_EQ(rows(d.mask), rows(expected));
  }
}

}  // namespace
}  // namespace edgecase::rasterizer
