// Tiles: what triangles reach, and a tile drawn by itself against its part of the whole target, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "rasterizer/edge.h"
#include "rasterizer/fast/fast.h"

namespace edgecase::rasterizer {
namespace {

using Fixed = FixedTriangle<Format16_8>;

Fixed triangle(const std::array<std::array<int, 2>, 3>& subpixels) {
  Fixed fixed;
  for (std::size_t i = 0; i < 3; ++i)
    fixed[i] = {*Int<24>::checked(subpixels[i][0]), *Int<24>::checked(subpixels[i][1])};
  return fixed;
}

/// The half of a rectangle above its falling diagonal; in pixels.
Fixed half(int left, int top, int right, int bottom) {
  return triangle({{{left * 256, top * 256}, {right * 256, top * 256}, {right * 256, bottom * 256}}});
}

std::vector<Fixed> random_triangles(unsigned seed, const Target& target, std::size_t count) {
  std::mt19937_64 random(seed);
  const auto between = [&](std::int64_t low, std::int64_t high) {
    return static_cast<int>(low + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(high - low + 1)));
  };
  std::vector<Fixed> triangles(count);
  for (Fixed& fixed : triangles) {
    // From less than a pixel to beyond the target; every fourth on the grid of half pixels, where ties are.
    const int extent = 100 << between(0, 13);
    const int grid = between(0, 3) == 0 ? 128 : 1;
    const int x = between(-extent, target.width().value() * 256), y = between(-extent, target.height().value() * 256);
    std::array<std::array<int, 2>, 3> points;
    for (auto& point : points) {
      point = {(x + between(0, extent)) / grid * grid, (y + between(0, extent)) / grid * grid};
    }
    fixed = triangle(points);
  }
  return triangles;
}

/// The tiles that the triangles reach, a bit for each: bit 0 is tile 0.
std::vector<std::uint64_t> reached(Isa isa, const TileGrid& grid, const std::vector<Fixed>& triangles) {
  const auto columns = static_cast<std::size_t>(grid.columns()), rows = static_cast<std::size_t>(grid.rows());
  const std::size_t blocks = (triangles.size() + kReachBlock - 1) / kReachBlock;
  std::vector<std::uint64_t> words(blocks * (columns + rows), 0x5555);
  FastRasterizer::make(isa)->find_reach(triangles, grid, words);
  std::vector<std::uint64_t> tiles(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::uint64_t* block = words.data() + i / kReachBlock * (columns + rows);
    for (std::size_t t = 0; t < columns * rows; ++t) {
      tiles[i] |= ((block[t % columns] & block[columns + t / columns]) >> i % kReachBlock & 1) << t;
    }
  }
  for (std::size_t i = triangles.size(); i < blocks * kReachBlock; ++i) {
    for (std::size_t w = 0; w < columns + rows; ++w) {
      EXPECT_EQ(words[i / kReachBlock * (columns + rows) + w] >> i % kReachBlock & 1, 0u) << "a bit of no triangle";
    }
  }
  return tiles;
}

TEST(TileGrid, TilesCoverTheTargetOnceAndShareNoCacheLine) {
  for (const auto& [width, height] :
       {std::array{1, 1}, std::array{33, 17}, std::array{1920, 1080}, std::array{16384, 7}}) {
    for (const auto& [columns, rows] : {std::array{1, 1}, std::array{2, 3}, std::array{7, 5}, std::array{32, 32}}) {
      const TileGrid grid(*Target::make(width, height), columns, rows);
      long pixels = 0;
      for (int i = 0; i < grid.count(); ++i) {
        const Tile tile = grid.tile(i);
        EXPECT_EQ(tile.left % kStripWidth, 0);
        EXPECT_EQ(tile.top % kMaxLanes, 0);
        EXPECT_GT(tile.width, 0);
        EXPECT_GT(tile.height, 0);
        pixels += static_cast<long>(tile.width) * tile.height;
        for (int j = 0; j < i; ++j) {
          const Tile other = grid.tile(j);
          EXPECT_TRUE(other.left + other.width <= tile.left || tile.left + tile.width <= other.left ||
                      other.top + other.height <= tile.top || tile.top + tile.height <= other.top);
        }
      }
      EXPECT_EQ(pixels, static_cast<long>(width) * height);
    }
  }
}

// Hard case 22: a box divided by the tile's size with truncation puts what is left of the target into the first tile,
// and an end that is taken for the last pixel puts what ends at a tile's border into the next one.
TEST(Reach, EndsAtTilesBordersAreExclusiveAndOutsideIsNowhere) {
  const TileGrid grid(*Target::make(128, 64), 2, 2);  // tiles of 64x32: 0 1 above 2 3
  const std::vector<Fixed> triangles{
      half(10, 10, 20, 20),                                                       // inside the first
      half(0, 0, 64, 32),                                                         // ends where the first does
      half(0, 0, 65, 33),                                                         // a pixel more
      half(64, 32, 128, 64),                                                      // begins and ends where the last does
      half(-20, 10, 0, 20),                                                       // ends where the target begins
      half(-20, 10, -1, 20),                                                      // left of it, by less than a tile
      half(10, -20, 20, 0),                                                       // above
      half(128, 10, 140, 20),                                                     // begins where the target ends
      half(10, 64, 20, 70),                                                       // below
      half(-9'000, -9'000, 9'000, 9'000),                                         // across everything
      triangle({{{10, 10}, {120, 10}, {10, 120}}}),                               // between pixel centres
      triangle({{{64 * 256 - 200, 10}, {64 * 256 + 128, 10}, {64 * 256, 999}}}),  // up to a centre, which is not inside
      triangle({{{64 * 256 - 200, 10}, {64 * 256 + 129, 10}, {64 * 256, 999}}}),  // just beyond
      triangle({{{64 * 256 + 128, 10}, {64 * 256 + 500, 10}, {64 * 256 + 200, 999}}}),  // from a centre on
  };
  const std::vector<std::uint64_t> expected{1, 1, 15, 8, 0, 0, 0, 0, 0, 15, 0, 1, 3, 2};
  for (const Isa isa : available_isas()) EXPECT_EQ(reached(isa, grid, triangles), expected) << name_of(isa);
}

TEST(Reach, IsThatOfThePixelBox) {
  const Target target = *Target::make(300, 200);
  const std::vector<Fixed> triangles = random_triangles(5, target, 1'000 + 37);
  for (const Isa isa : available_isas()) {
    for (const auto& [columns, rows] : {std::array{1, 1}, std::array{3, 5}, std::array{7, 9}}) {
      const TileGrid grid(target, columns, rows);
      const auto tiles = reached(isa, grid, triangles);
      for (std::size_t i = 0; i < triangles.size(); ++i) {
        std::uint64_t expected = 0;
        for (int t = 0; t < grid.count(); ++t) {
          const Tile tile = grid.tile(t);
          const auto sample_in = [](std::int32_t a, std::int32_t b, std::int32_t c, int begin, int size) {
            const auto [low, high] = std::minmax({a, b, c});
            for (int pixel = begin; pixel < begin + size; ++pixel) {
              if (low <= pixel * 256 + 128 && pixel * 256 + 128 < high) return true;
            }
            return false;
          };
          const auto& [v0, v1, v2] = triangles[i];
          if (sample_in(v0.x.value(), v1.x.value(), v2.x.value(), tile.left, tile.width) &&
              sample_in(v0.y.value(), v1.y.value(), v2.y.value(), tile.top, tile.height)) {
            expected |= std::uint64_t{1} << t;
          }
        }
        ASSERT_EQ(tiles[i], expected) << name_of(isa) << ", triangle " << i;
      }
    }
  }
}

TEST(TileMask, ATileIsItsPartOfTheTarget) {
  for (const auto& [width, height] : {std::array{300, 200}, std::array{97, 330}}) {
    const Target target = *Target::make(width, height);
    const TileGrid grid(target, 3, 5);
    for (const Isa isa : available_isas()) {
      const FastRasterizer fast = *FastRasterizer::make(isa);
      TileMask tile_mask;
      for (unsigned seed = 0; seed < 40; ++seed) {
        // Few of them, to leave pixels uncovered.
        const std::vector<Fixed> triangles = random_triangles(seed, target, 17);
        StripMask expected(target), observed(target);
        fast.cover_union(triangles, expected);
        for (int t = 0; t < grid.count(); ++t) {
          tile_mask.begin(grid.tile(t));
          fast.cover_tile(triangles, tile_mask);
          fast.add_strips(tile_mask, observed, 0, static_cast<std::size_t>(tile_mask.strips().count));
        }
        std::vector<std::uint64_t> expected_rows(target.mask_words()), observed_rows(target.mask_words());
        expected.to_rows(expected_rows);
        observed.to_rows(observed_rows);
        ASSERT_EQ(observed_rows, expected_rows) << name_of(isa) << ", seed " << seed;
      }
    }
  }
}

TEST(TileMask, VerticesAtBothEndsOfTheFormatMoveWithTheTile) {
  const Target target = *Target::make(16384, 16384);
  constexpr int kLow = -(1 << 23), kHigh = (1 << 23) - 1;
  const std::vector<Fixed> triangles{triangle({{{kLow, kLow}, {kHigh, kLow + 7}, {kLow + 3, kHigh}}}),
                                     triangle({{{kHigh, kHigh}, {kHigh - 1'000, kLow}, {kLow, kHigh - 5}}}),
                                     triangle({{{kLow, 16'000 * 256}, {kHigh, 16'300 * 256}, {kLow, 16'001 * 256}}})};
  const FastRasterizer fast;
  StripMask expected(target);
  for (const Fixed& fixed : triangles) {
    expected.clear();
    fast.cover_union({&fixed, 1}, expected);
    const Tile tile = TileGrid(target, 32, 32).tile(32 * 32 - 1);
    TileMask tile_mask;
    tile_mask.begin(tile);
    fast.cover_tile({&fixed, 1}, tile_mask);
    const Strips whole = expected.strips(), part = tile_mask.strips();
    for (std::size_t strip = 0; strip < static_cast<std::size_t>(part.count); ++strip) {
      for (std::size_t row = 0; row < static_cast<std::size_t>(part.height); ++row) {
        const std::size_t whole_strip = static_cast<std::size_t>(tile.left / kStripWidth) + strip;
        ASSERT_EQ(part.words[strip * part.stride + row],
                  whole.words[whole_strip * whole.stride + static_cast<std::size_t>(tile.top) + row]);
      }
    }
  }
}

}  // namespace
}  // namespace edgecase::rasterizer
