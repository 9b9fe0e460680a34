#include "conformance/subjects/edgecase_subject.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace edgecase::conformance {
namespace {

using testing::HasSubstr;

Scene scene_of(std::vector<Triangle> triangles) {
  Scene scene;
  scene.setting.target = {8, 4};
  scene.triangles = std::move(triangles);
  return scene;
}

TEST(EdgecaseSubject, EveryVariantHasItsName) {
  EXPECT_EQ(make_edgecase_subject("")->info().name, "edgecase");
  EXPECT_EQ(make_edgecase_subject("scalar")->info().name, "edgecase:scalar");
  EXPECT_EQ(make_edgecase_subject("portable")->info().name, "edgecase:portable");
  EXPECT_EQ(make_edgecase_subject("vector"), nullptr);
}

TEST(EdgecaseSubject, DrawsEachTriangleIntoAMaskOfItsOwn) {
  const auto subject = make_edgecase_subject("");
  const Scene scene = scene_of({{{{0, 0}, {2, 0}, {0, 2}}}, {{{1, 1}, {1, 1}, {1, 1}}}, {{{4, 2}, {8, 2}, {8, 4}}}});
  ASSERT_EQ(subject->refusal(scene), std::nullopt);
  MaskBatch masks;
  // Left over from an earlier, larger scene.
  masks.reset(MaskLayout(scene.setting), 5);
  for (auto& word : masks.data()) word = ~std::uint64_t{0};
  ASSERT_TRUE(subject->draw(scene, masks));
  ASSERT_EQ(masks.size(), 3u);
  EXPECT_THAT(masks[0], testing::ElementsAre(1u, 0u, 0u, 0u));
  EXPECT_THAT(masks[1], testing::ElementsAre(0u, 0u, 0u, 0u));
  EXPECT_THAT(masks[2], testing::ElementsAre(0u, 0u, 0b11100000u, 0b10000000u));
}

TEST(EdgecaseSubject, FollowsTheScenesSubpixelBits) {
  const auto subject = make_edgecase_subject("");
  // A left edge at 1.53 px: right of the sample with 8 bits, rounded to 1.5, through it, with 4, to 2 with none.
  Scene scene = scene_of({{{{1.53f, 0}, {1.53f, 4}, {8, 0}}}});
  const auto first_row = [&](int bits) {
    scene.rules.subpixel_bits = bits;
    MaskBatch masks;
    EXPECT_EQ(subject->refusal(scene), std::nullopt);
    EXPECT_TRUE(subject->draw(scene, masks));
    return masks[0][0];
  };
  EXPECT_EQ(first_row(8) & 0b11, 0b00u);
  EXPECT_EQ(first_row(4) & 0b11, 0b10u);
  EXPECT_EQ(first_row(0) & 0b11, 0b00u);
  EXPECT_EQ(first_row(16) & 0b11, 0b00u);
}

TEST(EdgecaseSubject, RefusesWhatItCannotDraw) {
  const auto subject = make_edgecase_subject("");
  const Scene good = scene_of({{{{0, 0}, {2, 0}, {0, 2}}}});
  const auto refusal = [&](auto change) {
    Scene scene = good;
    change(scene);
    return subject->refusal(scene).value_or("(none)");
  };
  EXPECT_EQ(refusal([](Scene&) {}), "(none)");
  EXPECT_THAT(refusal([](Scene& s) { s.setting.target.width = 16385; }), HasSubstr("16385x4"));
  EXPECT_EQ(refusal([](Scene& s) { s.setting.sample_locations.resize(16); }), "(none)");
  EXPECT_EQ(refusal([](Scene& s) { s.setting.sample_locations.resize(17); }), "17 samples a pixel");
  EXPECT_EQ(refusal([](Scene& s) { s.setting.sample_locations.clear(); }), "0 samples a pixel");
  EXPECT_THAT(refusal([](Scene& s) { s.setting.sample_locations[0].x = 16; }), HasSubstr("off the sixteenths"));
  EXPECT_THAT(refusal([](Scene& s) { s.setting.sample_locations[0].y = -1; }), HasSubstr("off the sixteenths"));
  EXPECT_THAT(refusal([](Scene& s) { s.rules.rounding = SnapRounding::truncate; }), HasSubstr("nearest even"));
  EXPECT_EQ(refusal([](Scene& s) { s.clip.emplace(); }), "clip space");
  EXPECT_EQ(refusal([](Scene& s) { s.setting.cull = CullMode::back; }), "(none)");
  EXPECT_EQ(refusal([](Scene& s) { s.rules.subpixel_bits = 17; }), "17 subpixel bits");
  EXPECT_EQ(refusal([](Scene& s) { s.rules.subpixel_bits = -1; }), "-1 subpixel bits");
  EXPECT_THAT(refusal([](Scene& s) { s.triangles[0][2].y = 32768; }), HasSubstr("triangle 0, vertex 2: y = 32768"));
  EXPECT_THAT(refusal([](Scene& s) { s.triangles[0][1].x = std::numeric_limits<float>::quiet_NaN(); }),
              HasSubstr("vertex 1: x is NaN"));
}

TEST(EdgecaseSubject, SamplesOfAPixelAreNeighboursInTheMask) {
  const auto subject = make_edgecase_subject("");
  Scene scene = scene_of({{{{0, 0}, {1, 0}, {0, 1}}}, {{{1, 0}, {1, 1}, {0, 1}}}});
  scene.setting.target = {2, 1};
  scene.setting.sample_locations = {{4, 4}, {12, 12}, {8, 8}};
  ASSERT_EQ(subject->refusal(scene), std::nullopt);
  MaskBatch masks;
  ASSERT_TRUE(subject->draw(scene, masks));
  // The diagonal through the centre is a right edge, then a left one.
  EXPECT_THAT(masks[0], testing::ElementsAre(0b001u));
  EXPECT_THAT(masks[1], testing::ElementsAre(0b110u));
}

TEST(EdgecaseSubject, NothingIsCoveredOutsideTheScissor) {
  const auto subject = make_edgecase_subject("");
  Scene scene = scene_of({{{{0, 0}, {8, 0}, {0, 8}}}});
  const auto draw = [&](const Rect& scissor) {
    scene.setting.scissor = scissor;
    EXPECT_EQ(subject->refusal(scene), std::nullopt);
    MaskBatch masks;
    EXPECT_TRUE(subject->draw(scene, masks));
    return std::vector<std::uint64_t>(masks[0].begin(), masks[0].end());
  };
  constexpr int kMost = std::numeric_limits<int>::max(), kLeast = std::numeric_limits<int>::min();
  using testing::ElementsAre;
  EXPECT_THAT(draw({0, 0, kMost, kMost}), ElementsAre(0b1111111u, 0b111111u, 0b11111u, 0b1111u));
  EXPECT_THAT(draw({2, 1, 3, 2}), ElementsAre(0u, 0b11100u, 0b11100u, 0u));
  EXPECT_THAT(draw({-5, -3, 6, 4}), ElementsAre(1u, 0u, 0u, 0u));
  EXPECT_THAT(draw({6, 0, kMost, kMost}), ElementsAre(0b1000000u, 0u, 0u, 0u));
  for (const Rect& empty : {Rect{2, 1, 0, 2}, Rect{2, 1, 2, 0}, Rect{8, 0, 4, 4}, Rect{-4, 0, 4, 4}, Rect{3, 0, -2, 4},
                            Rect{kLeast, 0, kLeast, 4}, Rect{kMost, kMost, kMost, kMost}}) {
    EXPECT_THAT(draw(empty), testing::Each(0u))
        << empty.x << " " << empty.y << " " << empty.width << " " << empty.height;
  }
}

TEST(EdgecaseSubject, TheDeclaredRangeIsDrawn) {
  const auto subject = make_edgecase_subject("");
  const auto most = static_cast<float>(subject->info().max_coordinate);
  ASSERT_EQ(static_cast<double>(most), subject->info().max_coordinate);
  const Scene scene = scene_of({{{{-most, -most}, {most, -most}, {most, most}}}, {{{-32768, 0}, {0, -32768}, {0, 0}}}});
  EXPECT_EQ(subject->refusal(scene), std::nullopt);
}

}  // namespace
}  // namespace edgecase::conformance
