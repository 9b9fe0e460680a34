#include "conformance/scene/coordinates.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "conformance/scene/grid.h"
#include "conformance/scene/nearest_even.h"
#include "conformance/subjects/enclosing_viewport.h"

namespace edgecase::conformance {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// `count` triangles whose coordinates are all `filler`, but for one.
std::vector<Triangle> with(std::size_t count, std::size_t place, float value, float filler = 1) {
  std::vector<Triangle> triangles(count, {{{filler, filler}, {filler, filler}, {filler, filler}}});
  Position& position = triangles[place / 6][place / 2 % 3];
  (place % 2 == 0 ? position.x : position.y) = value;
  return triangles;
}

TEST(Coordinates, OneOutOfRangeIsFoundWhereverItIs) {
  EXPECT_TRUE(all_within({}, 7));
  for (std::size_t count = 1; count < 20; ++count) {
    for (std::size_t place = 0; place < 6 * count; ++place) {
      for (const float within : {0.0f, -0.0f, 0.5f, -0.5f, 7.0f, -7.0f}) {
        ASSERT_TRUE(all_within(with(count, place, within), 7, 0.5f)) << count << ' ' << place << ' ' << within;
      }
      for (const float outside : {std::nextafter(-7.0f, -8.0f), std::nextafter(0.5f, 0.0f), kInfinity, -kNan}) {
        ASSERT_FALSE(all_within(with(count, place, outside), 7, 0.5f)) << count << ' ' << place << ' ' << outside;
      }
    }
  }
  EXPECT_TRUE(all_within(with(3, 17, std::numeric_limits<float>::denorm_min()), 7));
  EXPECT_FALSE(all_within(with(3, 17, 0, 0), -1));
}

TEST(Coordinates, OnePointOffTheGridIsFoundWhereverItIs) {
  for (std::size_t count = 1; count < 20; ++count) {
    for (std::size_t place = 0; place < 6 * count; ++place) {
      ASSERT_TRUE(all_on_grid(with(count, place, -3.25f), 256));
      ASSERT_FALSE(all_on_grid(with(count, place, -3.25f), 2));
      ASSERT_FALSE(all_on_grid(with(count, place, std::nextafter(-3.25f, 0.0f)), 256));
    }
  }
  for (const float beyond : {kNan, kInfinity, -kInfinity, 16385.0f, -1e9f, 1e38f}) {
    EXPECT_FALSE(all_on_grid(with(2, 7, beyond), 256)) << beyond;
  }
  EXPECT_EQ(grid_point({-3.25f, 16383.5f}, 256), (GridPoint{-832, 4194176}));
}

TEST(Coordinates, AViewportCarriesAllIfItCarriesEach) {
  const EnclosingViewport viewport(8192);
  const float least = std::numeric_limits<float>::min() * 8192;
  for (const float value : {0.0f, 8192.0f, -8192.0f, std::nextafter(8192.0f, 9000.0f), 0.1f, least, -least,
                            std::nextafter(least, 0.0f), kNan, kInfinity, std::numeric_limits<float>::denorm_min()}) {
    EXPECT_EQ(viewport.carries(with(3, 11, value)), viewport.carries(value)) << value;
  }
}

TEST(NearestEven, IsWhatTheLibraryRoundsToBitForBit) {
  const auto expect = [](float value) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(nearest_even(value)), std::bit_cast<std::uint32_t>(std::nearbyint(value)))
        << value;
  };
  std::mt19937 random(1);
  for (int i = 0; i < 1'000'000; ++i) {
    const auto pattern = static_cast<std::uint32_t>(random());
    if (std::isfinite(std::bit_cast<float>(pattern))) expect(std::bit_cast<float>(pattern));
  }
  for (int half = -20'000; half <= 20'000; ++half) {
    const float tie = static_cast<float>(half) / 2;
    for (const float value : {tie, std::nextafter(tie, kInfinity), std::nextafter(tie, -kInfinity)}) expect(value);
  }
  for (const float limit : {0x1p22F, -0x1p22F, 0x1p23F, -0x1p23F}) {
    for (const float value : {limit, std::nextafter(limit, 0.0F), std::nextafter(limit, 2 * limit)}) expect(value);
  }
}

}  // namespace
}  // namespace edgecase::conformance
