#include "conformance/scene/window_position.h"

#include <gtest/gtest.h>

#include <limits>

namespace edgecase::conformance {
namespace {

constexpr Viewport kViewport{0, 0, 64, 32};

std::optional<Position> at(const ClipPosition& vertex, const Viewport& viewport = kViewport) {
  return exact_window_position(viewport, vertex);
}

TEST(WindowPosition, FollowsTheViewport) {
  EXPECT_EQ(at({-1, -1, 0, 1}), (Position{0, 0}));
  EXPECT_EQ(at({1, 1, 1, 1}), (Position{64, 32}));
  EXPECT_EQ(at({0.25f, -0.5f, 0.5f, 1}), (Position{40, 8}));
  EXPECT_EQ(at({0.25f, -0.5f, 0, 1}, {0.5f, 30.25f, 64, -32}), (Position{40.5f, 22.25f}));
}

TEST(WindowPosition, DividesByPowersOfTwo) {
  EXPECT_EQ(at({0x1p-62f, -0x1p-61f, 0, 0x1p-60f}), (Position{40, 8}));
  EXPECT_EQ(at({0x1p+124f, 0, 0, 0x1p+126f}), (Position{40, 16}));
  EXPECT_FALSE(at({0, 0, 0, 0x1p+127f}));  // 1/w is subnormal
  EXPECT_FALSE(at({0, 0, 0, 0x1p-127f}));  // w is
  // The product with 1/3 as binary32 has it is exact, and no third.
  EXPECT_FALSE(at({1, 0, 0, 3}, {-32, -16, 64, 32}));
  EXPECT_TRUE(at({1, 0, 0, 4}, {-32, -16, 64, 32}));
}

TEST(WindowPosition, TheViewVolumeEndsAtItsBorders) {
  const float past = 1 + std::numeric_limits<float>::epsilon();
  for (const float sign : {-1.0f, 1.0f}) {
    EXPECT_TRUE(at({sign, 0, 0, 1}));
    EXPECT_TRUE(at({0, sign, 0, 1}));
    EXPECT_FALSE(at({sign * past, 0, 0, 1}));
    EXPECT_FALSE(at({0, sign * past, 0, 1}));
  }
  EXPECT_FALSE(at({0, 0, past, 1}));
  EXPECT_FALSE(at({0, 0, -0x1p-149f, 1}));
  EXPECT_FALSE(at({0, 0, 0, 0}));
  EXPECT_FALSE(at({0, 0, 0, -1}));
}

TEST(WindowPosition, NoStepMayRound) {
  EXPECT_TRUE(at({0x1.fffffep-1f, 0, 0, 1}, {-32, -16, 64, 32}));
  EXPECT_FALSE(at({0x1.fffffep-1f, 0, 0, 1}));                     // 32 + 32 * x has 25 bits
  EXPECT_FALSE(at({0x1.fffffep-1f, 0, 0, 1}, {-50, 0, 100, 32}));  // 50 * x has 29 bits
  EXPECT_FALSE(at({0, 0, 0, 1}, {0x1p-20f, 0, 64, 32}));           // so has the centre
  EXPECT_FALSE(at({0x1p-149f, 0, 0, 1}, {-32, -16, 64, 32}));      // lost where subnormal numbers are
}

TEST(WindowPosition, ASceneNeedsEveryVertex) {
  Scene scene;
  scene.triangles = {{{{0.1f, 0}, {1, 0}, {0, 1}}}};
  EXPECT_EQ(exact_window_triangles(scene), scene.triangles);
  scene.triangles.clear();
  scene.clip = ClipGeometry{kViewport, {{{{-1, -1, 0, 1}, {1, -1, 0, 1}, {-1, 1, 0, 1}}}}};
  EXPECT_EQ(exact_window_triangles(scene), (std::vector<Triangle>{{{{0, 0}, {64, 0}, {0, 32}}}}));
  scene.clip->triangles.push_back({{{5, 0, 0, -1}, {0.3f, 0, 0, -2}, {0, 1, 7, -0x1p-140f}}});  // behind the eye
  ASSERT_TRUE(exact_window_triangles(scene));
  EXPECT_EQ(exact_window_triangles(scene)->back(), Triangle{});
  scene.clip->triangles[1][1].w = 0;
  EXPECT_FALSE(exact_window_triangles(scene));
  scene.clip->triangles.pop_back();
  scene.clip->triangles[0][2].y = 2;
  EXPECT_FALSE(exact_window_triangles(scene));
}

}  // namespace
}  // namespace edgecase::conformance
