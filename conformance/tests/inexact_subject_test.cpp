#include "conformance/subjects/inexact_subject.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "conformance/oracle/oracle.h"

namespace edgecase::conformance {
namespace {

/// A triangle of which an arithmetic answers wrongly for one pixel.
struct Exhibit {
  Triangle triangle;
  int x;
  int y;
  bool inside;  ///< what the rules say
};

/// A left edge at x, its other edges far from any sample of the first row.
constexpr Triangle left_edge_at(float x) { return {{{x, 0}, {40, 0}, {x, 40}}}; }
constexpr float kSubpixel = 1.0f / 256;

const std::map<std::string_view, Exhibit> kExhibits = {
    // The longest edge's function is 2^-16 px^2 at the sample, the difference of products that have more than 24 bits.
    {"float", {{{{7.6875f, 26.65234375f}, {11.17578125f, 17.6484375f}, {31.83984375f, 1.859375f}}}, 20, 13, true}},
    {"float-stepped",
     {{{{7.6875f, 26.65234375f}, {11.17578125f, 17.6484375f}, {31.83984375f, 1.859375f}}}, 20, 13, true}},
    // Snapped, the edge goes through the sample.
    {"double", {left_edge_at(1.5f + kSubpixel / 4), 1, 0, true}},
    // From (1, 16) to (241, 189): 240 * 32.5 - 173 * 234.5 = -32768.5 px^2, beyond -2^31 in units of 2^-16 px^2.
    {"int32", {{{{241, 189}, {7, 153}, {1, 16}}}, 235, 48, false}},
    {"bits0", {left_edge_at(1.5f), 1, 0, true}},
    {"bits2", {left_edge_at(1.5f + kSubpixel), 1, 0, false}},
    {"bits4", {left_edge_at(1.5f + kSubpixel), 1, 0, false}},
    {"bits6", {left_edge_at(1.5f + kSubpixel), 1, 0, false}},
    // From (1.5, 0) to (3, 3.75) the slope is 2/5, which is none of binary32's numbers: (2.5, 2.5) is on this left
    // edge.
    {"dda", {{{{3, 3.75}, {2.5, 0.5}, {1.5, 0}}}, 2, 2, true}},
    // From (1, 0) to (0, 3) the slope is -1/3: (0.5, 1.5) is on this left edge.
    {"dda-fixed", {{{{1, 0}, {3, 3}, {0, 3}}}, 0, 1, true}},
    // The left edge goes down from 1.75 with slope 1/4, through x = 2.375 in row 2; begun at 2, through 2.625.
    {"dda-snapped-ends", {{{{1.75, 0}, {40, 0}, {3.25, 6}}}, 2, 2, true}},
};

/// Whether `subject`, and then the oracle, cover the pixel.
std::pair<bool, bool> answers(Subject& subject, const Exhibit& exhibit) {
  Scene scene;
  scene.setting.target = {256, 64};
  scene.triangles = {exhibit.triangle};
  EXPECT_EQ(subject.refusal(scene), std::nullopt);
  MaskBatch masks;
  EXPECT_TRUE(subject.draw(scene, masks));
  const MaskLayout layout(scene.setting);
  std::vector<std::uint64_t> exact(layout.words());
  oracle::cover_by_definition(scene.setting, scene.rules, exhibit.triangle, exact);
  const std::size_t bit = layout.bit(exhibit.x, exhibit.y, 0);
  return {covered(masks[0], bit), covered(exact, bit)};
}

TEST(InexactSubject, EachIsWrongWhereItsArithmeticIs) {
  for (const InexactInfo& info : inexact_subjects()) {
    SCOPED_TRACE(info.name);
    const auto found = kExhibits.find(info.name);
    ASSERT_NE(found, kExhibits.end());
    const auto [observed, exact] = answers(*make_inexact_subject(info.name), found->second);
    EXPECT_EQ(exact, found->second.inside);
    EXPECT_NE(observed, found->second.inside);
  }
  EXPECT_EQ(kExhibits.size(), inexact_subjects().size());
}

/// Triangles with vertices `offset` beside whole pixels, on a target small enough that even 32 bits are plenty;
/// `diagonal` ones have edges of slopes 0, 1, -1 and infinity only.
Scene easy_scene(bool diagonal, float offset = 0) {
  std::mt19937 random(30);
  Scene scene;
  scene.setting.target = {70, 9};
  const auto pixels = [&](unsigned count) { return static_cast<float>(random() % count); };
  while (scene.triangles.size() < 500) {
    const float x = pixels(64) - 2, y = pixels(9) - 2, size = pixels(9) + 1;
    const float dx = random() % 2 ? size : -size, dy = random() % 2 ? size : -size;
    Triangle triangle{{{x, y}, {x + dx, y}, {x, y + dy}}};
    if (!diagonal) triangle[2] = {pixels(64) - 2, pixels(9) - 2};
    for (Position& p : triangle) p = {p.x + offset, p.y + offset};
    scene.triangles.push_back(triangle);
  }
  return scene;
}

std::size_t wrong_masks(Subject& subject, const Scene& scene) {
  EXPECT_EQ(subject.refusal(scene), std::nullopt);
  MaskBatch masks;
  EXPECT_TRUE(subject.draw(scene, masks));
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    std::vector<std::uint64_t> exact(masks[i].size());
    oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], exact);
    wrong += !std::ranges::equal(masks[i], exact);
  }
  return wrong;
}

