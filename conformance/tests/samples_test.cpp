// Sample locations, scissors and culling: our rasterizer, the faults' host and both oracles against each other, and the
// standard patterns by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "conformance/generators/random.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/standard_samples.h"
#include "conformance/subjects/edgecase_subject.h"
#include "conformance/subjects/fault_subject.h"

namespace edgecase::conformance {
namespace {

std::vector<SampleLocation> standard(int samples) {
  const auto locations = standard_sample_locations(samples);
  return {locations.begin(), locations.end()};
}

class Judges {
 public:
  /// That everyone gives the same masks for `scene`. Our rasterizer is asked for every triangle, the oracles for one in
  /// `oracle_share`.
  void expect_agreement(const Scene& scene, std::size_t oracle_share) {
    ASSERT_EQ(ours_->refusal(scene), std::nullopt);
    ASSERT_TRUE(ours_->draw(scene, observed_));
    ASSERT_EQ(host_->refusal(scene), std::nullopt);
    ASSERT_TRUE(host_->draw(scene, expected_));
    std::vector<std::uint64_t> mask(MaskLayout(scene.setting).words());
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      ASSERT_TRUE(std::ranges::equal(observed_[i], expected_[i])) << "the host, triangle " << i;
      if (i % oracle_share != 0) continue;
      oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], mask);
      ASSERT_TRUE(std::ranges::equal(observed_[i], mask)) << "by definition, triangle " << i;
      oracle::cover_by_shift(scene.setting, scene.rules, scene.triangles[i], mask);
      ASSERT_TRUE(std::ranges::equal(observed_[i], mask)) << "by shift, triangle " << i;
    }
  }

 private:
  std::unique_ptr<Subject> ours_ = make_edgecase_subject("");
  std::unique_ptr<Subject> host_ = make_faultless_subject();
  MaskBatch observed_, expected_;
};

/// Triangles near the target on the half pixels, on the sixteenths (where most standard samples are hit exactly), or on
/// the subpixel grid; one in eight reaches far out.
std::vector<Triangle> random_triangles(Random& random, int subpixel_bits, std::size_t count) {
  std::vector<Triangle> triangles(count);
  for (Triangle& triangle : triangles) {
    const int kinds[] = {1, std::min(4, subpixel_bits), subpixel_bits};
    const int bits = kinds[random.between(0, 2)];
    const std::int64_t reach = random.one_in(8) ? 30'000 : 40;
    for (Position& position : triangle) {
      const auto coordinate = [&] {
        return std::ldexp(static_cast<float>(random.between(-reach / 4 << bits, reach << bits)), -bits);
      };
      position = {coordinate(), coordinate()};
    }
  }
  return triangles;
}

Rect random_scissor(Random& random) {
  const auto at = [&] { return static_cast<int>(random.between(-8, 24)); };
  return {at(), at(), at(), at()};
}

TEST(Samples, EveryoneAgreesOnStandardAndCustomLocations) {
  Random random(11);
  Judges judges;
  for (int round = 0; round < 200; ++round) {
    Scene scene;
    scene.rules.subpixel_bits = static_cast<int>(random.between(1, 14));
    scene.setting.target = {static_cast<int>(random.between(1, 24)), static_cast<int>(random.between(1, 24))};
    if (random.one_in(3)) {
      scene.setting.sample_locations.resize(static_cast<std::size_t>(random.between(1, 16)));
      for (SampleLocation& location : scene.setting.sample_locations) {
        location = {static_cast<int>(random.between(0, 15)), static_cast<int>(random.between(0, 15))};
      }
    } else {
      scene.setting.sample_locations = standard(1 << random.between(0, 4));
    }
    if (random.one_in(2)) scene.setting.scissor = random_scissor(random);
    scene.setting.cull = static_cast<CullMode>(random.between(0, 2));
    scene.setting.front_face = static_cast<FrontFace>(random.between(0, 1));
    scene.triangles = random_triangles(random, scene.rules.subpixel_bits, 100);
    ASSERT_NO_FATAL_FAILURE(judges.expect_agreement(scene, 20)) << "round " << round;
  }
}

// A triangle whose bounding box ends exactly on the outermost samples of a pattern, on each side: what a box that knows
// only the centre, or only the first sample, loses.
TEST(Samples, TrianglesThatTouchTheOutermostSamples) {
  Judges judges;
  for (const int samples : {1, 2, 4, 8, 16}) {
    const auto locations = standard(samples);
    Scene scene;
    scene.setting.target = {5, 5};
    scene.setting.sample_locations = locations;
    for (const SampleLocation& location : locations) {
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          const float x = 2 + static_cast<float>(location.x) / 16 + static_cast<float>(dx) / 256;
          const float y = 2 + static_cast<float>(location.y) / 16 + static_cast<float>(dy) / 256;
          for (const float far : {-3.0f, 3.0f}) {
            scene.triangles.push_back({{{x, y}, {x + far, y}, {x, y + far}}});
            scene.triangles.push_back({{{x, y}, {x + far, y}, {x, y - far}}});
          }
        }
      }
    }
    ASSERT_NO_FATAL_FAILURE(judges.expect_agreement(scene, 1)) << locations.size() << " samples";
  }
}

