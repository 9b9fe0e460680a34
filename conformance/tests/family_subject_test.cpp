#include "conformance/subjects/family_subject.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "conformance/generators/generator.h"
#include "conformance/oracle/oracle.h"
#include "conformance/subjects/edgecase_subject.h"

namespace edgecase::conformance {
namespace {

TEST(FamilySubject, IsFoundUnderItsName) {
  EXPECT_EQ(family_subjects().size(), 8u);
  for (const auto& [name, about] : family_subjects()) {
    EXPECT_EQ(make_family_subject(name)->info().name, "edgecase:" + std::string(name));
    EXPECT_FALSE(about.empty());
    EXPECT_NE(make_edgecase_subject(std::string(name)), nullptr);
  }
  EXPECT_EQ(make_family_subject("larabee"), nullptr);
  EXPECT_EQ(make_family_subject(""), nullptr);
}

TEST(FamilySubject, AgreesWithTheOracleOnEveryGenerator) {
  MaskBatch masks;
  std::vector<std::uint64_t> expected;
  for (const Generator& generator : generators()) {
    // One sample, no scissor, lists of triangles and positions on the grid are all that the family is for.
    if (generator.setting != Setting{} || generator.category == "float" || generator.category == "topology") continue;
    Scene scene;
    scene.setting = generator.setting;
    for (std::uint64_t i = 0; scene.triangles.size() < 400; ++i) append_scene(generator, 9, i, scene);
    // The one coordinate of 16.8 that is further out than the range that they declare, which is symmetric.
    std::erase_if(scene.triangles, [](const Triangle& t) {
      return std::ranges::any_of(t, [](const Position& p) { return p.x == -32768 || p.y == -32768; });
    });
    ASSERT_GT(scene.triangles.size(), 100u) << generator.name;
    for (const auto& [name, about] : family_subjects()) {
      SCOPED_TRACE(std::string(generator.name) + ", " + std::string(name));
      const auto subject = make_family_subject(name);
      ASSERT_EQ(subject->refusal(scene), std::nullopt);
      ASSERT_TRUE(subject->draw(scene, masks));
      ASSERT_EQ(masks.size(), scene.triangles.size());
      for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        expected.resize(masks[i].size());
        oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], expected);
        ASSERT_TRUE(std::ranges::equal(masks[i], expected)) << "triangle " << i;
      }
    }
  }
}

TEST(FamilySubject, RefusesWhatItCannotDraw) {
  const auto subject = make_family_subject("quads");
  Scene good;
  good.triangles = {{{{0, 0}, {2, 0}, {0, 2}}}};
  const auto refusal = [&](auto change) {
    Scene scene = good;
    change(scene);
    return subject->refusal(scene).value_or("(none)");
  };
  EXPECT_EQ(refusal([](Scene&) {}), "(none)");
  EXPECT_THAT(refusal([](Scene& s) { s.rules.subpixel_bits = 4; }), testing::HasSubstr("8 subpixel bits"));
  EXPECT_THAT(refusal([](Scene& s) { s.rules.rounding = SnapRounding::half_up; }), testing::HasSubstr("nearest even"));
  EXPECT_EQ(refusal([](Scene& s) { s.setting.sample_locations.resize(4); }), "4 samples a pixel");
  EXPECT_THAT(refusal([](Scene& s) { s.setting.sample_locations[0].y = 4; }), testing::HasSubstr("pixel's centre"));
  EXPECT_EQ(refusal([](Scene& s) { s.setting.scissor = Rect{0, 0, 3, 3}; }), "a scissor rectangle");
  EXPECT_THAT(refusal([](Scene& s) { s.setting.target.width = 16385; }), testing::HasSubstr("16385x32"));
  EXPECT_THAT(refusal([](Scene& s) { s.triangles[0][2].y = 32768; }), testing::HasSubstr("y = 32768"));
}

}  // namespace
}  // namespace edgecase::conformance