TEST(InexactSubject, EachIsRightWhereItsArithmeticIs) {
  for (const InexactInfo& info : inexact_subjects()) {
    SCOPED_TRACE(info.name);
    const auto subject = make_inexact_subject(info.name);
    EXPECT_EQ(wrong_masks(*subject, easy_scene(true)), 0u);
    // Through samples, as far as an arithmetic tells them from whole pixels.
    const bool whole = info.name == "bits0" || info.name == "dda-snapped-ends";
    EXPECT_EQ(wrong_masks(*subject, easy_scene(true, 0.5f)) == 0, !whole);
    // Slopes that are rounded show even between whole pixels.
    const bool slopes = info.name.starts_with("dda");
    EXPECT_EQ(wrong_masks(*subject, easy_scene(false)) == 0, !slopes);
  }
}

TEST(InexactSubject, DoubleIsExactOnTheGridOverTheWholeRange) {
  std::mt19937_64 random(31);
  Scene scene;
  scene.setting.target = {90, 60};
  for (int i = 0; i < 3'000; ++i) {
    const auto coordinate = [&] {
      return static_cast<float>(static_cast<std::int64_t>(random() % 16'777'215) - 8'388'607) / 256.0f;
    };
    Triangle triangle;
    for (Position& p : triangle) p = {coordinate(), coordinate()};
    scene.triangles.push_back(triangle);
  }
  EXPECT_EQ(wrong_masks(*make_inexact_subject("double"), scene), 0u);
}

TEST(InexactList, AddsTheSameAsTheSubject) {
  const Scene scene = easy_scene(false);
  for (const InexactInfo& info : inexact_subjects()) {
    MaskBatch masks;
    ASSERT_TRUE(make_inexact_subject(info.name)->draw(scene, masks));
    std::vector<std::uint64_t> expected(masks[0].size()), observed(masks[0].size());
    for (std::size_t i = 0; i < masks.size(); ++i) {
      for (std::size_t k = 0; k < expected.size(); ++k) expected[k] |= masks[i][k];
    }
    prepare_inexact(info.name, scene)->cover_all(observed);
    EXPECT_EQ(expected, observed) << info.name;
  }
  EXPECT_EQ(prepare_inexact("exact", scene), nullptr);
}

TEST(InexactSubject, NamesAreUniqueAndTextsAreOneLine) {
  std::set<std::string_view> names;
  for (const InexactInfo& info : inexact_subjects()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_EQ(make_inexact_subject(info.name)->info().name, "inexact:" + std::string(info.name));
    for (const std::string_view text : {info.description, info.expected_failure}) {
      EXPECT_FALSE(text.empty());
      EXPECT_EQ(text.find('\n'), std::string_view::npos);
    }
  }
  EXPECT_EQ(make_inexact_subject("int64"), nullptr);
}

TEST(InexactSubject, RefusesWhatItDoesNotClaim) {
  const auto subject = make_inexact_subject("float");
  Scene scene = easy_scene(true);
  EXPECT_EQ(subject->refusal(scene), std::nullopt);
  scene.rules.subpixel_bits = 4;
  EXPECT_THAT(subject->refusal(scene).value_or(""), testing::HasSubstr("8 subpixel bits"));
  scene.rules.subpixel_bits = 8;
  scene.setting.sample_locations[0] = {4, 4};
  EXPECT_THAT(subject->refusal(scene).value_or(""), testing::HasSubstr("pixel's centre"));
}

}  // namespace
}  // namespace edgecase::conformance
