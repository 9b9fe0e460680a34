// What every driver that follows the top-left rule at 8 subpixel bits must pass, whatever interface leads to it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>

#include "conformance/scene/standard_samples.h"
#include "conformance/subjects/subject.h"
#include "conformance/tests/grid_triangles.h"

namespace edgecase::conformance {

inline std::unique_ptr<Subject> subject_or_failure(const std::string& name) {
  auto made = make_subject(name);
  if (!made) {
    ADD_FAILURE() << made.error().message;
    return nullptr;
  }
  return std::move(*made);
}

inline Setting square_setting(int side, int samples = 1) {
  const auto locations = standard_sample_locations(samples);
  Setting setting;
  setting.target = {side, side};
  setting.sample_locations.assign(locations.begin(), locations.end());
  return setting;
}

inline Scene random_scene(const Setting& setting, std::size_t count, int low, int high, int step, unsigned seed) {
  Scene scene;
  scene.setting = setting;
  std::mt19937 random(seed);
  while (scene.triangles.size() < count) scene.triangles.push_back(random_triangle(random, low, high, step));
  return scene;
}

inline MaskBatch drawn(Subject& subject, const Scene& scene) {
  MaskBatch masks;
  EXPECT_EQ(subject.refusal(scene), std::nullopt);
  const auto result = subject.draw(scene, masks);
  EXPECT_TRUE(result) << result.error().message;
  if (!result) masks.reset(MaskLayout(scene.setting), 0);
  return masks;
}

/// Every mask equals the exact one; shows the first that does not.
inline void expect_exact(Subject& subject, const Scene& scene) {
  const MaskBatch masks = drawn(subject, scene);
  ASSERT_EQ(masks.size(), scene.triangles.size());
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const Triangle& t = scene.triangles[i];
    ASSERT_THAT(masks[i], testing::ElementsAreArray(exact_mask(scene.setting, t)))
        << "triangle " << i << ": (" << t[0].x << ", " << t[0].y << ") (" << t[1].x << ", " << t[1].y << ") (" << t[2].x
        << ", " << t[2].y << ")";
  }
}

/// Centres on edges and vertices, worked out by hand; all in one batch, so that one triangle's mask would show in
/// another's if they were not kept apart.
inline void expect_hand_checked_masks(Subject& subject) {
  Scene scene;
  scene.setting = square_setting(4);
  scene.triangles = {
      Triangle{{{1.5F, 0}, {1.5F, 3}, {4, 3}}},        // left edge through centres: inside
      Triangle{{{2.5F, 0}, {2.5F, 3}, {0, 3}}},        // right edge through centres: outside
      Triangle{{{0, 1.5F}, {4, 1.5F}, {2, 3.5F}}},     // top edge through centres: inside
      Triangle{{{0, 2.5F}, {4, 2.5F}, {2, 0.5F}}},     // bottom edge through centres: outside
      Triangle{{{0, 0}, {4, 4}, {2, 2}}},              // zero area
      Triangle{{{1, 1}, {1.25F, 1}, {1, 1.25F}}},      // reaches no centre
      Triangle{{{-8, -8}, {24, -8}, {-8, 24}}},        // all of the target
      Triangle{{{4.5F, 0.5F}, {8, 0.5F}, {4.5F, 4}}},  // beside the target
  };
  const std::vector<std::vector<std::string>> expected{
      {".#..", ".##.", ".###", "...."}, {"....", ".#..", "##..", "...."}, {"....", "####", ".##.", "...."},
      {"....", ".##.", "....", "...."}, {"....", "....", "....", "...."}, {"....", "....", "....", "...."},
      {"####", "####", "####", "####"}, {"....", "....", "....", "...."},
  };
  const MaskBatch masks = drawn(subject, scene);
  ASSERT_EQ(masks.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(rows_of(scene.setting, masks[i]), expected[i]) << "triangle " << i;
    std::ranges::reverse(scene.triangles[i]);
  }
  const MaskBatch rewound = drawn(subject, scene);
  EXPECT_TRUE(std::ranges::equal(rewound.data(), masks.data())) << "the other winding covers something else";
}

/// Sizes around the words of a mask, the tiles and the blocks of rasterizers; ties and vertices outside included.
inline void expect_exact_random_triangles(Subject& subject, int samples) {
  for (const int side : {1, 5, 16, 31, 33, 64, 65, 130}) {
    const Setting setting = square_setting(side, samples);
    const std::size_t count = side < 64 ? 1500 : 150;
    expect_exact(subject, random_scene(setting, count, 0, side, 1, 1));
    expect_exact(subject, random_scene(setting, count, -side, 2 * side, 128, 2));
    if (testing::Test::HasFatalFailure()) return;
  }
  expect_exact(subject, random_scene(square_setting(32, samples), 1000, -8192, 8192, 1, 3));
}

}  // namespace edgecase::conformance
