#include "conformance/subjects/fault_subject.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>

#include "conformance/subjects/edgecase_subject.h"

namespace edgecase::conformance {
namespace {

/// The mask of the only triangle of a 7x4 target, rows parted by '/'.
std::string draw(Subject& subject, const Triangle& triangle) {
  Scene scene;
  scene.setting.target = {7, 4};
  scene.triangles = {triangle};
  EXPECT_EQ(subject.refusal(scene), std::nullopt);
  MaskBatch masks;
  EXPECT_TRUE(subject.draw(scene, masks));
  const MaskLayout layout(scene.setting);
  std::string rows;
  for (int y = 0; y < 4; ++y) {
    if (y > 0) rows += '/';
    for (int x = 0; x < 7; ++x) rows += covered(masks[0], layout.bit(x, y, 0)) ? '#' : '.';
  }
  return rows;
}

/// A triangle small enough to check by hand: what the rules ask for, and what a fault makes of it.
struct Exhibit {
  Triangle triangle;
  std::string exact;
  std::string faulty;
};

/// Its hypotenuse, a right edge, runs through samples.
constexpr Triangle kUpperLeft{{{0, 0}, {4, 0}, {0, 4}}};
/// Its hypotenuse, a left edge, runs through samples.
constexpr Triangle kUpperRight{{{0, 0}, {4, 0}, {4, 4}}};

/// A left edge at x and a hypotenuse far from any sample.
constexpr Triangle left_edge_at(float x) { return {{{x, 0}, {8, 0}, {x, 4}}}; }
constexpr float kSubpixel = 1.0f / 256;
const std::string kFromColumn1 = ".######/.#####./.###.../.#.....";
const std::string kFromColumn2 = "..#####/..####./..##.../.......";

const std::map<std::string_view, Exhibit> kExhibits = {
    {"top-exclusive",
     {{{{0, 0.5}, {4, 0.5}, {0, 4.5}}}, "####.../###..../##...../#......", "......./###..../##...../#......"}},
    {"left-exclusive",
     {{{{0.5, 0}, {4.5, 0}, {0.5, 4}}}, "####.../###..../##...../#......", ".###.../.##..../.#...../......."}},
    {"slanted-left-exclusive", {kUpperRight, "####.../.###.../..##.../...#...", ".###.../..##.../...#.../......."}},
    {"right-inclusive", {kUpperLeft, "###..../##...../#....../.......", "####.../###..../##...../#......"}},
    {"vertical-right-inclusive",
     {{{{3.5, 0}, {3.5, 4}, {-0.5, 4}}}, "......./..#..../.##..../###....", "...#.../..##.../.###.../####..."}},
    {"bottom-inclusive",
     {{{{0, 3.5}, {4, 3.5}, {0, -0.5}}}, "#....../##...../###..../.......", "#....../##...../###..../####..."}},
    {"all-exclusive", {kUpperRight, "####.../.###.../..##.../...#...", ".###.../..##.../...#.../......."}},
    {"all-inclusive", {kUpperLeft, "###..../##...../#....../.......", "####.../###..../##...../#......"}},
    {"snap-truncate", {left_edge_at(1.5f + 0.75f * kSubpixel), kFromColumn2, kFromColumn1}},
    {"snap-floor", {left_edge_at(1.5f + 0.75f * kSubpixel), kFromColumn2, kFromColumn1}},
    {"snap-half-up", {left_edge_at(1.5f + 0.5f * kSubpixel), kFromColumn1, kFromColumn2}},
    {"snap-half-away", {left_edge_at(1.5f + 0.5f * kSubpixel), kFromColumn1, kFromColumn2}},
    {"box-short-left", {kUpperLeft, "###..../##...../#....../.......", ".##..../.#...../......./......."}},
    {"box-short-top", {kUpperLeft, "###..../##...../#....../.......", "......./##...../#....../......."}},
    {"box-short-right", {kUpperRight, "####.../.###.../..##.../...#...", "###..../.##..../..#..../......."}},
    {"box-short-bottom", {kUpperRight, "####.../.###.../..##.../...#...", "####.../.###.../..##.../......."}},
    // c of both long edges is 180,000 px^2, or 180,000 * 2^16 square subpixels: 2^32 too large two times over, and then
    // negative as a 32-bit number.
    {"overflow-c",
     {{{{2, -300}, {2, 300}, {-600, 0}}}, "##...../##...../##...../##.....", "......./......./......./......."}},
    {"y-flipped", {kUpperLeft, "###..../##...../#....../.......", "......./#....../##...../###...."}},
    {"corner-sample", {kUpperLeft, "###..../##...../#....../.......", "####.../###..../##...../#......"}},
    {"one-winding", {{{{0, 0}, {0, 4}, {4, 0}}}, "###..../##...../#....../.......", "......./......./......./......."}},
};

TEST(FaultSubject, EveryFaultShowsInAnExhibitThatTheHostDrawsExactly) {
  const auto host = make_faultless_subject();
  const auto ours = make_edgecase_subject("");
  for (const FaultInfo& fault : faults()) {
    SCOPED_TRACE(fault.name);
    const auto found = kExhibits.find(fault.name);
    ASSERT_NE(found, kExhibits.end());
    const Exhibit& exhibit = found->second;
    EXPECT_EQ(draw(*host, exhibit.triangle), exhibit.exact);
    EXPECT_EQ(draw(*ours, exhibit.triangle), exhibit.exact);
    EXPECT_EQ(draw(*make_fault_subject(fault.name), exhibit.triangle), exhibit.faulty);
  }
  EXPECT_EQ(kExhibits.size(), faults().size());
}

/// Triangles with every vertex in or around the target, on the grid or finer, near or far, often with ties.
Scene random_scene(std::mt19937_64& random, int subpixel_bits, std::size_t count) {
  Scene scene;
  scene.setting.target = {21, 13};
  scene.rules.subpixel_bits = subpixel_bits;
  for (std::size_t i = 0; i < count; ++i) {
    // Half pixels, the sixteenths, the subpixel grid, or any float.
    const int kind = static_cast<int>(random() % 4);
    const float reach = random() % 8 == 0 ? 30000.0f : 40.0f;
    const auto coordinate = [&] {
      const auto value = (static_cast<float>(random() % 16777216) / 16777216.0f - 0.3f) * reach;
      const float steps =
          std::array{2.0f, 16.0f, static_cast<float>(1 << subpixel_bits), 0.0f}[static_cast<std::size_t>(kind)];
      return steps == 0 ? value : static_cast<float>(static_cast<int>(value * steps)) / steps;
    };
    Triangle triangle;
    for (Position& position : triangle) {
      position.x = coordinate();
      position.y = coordinate();
    }
    scene.triangles.push_back(triangle);
  }
  return scene;
}

TEST(FaultSubject, TheHostAgreesWithOursOnRandomTrianglesOfEveryFormat) {
  std::mt19937_64 random(6);
  const auto host = make_faultless_subject();
  const auto ours = make_edgecase_subject("");
  MaskBatch expected, observed;
  for (int bits = 0; bits <= 16; ++bits) {
    const Scene scene = random_scene(random, bits, 2'000);
    ASSERT_EQ(host->refusal(scene), std::nullopt);
    ASSERT_EQ(ours->refusal(scene), std::nullopt);
    ASSERT_TRUE(host->draw(scene, expected) && ours->draw(scene, observed));
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      ASSERT_TRUE(std::ranges::equal(expected[i], observed[i])) << bits << " bits, triangle " << i;
    }
  }
}

TEST(FaultSubject, TheHostTakesSampleLocations) {
  Scene scene;
  scene.setting.target = {2, 1};
  scene.setting.sample_locations = {{4, 4}, {12, 12}};
  // x + y < 1: of pixel 0 the first sample, of pixel 1 none; then its mirror image, of which the hypotenuse is a left
  // edge.
  scene.triangles = {{{{0, 0}, {1, 0}, {0, 1}}}, {{{1, 0}, {1, 1}, {0, 1}}}};
  MaskBatch masks;
  const auto host = make_faultless_subject();
  ASSERT_EQ(host->refusal(scene), std::nullopt);
  ASSERT_TRUE(host->draw(scene, masks));
  EXPECT_EQ(masks[0][0], 0b01u);
  EXPECT_EQ(masks[1][0], 0b10u);
}

TEST(FaultSubject, NamesAreUniqueAndTextsAreOneLine) {
  std::set<std::string_view> names;
  for (const FaultInfo& fault : faults()) {
    EXPECT_TRUE(names.insert(fault.name).second) << fault.name;
    EXPECT_EQ(make_fault_subject(fault.name)->info().name, "fault:" + std::string(fault.name));
    for (const std::string_view text : {fault.description, fault.revealed_by}) {
      EXPECT_FALSE(text.empty());
      EXPECT_EQ(text.find('\n'), std::string_view::npos);
    }
  }
  EXPECT_EQ(make_fault_subject("none"), nullptr);
  EXPECT_EQ(make_fault_subject(""), nullptr);
}

}  // namespace
}  // namespace edgecase::conformance
