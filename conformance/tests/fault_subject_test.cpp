#include "conformance/subjects/fault_subject.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "conformance/scene/assemble.h"
#include "conformance/scene/standard_samples.h"
#include "conformance/subjects/edgecase_subject.h"

namespace edgecase::conformance {
namespace {

/// What the scene's triangles cover of the first sample of each pixel, '#', or of one of the others, '+'; rows parted
/// by
/// '/'.
std::string draw(Subject& subject, const Scene& scene) {
  EXPECT_EQ(subject.refusal(scene), std::nullopt);
  MaskBatch masks;
  EXPECT_TRUE(subject.draw(scene, masks));
  const MaskLayout layout(scene.setting);
  std::string rows;
  for (int y = 0; y < layout.target.height; ++y) {
    if (y > 0) rows += '/';
    for (int x = 0; x < layout.target.width; ++x) {
      char mark = '.';
      for (std::size_t i = 0; i < masks.size(); ++i) {
        for (int s = layout.samples - 1; s >= 0; --s) {
          if (covered(masks[i], layout.bit(x, y, s)) && mark != '#') mark = s == 0 ? '#' : '+';
        }
      }
      rows += mark;
    }
  }
  return rows;
}

/// A scene small enough to check by hand: what the rules ask for, and what a fault makes of it.
struct Exhibit {
  Scene scene;
  std::string exact;
  std::string faulty;
  Exhibit(Scene s, std::string e, std::string f) : scene(std::move(s)), exact(std::move(e)), faulty(std::move(f)) {}
  Exhibit(const Triangle& triangle, std::string e, std::string f) : exact(std::move(e)), faulty(std::move(f)) {
    scene.setting.target = {7, 4};
    scene.triangles = {triangle};
  }
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

/// The scissor holds columns 2 to 4 of rows 1 to 2.
Scene scissored(const Rect& scissor = {2, 1, 3, 2}) {
  Scene scene;
  scene.setting.target = {7, 4};
  scene.setting.scissor = scissor;
  scene.triangles = {{{{-9, -9}, {30, -9}, {-9, 30}}}};
  return scene;
}
const std::string kScissored = "......./..###../..###../.......";

Scene culled(CullMode cull, FrontFace front, const Triangle& triangle) {
  Scene scene = scissored();
  scene.setting.scissor.reset();
  scene.setting.cull = cull;
  scene.setting.front_face = front;
  scene.triangles = {triangle};
  return scene;
}

Scene multisampled(int samples, const Triangle& triangle) {
  Scene scene;
  const auto locations = standard_sample_locations(samples);
  scene.setting.target = {2, 2};
  scene.setting.sample_locations.assign(locations.begin(), locations.end());
  scene.triangles = {triangle};
  return scene;
}

/// Two squares, or with its second as a third and fourth triangle.
Scene assembled(const std::vector<std::uint32_t>& indices) {
  Scene scene;
  scene.setting.target = {5, 2};
  scene.setting.cull = CullMode::back;
  scene.assembly = Assembly{Topology::strip, {{0, 0}, {2, 0}, {0, 2}, {2, 2}, {3, 0}, {5, 0}, {3, 2}, {5, 2}}, indices};
  scene.triangles = assemble(*scene.assembly);
  return scene;
}

Scene clip_space(const Viewport& viewport, const ClipTriangle& triangle) {
  Scene scene;
  scene.setting.target = {4, 4};
  scene.clip = ClipGeometry{viewport, {triangle}};
  return scene;
}

constexpr FrontFace kClockwise = FrontFace::clockwise;
constexpr FrontFace kCounterClockwise = FrontFace::counter_clockwise;
const std::string kNothing = "......./......./......./.......";

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
    {"cull-flipped", {culled(CullMode::back, kClockwise, kUpperLeft), "###..../##...../#....../.......", kNothing}},
    {"front-face-ignored",
     {culled(CullMode::front, kCounterClockwise, kUpperLeft), "###..../##...../#....../.......", kNothing}},
    // Clockwise as given, counter-clockwise on the grid, where the long edge, a left one, goes through (1.5, 1.5).
    {"cull-before-snap",
     {culled(CullMode::back, kClockwise,
             {{{2.50244140625f, 2.5f}, {0.50244140625f, 0.5f}, {1.50146484375f, 1.498291015625f}}}),
      kNothing, "......./.#...../......./......."}},
    {"scissor-short-left", {scissored(), kScissored, "......./...##../...##../......."}},
    {"scissor-short-right", {scissored(), kScissored, "......./..##.../..##.../......."}},
    {"scissor-short-top", {scissored(), kScissored, "......./......./..###../......."}},
    {"scissor-short-bottom", {scissored(), kScissored, "......./..###../......./......."}},
    {"scissor-wide-left", {scissored(), kScissored, "......./.####../.####../......."}},
    {"scissor-wide-right", {scissored(), kScissored, "......./..####./..####./......."}},
    {"scissor-wide-top", {scissored(), kScissored, "..###../..###../..###../......."}},
    {"scissor-wide-bottom", {scissored(), kScissored, "......./..###../..###../..###.."}},
    {"scissor-inclusive", {scissored(), kScissored, "......./..####./..####./..####."}},
    {"scissor-empty-ignored", {scissored({2, 1, 3, 0}), kNothing, "#######/#######/#######/#######"}},
    // The first of two samples lies in its pixel's lower right, the first of four above the second, in another column.
    {"samples2-swapped", {multisampled(2, {{{0, 0}, {0.5f, 0}, {0, 0.75f}}}), "+./..", "#./.."}},
    {"samples4-swapped", {multisampled(4, {{{0.25f, 0}, {0.5f, 0}, {0.375f, 0.25f}}}), "#./..", "+./.."}},
    {"box-sample-12", {multisampled(16, {{{0.953125f, 0}, {1.03125f, 0.5f}, {0.953125f, 1}}}), ".+/..", "../.."}},
    {"box-sample-15", {multisampled(16, {{{0, 0.9375f}, {0.25f, 0.9375f}, {0.0625f, 1.03125f}}}), "../+.", "../.."}},
    {"flip-turns-rule",
     {clip_space({0, 4, 4, -4}, {{{-1, 0.75f, 0, 1}, {1, 0.75f, 0, 1}, {-1, -1, 0, 1}}}), "####/###./##../#...",
      "..../###./##../#..."}},
    {"strip-unturned", {assembled({0, 1, 2, 3}), "##.../##...", "#..../....."}},
    {"restart-ignored", {assembled({0, 1, 2, 3, kRestartIndex, 4, 5, 6, 7}), "##.##/##.##", "##.../##..."}},
    {"behind-drawn",
     {clip_space({0, 0, 4, 4}, {{{1, 1, -0.5f, -1}, {-1, 1, -0.5f, -1}, {1, -1, -0.5f, -1}}}), "..../..../..../....",
      "###./##../#.../...."}},
};

TEST(FaultSubject, EveryFaultShowsInAnExhibitThatTheHostDrawsExactly) {
  const auto host = make_faultless_subject();
  const auto ours = make_edgecase_subject("");
  for (const FaultInfo& fault : faults()) {
    SCOPED_TRACE(fault.name);
    const auto found = kExhibits.find(fault.name);
    ASSERT_NE(found, kExhibits.end());
    const Exhibit& exhibit = found->second;
    EXPECT_EQ(draw(*host, exhibit.scene), exhibit.exact);
    if (!exhibit.scene.clip) {
      EXPECT_EQ(draw(*ours, exhibit.scene), exhibit.exact);
    }
    EXPECT_EQ(draw(*make_fault_subject(fault.name), exhibit.scene), exhibit.faulty);
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