// Rows of 3 samples a pixel end in the middle of a pixel; 21 pixels are 63 bits, 22 are 66.
TEST(Samples, PixelsThatStraddleTwoWords) {
  Judges judges;
  Random random(12);
  Scene scene;
  scene.setting.target = {66, 3};
  scene.setting.sample_locations = {{2, 2}, {8, 13}, {15, 0}};
  scene.triangles = random_triangles(random, 8, 2'000);
  scene.triangles.push_back({{{-100, -100}, {300, -100}, {-100, 300}}});
  ASSERT_NO_FATAL_FAILURE(judges.expect_agreement(scene, 20));
}

TEST(Samples, OneSampleOffTheCentreIsThePixelMoved) {
  // Moving sample and triangle by the same amount changes nothing.
  Random random(13);
  const auto ours = make_edgecase_subject("");
  Scene centred;
  centred.setting.target = {16, 16};
  centred.triangles = random_triangles(random, 8, 500);
  Scene moved = centred;
  moved.setting.sample_locations = {{3, 13}};
  for (Triangle& triangle : moved.triangles) {
    for (Position& p : triangle) p = {p.x - 5.0f / 16, p.y + 5.0f / 16};
  }
  MaskBatch expected, observed;
  ASSERT_TRUE(ours->draw(centred, expected) && ours->draw(moved, observed));
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_TRUE(std::ranges::equal(expected[i], observed[i])) << i;
}

/// What everyone says of a triangle on a 4x4 target: the number of samples covered.
int covered_by_all(const Setting& setting, const Triangle& triangle) {
  Scene scene;
  scene.setting = setting;
  scene.triangles = {triangle};
  Judges judges;
  judges.expect_agreement(scene, 1);
  std::vector<std::uint64_t> mask(MaskLayout(setting).words());
  oracle::cover_by_definition(setting, {}, triangle, mask);
  int count = 0;
  for (const std::uint64_t row : mask) count += std::popcount(row);
  return count;
}

TEST(Culling, DropsTheSideThatIsNamed) {
  const Triangle clockwise{{{0, 0}, {4, 0}, {0, 4}}};
  const Triangle counter_clockwise{{{0, 0}, {0, 4}, {4, 0}}};
  Setting setting;
  setting.target = {4, 4};
  const auto counts = [&](CullMode cull, FrontFace front_face) {
    setting.cull = cull;
    setting.front_face = front_face;
    return std::pair{covered_by_all(setting, clockwise), covered_by_all(setting, counter_clockwise)};
  };
  EXPECT_EQ(counts(CullMode::none, FrontFace::clockwise), std::pair(6, 6));
  EXPECT_EQ(counts(CullMode::none, FrontFace::counter_clockwise), std::pair(6, 6));
  EXPECT_EQ(counts(CullMode::back, FrontFace::clockwise), std::pair(6, 0));
  EXPECT_EQ(counts(CullMode::back, FrontFace::counter_clockwise), std::pair(0, 6));
  EXPECT_EQ(counts(CullMode::front, FrontFace::clockwise), std::pair(0, 6));
  EXPECT_EQ(counts(CullMode::front, FrontFace::counter_clockwise), std::pair(6, 0));
}

// Counter-clockwise as given: the third vertex lies 3/16 of a subpixel above and right of the line through the others.
// Snapping moves that line one subpixel to the right and the third vertex onto the centre of pixel (1, 1): clockwise,
// with that one sample as its leftmost corner.
TEST(Culling, TheSnappedVerticesFaceFrontOrBack) {
  const float s = 1.0f / 256;
  const Triangle turned{
      {{0.5f + 0.625f * s, 0.5f}, {2.5f + 0.625f * s, 2.5f}, {1.5f + 0.375f * s, 1.5f - 0.4375f * s}}};
  Setting setting;
  setting.target = {4, 4};
  setting.cull = CullMode::back;
  EXPECT_EQ(covered_by_all(setting, turned), 1);
  EXPECT_TRUE(oracle::explain(setting, {}, turned, 1, 1, 0).inside);
  setting.cull = CullMode::front;
  EXPECT_EQ(covered_by_all(setting, turned), 0);
  EXPECT_FALSE(oracle::explain(setting, {}, turned, 1, 1, 0).inside);
  EXPECT_TRUE(oracle::explain(setting, {}, turned, 1, 1, 0).culled);
}

TEST(Culling, WhatHasNoAreaIsNotCalledCulled) {
  Setting setting;
  setting.target = {4, 4};
  for (const CullMode cull : {CullMode::none, CullMode::front, CullMode::back}) {
    setting.cull = cull;
    const Explanation why = oracle::explain(setting, {}, {{{1, 1}, {2, 2}, {3, 3}}}, 1, 1, 0);
    EXPECT_TRUE(why.degenerate);
    EXPECT_FALSE(why.culled);
  }
}

TEST(Scissor, ExplanationsHonourIt) {
  Setting setting;
  setting.target = {4, 4};
  const Triangle triangle{{{0, 0}, {8, 0}, {0, 8}}};
  setting.scissor = Rect{1, 1, 2, 2};
  EXPECT_TRUE(oracle::explain(setting, {}, triangle, 1, 1, 0).inside);
  EXPECT_FALSE(oracle::explain(setting, {}, triangle, 0, 1, 0).inside);
  EXPECT_FALSE(oracle::explain(setting, {}, triangle, 1, 3, 0).inside);
}

}  // namespace
}  // namespace edgecase::conformance
