#include "conformance/bench/workloads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "conformance/bench/geometry.h"
#include "conformance/generators/random.h"
#include "conformance/oracle/oracle.h"

namespace edgecase::conformance {
namespace {

/// Vertices in subpixels.
std::array<GridPoint, 3> snapped(const Scene& scene, const Triangle& triangle) {
  return {oracle::snap(scene.rules, triangle[0]), oracle::snap(scene.rules, triangle[1]),
          oracle::snap(scene.rules, triangle[2])};
}

std::int64_t doubled_area(const std::array<GridPoint, 3>& p) {
  return (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
}

std::int64_t squared(const GridPoint& p, const GridPoint& q) {
  return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
}

std::int64_t squared_longest_edge(const std::array<GridPoint, 3>& p) {
  return std::max({squared(p[0], p[1]), squared(p[1], p[2]), squared(p[2], p[0])});
}

TEST(Workloads, AreKnownByName) {
  std::vector<std::string_view> names;
  for (const Workload& workload : workloads()) names.push_back(workload.name);
  EXPECT_THAT(names, testing::ElementsAre("small10", "med200", "large20k", "full", "sliver", "mesh512", "ties"));
  EXPECT_EQ(find_workload("sliver")->triangles, 5'000u);
  EXPECT_EQ(find_workload("slivers"), nullptr);
}

TEST(Workloads, LieOnTheGridAndOnTheScreen) {
  for (const Workload& workload : workloads()) {
    SCOPED_TRACE(workload.name);
    const Scene scene = make_workload(workload, 20'000);
    EXPECT_EQ(scene.triangles.size(), std::min<std::size_t>(workload.triangles, 20'000));
    const float steps = workload.name == "ties" ? 2 : 256;
    for (const Triangle& triangle : scene.triangles) {
      for (const Position& p : triangle) {
        ASSERT_TRUE(p.x >= 0 && p.x <= 1920 && p.y >= 0 && p.y <= 1080) << p.x << ", " << p.y;
        ASSERT_TRUE(p.x * steps == std::floor(p.x * steps) && p.y * steps == std::floor(p.y * steps));
      }
    }
  }
}

TEST(Workloads, TheFirstTrianglesAreThoseOfTheWholeAndDependOnTheSeed) {
  for (const Workload& workload : workloads()) {
    SCOPED_TRACE(workload.name);
    const Scene few = make_workload(workload, 100, 7);
    const Scene more = make_workload(workload, 5'000, 7);
    ASSERT_LE(few.triangles.size(), more.triangles.size());
    EXPECT_TRUE(std::equal(few.triangles.begin(), few.triangles.end(), more.triangles.begin()));
    if (workload.name != "full") {
      EXPECT_NE(few.triangles, make_workload(workload, 100, 8).triangles);
    }
  }
}

TEST(Workloads, TrianglesOfOneAreaHaveItAndAreNotThin) {
  for (const auto& [name, area] : {std::pair{"small10", 10.0}, {"med200", 200.0}, {"large20k", 20'000.0}}) {
    SCOPED_TRACE(name);
    const Scene scene = make_workload(*find_workload(name), 20'000);
    for (const Triangle& triangle : scene.triangles) {
      const auto p = snapped(scene, triangle);
      const double observed = static_cast<double>(std::abs(doubled_area(p)));
      // Each vertex moves by at most half a subpixel along each axis, which changes the doubled area, in square
      // subpixels, by at most the sum of half the edges' extents along both axes, and a little of second order.
      const double longest = std::sqrt(static_cast<double>(squared_longest_edge(p)));
      EXPECT_LE(std::abs(observed - 2 * area * 65536), 3 * std::sqrt(2.0) / 2 * longest + 2);
      EXPECT_GE(observed / 2, 0.12 * longest * longest - 4 * longest);
    }
  }
}

TEST(Workloads, SliversAreLongAndThin) {
  const Scene scene = make_workload(*find_workload("sliver"), 5'000);
  bool rising = false, falling = false;
  for (const Triangle& triangle : scene.triangles) {
    const auto p = snapped(scene, triangle);
    const double longest = std::sqrt(static_cast<double>(squared_longest_edge(p))) / 256;
    const double width = static_cast<double>(std::abs(doubled_area(p))) / 65536 / longest;
    ASSERT_TRUE(longest > 999 && longest < 1'001) << longest;
    ASSERT_TRUE(width > 0.49 && width < 1.01) << width;
    ((p[1].x > p[0].x) == (p[1].y > p[0].y) ? falling : rising) = true;
  }
  EXPECT_TRUE(rising && falling);
}

TEST(Workloads, TheMeshIsClockwiseAndFillsTheScreen) {
  const Workload& mesh = *find_workload("mesh512");
  const Scene scene = make_workload(mesh, mesh.triangles);
  EXPECT_THAT(scene.meshes, testing::ElementsAre(Mesh{0, mesh.triangles}));
  std::int64_t sum = 0;
  for (const Triangle& triangle : scene.triangles) {
    const std::int64_t area = doubled_area(snapped(scene, triangle));
    ASSERT_GT(area, 0);
    sum += area;
  }
  EXPECT_EQ(sum, std::int64_t{2} * 1920 * 1080 * 65536);
}

TEST(Workloads, FullCoversTheScreenByEitherDiagonal) {
  const Scene scene = make_workload(*find_workload("full"), 4);
  for (const std::size_t first : {0u, 2u}) {
    EXPECT_EQ(doubled_area(snapped(scene, scene.triangles[first])), std::int64_t{1920} * 1080 * 65536);
    EXPECT_EQ(doubled_area(snapped(scene, scene.triangles[first + 1])), std::int64_t{1920} * 1080 * 65536);
  }
  EXPECT_NE(scene.triangles[0], scene.triangles[2]);
}

TEST(Geometry, IsTheOraclesWhereTheOracleSnapsNothing) {
  Scene scene;
  scene.setting.target = {75, 40};
  scene.rules.subpixel_bits = 16;
  Random random(41);
  std::uint64_t covered = 0;
  for (int i = 0; i < 20'000; ++i) {
    // Multiples of 1/2, 1/4, .. 2^-16 px: the coarse ones put centres on edges.
    const int bits = 1 + i % 16;
    const auto coordinate = [&](int extent) {
      return std::ldexp(static_cast<float>(random.between(-(4 << bits), (extent + 4) << bits)), -bits);
    };
    Triangle triangle;
    for (Position& p : triangle) {
      const float x = coordinate(75);
      p = {x, coordinate(40)};
    }
    const MaskLayout layout(scene.setting);
    std::vector<std::uint64_t> observed(layout.words()), expected(layout.words());
    cover_geometry(triangle, scene.setting.target, observed);
    oracle::cover_by_shift(scene.setting, scene.rules, triangle, expected);
    ASSERT_EQ(observed, expected) << i;
    for (const std::uint64_t word : observed) covered += static_cast<std::uint64_t>(std::popcount(word));
  }
  EXPECT_GT(covered, 1'000'000u);
}

TEST(Geometry, OffTheGridSnapsToTheWorkload) {
  for (const Workload& workload : workloads()) {
    SCOPED_TRACE(workload.name);
    const auto off = make_off_grid(workload, 2'000);
    EXPECT_EQ(off.has_value(), workload.name != "full" && workload.name != "ties");
    if (!off) continue;
    const Scene on = make_workload(workload, 2'000);
    std::size_t moved = 0;
    ASSERT_EQ(off->triangles.size(), on.triangles.size());
    for (std::size_t i = 0; i < on.triangles.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Position p = off->triangles[i][k];
        ASSERT_EQ(oracle::snap(off->rules, p), oracle::snap(on.rules, on.triangles[i][k]));
        ASSERT_EQ(std::ldexp(p.x, kGeometryBits), std::floor(std::ldexp(p.x, kGeometryBits)));
        moved += p != on.triangles[i][k];
      }
    }
    EXPECT_GT(moved, on.triangles.size() * 3 * 99 / 100);
    EXPECT_EQ(off->meshes, on.meshes);
    if (workload.name == "mesh512") {
      EXPECT_EQ(off->triangles[0][2], off->triangles[1][1]);
    }
  }
}

}  // namespace
}  // namespace edgecase::conformance
