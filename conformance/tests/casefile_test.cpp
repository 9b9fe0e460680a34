#include "conformance/casefile/casefile.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

#include "conformance/scene/standard_samples.h"

namespace edgecase::conformance {
namespace {

Case parsed(std::string_view text) {
  auto result = parse_case(text, "some/where.json", "fill_rule/where");
  EXPECT_TRUE(result) << result.error().message;
  return result ? *result : Case{};
}

/// A case of the given geometry fields on a 4 x 4 target.
std::string with(std::string_view geometry) {
  return R"({"about": "a", "source": "s", "target": [4, 4], )" + std::string(geometry) + "}";
}

constexpr Position kA{0, 0}, kB{4, 0}, kC{4, 4}, kD{0, 4}, kE{-1, 2};

TEST(CaseFile, ReadsEveryField) {
  const Case read = parsed(R"({
    // What it shows.
    "about": "Pixel centres on a left edge are inside.",
    "source": "D3D11.3 functional spec 3.4.2.1", /* the rule */
    "target": [4, 3], "samples": 1, "subpixel_bits": 4, "rounding": "half_up",
    "triangles": [ [["1.5","0"], ["1.5","3"], ["4","3"]] ],
    "expect": ["....", ".#?.", ".1#0"] })");
  EXPECT_EQ(read.path, "some/where.json");
  EXPECT_EQ(read.name, "fill_rule/where");
  EXPECT_EQ(read.category, "fill_rule");
  EXPECT_EQ(read.about, "Pixel centres on a left edge are inside.");
  EXPECT_EQ(read.source, "D3D11.3 functional spec 3.4.2.1");
  EXPECT_EQ(read.scene.setting.target, (Extent{4, 3}));
  EXPECT_EQ(read.scene.setting.samples(), 1);
  EXPECT_EQ(read.scene.rules, (Rules{4, SnapRounding::half_up}));
  ASSERT_EQ(read.scene.triangles.size(), 1u);
  EXPECT_EQ(read.scene.triangles[0], (Triangle{{{1.5f, 0}, {1.5f, 3}, {4, 3}}}));
  EXPECT_TRUE(read.scene.meshes.empty());
  const std::int8_t may = Expectation::kMay;
  EXPECT_EQ(read.expect->counts, (std::vector<std::int8_t>{0, 0, 0, 0, 0, 1, may, 0, 0, 1, 1, 0}));
}

TEST(CaseFile, DefaultsAreOneSampleAndTheRulesOfD3D11) {
  const Case read = parsed(with(R"("fan": [["0","0"], ["4","0"], ["4","4"]])"));
  EXPECT_EQ(read.scene.rules, Rules{});
  EXPECT_EQ(read.scene.setting.sample_locations, std::vector{SampleLocation{}});
  EXPECT_FALSE(read.expect);
}

TEST(CaseFile, AFanIsDrawnRoundItsFirstVertex) {
  const Case read = parsed(with(R"("fan": [["0","0"], ["4","0"], ["4","4"], ["0","4"], ["-1","2"]])"));
  EXPECT_EQ(read.scene.triangles, (std::vector<Triangle>{{kA, kB, kC}, {kA, kC, kD}, {kA, kD, kE}}));
}

TEST(CaseFile, AStripKeepsItsWinding) {
  const Case read = parsed(with(R"("strip": [["0","0"], ["4","0"], ["4","4"], ["0","4"], ["-1","2"]])"));
  EXPECT_EQ(read.scene.triangles, (std::vector<Triangle>{{kA, kB, kC}, {kC, kB, kD}, {kC, kD, kE}}));
}

TEST(CaseFile, IndicesPickVertices) {
  const Case read = parsed(with(R"("indices": [0, 1, 2, 2, 3, 0], "watertight": true,
    "vertices": [["0","0"], ["4","0"], ["4","4"], ["0","4"]])"));
  EXPECT_EQ(read.scene.triangles, (std::vector<Triangle>{{kA, kB, kC}, {kC, kD, kA}}));
  EXPECT_EQ(read.scene.meshes, std::vector{(Mesh{0, 2})});
}

TEST(CaseFile, ATopologyIsHandedOver) {
  const std::string vertices = R"("vertices": [["0","0"], ["4","0"], ["4","4"], ["0","4"], ["-1","2"]], "topology": )";
  const std::vector<Position> all{kA, kB, kC, kD, kE};
  const Scene strip = parsed(with(vertices + "\"strip\"")).scene;
  EXPECT_EQ(strip.triangles, (std::vector<Triangle>{{kA, kB, kC}, {kC, kB, kD}, {kC, kD, kE}}));
  EXPECT_EQ(strip.assembly, (Assembly{Topology::strip, all, {}}));
  const Scene fan =
      parsed(with(vertices + "\"fan\", \"indices\": [0, 1, 2, 3, \"restart\", 1, 2, \"restart\", 4, 3, 2]")).scene;
  EXPECT_EQ(fan.triangles, (std::vector<Triangle>{{kA, kB, kC}, {kA, kC, kD}, {kE, kD, kC}}));
  EXPECT_EQ(fan.assembly, (Assembly{Topology::fan, all, {0, 1, 2, 3, kRestartIndex, 1, 2, kRestartIndex, 4, 3, 2}}));
  const Scene list = parsed(with(vertices + "\"list\", \"indices\": [4, 3, 2]")).scene;
  EXPECT_EQ(list.triangles, (std::vector<Triangle>{{kE, kD, kC}}));
  EXPECT_EQ(list.assembly, (Assembly{Topology::list, all, {4, 3, 2}}));
}

TEST(CaseFile, ARestartBeginsAStripAnew) {
  // The triangle after the restart is the first of its strip, and so not turned.
  const Case read = parsed(with(R"("vertices": [["0","0"], ["4","0"], ["4","4"], ["0","4"], ["-1","2"]],
    "topology": "strip", "indices": ["restart", 0, 1, 2, "restart", "restart", 2, 3, 4, "restart"])"));
  EXPECT_EQ(read.scene.triangles, (std::vector<Triangle>{{kA, kB, kC}, {kC, kD, kE}}));
}

TEST(CaseFile, WithoutATopologyNothingIsHandedOver) {
  for (const char* geometry :
       {R"("fan": [["0","0"], ["4","0"], ["4","4"]])", R"("strip": [["0","0"], ["4","0"], ["4","4"]])",
        R"("vertices": [["0","0"], ["4","0"], ["4","4"]], "indices": [0, 1, 2])"}) {
    EXPECT_FALSE(parsed(with(geometry)).scene.assembly) << geometry;
  }
}

TEST(CaseFile, ReadsTheWholeSetting) {
  const Case read = parsed(with(R"("triangles": [[["0","0"], ["4","0"], ["4","4"]]], "samples": 8,
    "scissor": [-1, 2, 3, 0], "cull": "front", "front_face": "counter_clockwise", "half_pixel_first": true)"));
  EXPECT_EQ(read.scene.setting.samples(), 8);
  EXPECT_TRUE(has_standard_samples(read.scene.setting));
  EXPECT_EQ(read.scene.setting.scissor, (Rect{-1, 2, 3, 0}));
  EXPECT_EQ(read.scene.setting.cull, CullMode::front);
  EXPECT_EQ(read.scene.setting.front_face, FrontFace::counter_clockwise);
  EXPECT_TRUE(read.scene.rules.half_pixel_first);
  const Case own = parsed(
      with(R"("triangles": [[["0","0"], ["4","0"], ["4","4"]]], "sample_positions": [[0, 15], [3, 4], [8, 8]])"));
  EXPECT_EQ(own.scene.setting.sample_locations, (std::vector<SampleLocation>{{0, 15}, {3, 4}, {8, 8}}));
}

TEST(CaseFile, ExpectHasTheRowsOfEachSample) {
  const Case read = parsed(R"({"about": "a", "source": "s", "target": [2, 2], "samples": 2,
    "triangles": [[["0","0"], ["4","0"], ["4","4"]]], "expect": [["#.", ".?"], ["..", "##"]]})");
  const std::int8_t may = Expectation::kMay;
  EXPECT_EQ(read.expect->counts, (std::vector<std::int8_t>{1, 0, 0, 0, 0, 1, may, 1}));
}

TEST(CaseFile, ClipSpaceHasAViewport) {
  const std::string clip =
      R"("clip": [[["-1","-1","0","1"], ["1","-1","0.5","1"], ["-0x1p+100","0x1p+120","-1","-0x1p-149"]]])";
  const Scene whole = parsed(with(clip)).scene;
  ASSERT_TRUE(whole.clip);
  EXPECT_TRUE(whole.triangles.empty());
  EXPECT_EQ(whole.clip->viewport, (Viewport{0, 0, 4, 4}));
  EXPECT_EQ(whole.clip->triangles,
            (std::vector<ClipTriangle>{{{{-1, -1, 0, 1}, {1, -1, 0.5f, 1}, {-0x1p100f, 0x1p120f, -1, -0x1p-149f}}}}));
  const Scene flipped = parsed(with(clip + R"(, "viewport": ["0.5","4","2","-4"])")).scene;
  EXPECT_EQ(flipped.clip->viewport, (Viewport{0.5f, 4, 2, -4}));
}

TEST(CaseFile, WatertightMayNameRanges) {
  const std::string geometry = R"("strip": [["0","0"], ["4","0"], ["4","4"], ["0","4"], ["-1","2"]], "watertight": )";
  EXPECT_EQ(parsed(with(geometry + "[[0, 1], [1, 2]]")).scene.meshes, (std::vector<Mesh>{{0, 1}, {1, 2}}));
  EXPECT_TRUE(parsed(with(geometry + "false")).scene.meshes.empty());
}

TEST(CaseFile, AMeshMayHoldTrianglesThatCoverNothing) {
  // The second triangle, as in a strip that is joined by repeating a vertex, runs along an edge of the first one.
  const Case read = parsed(with(R"("vertices": [["0","0"], ["4","0"], ["4","4"]], "indices": [0, 1, 2, 0, 1, 1],
    "watertight": true)"));
  EXPECT_EQ(read.scene.meshes, std::vector{(Mesh{0, 2})});
}

TEST(CaseFile, WritesAsAPersonWould) {
  Case made;
  made.about = "A \"left\" edge.";
  made.source = "D3D11.3 functional spec 3.4.2.1";
  made.scene.setting.target = {4, 2};
  made.scene.rules = {4, SnapRounding::truncate};
  made.scene.triangles = {{{{1.5f, 0}, {-1.5f, 0.1f}, {4, 3}}}, {kA, kB, kC}};
  made.scene.meshes = {{0, 2}};
  made.expect = Expectation{{0, 1, 2, Expectation::kMay, 0, 0, 0, 0}};
  EXPECT_EQ(write_case(made), R"({
  "about": "A \"left\" edge.",
  "source": "D3D11.3 functional spec 3.4.2.1",
  "target": [4, 2],
  "subpixel_bits": 4,
  "rounding": "truncate",
  "triangles": [
    [["1.5", "0"], ["-1.5", "0x1.99999ap-4"], ["4", "3"]],
    [["0", "0"], ["4", "0"], ["4", "4"]]
  ],
  "watertight": true,
  "expect": [
    ".#2?",
    "...."
  ]
}
)");
}

TEST(CaseFile, WritesSettingsAndOtherGeometry) {
  Case made;
  made.about = "a";
  made.source = "s";
  made.scene.setting.target = {2, 1};
  made.scene.setting.sample_locations = {{12, 12}, {4, 4}};
  made.scene.setting.scissor = Rect{-1, 0, 2, 3};
  made.scene.setting.cull = CullMode::back;
  made.scene.setting.front_face = FrontFace::counter_clockwise;
  made.scene.rules.half_pixel_first = true;
  made.scene.assembly = Assembly{Topology::strip, {kA, kB, kC}, {0, 1, 2, kRestartIndex}};
  made.scene.triangles = {{kA, kB, kC}};
  made.expect = Expectation{{0, 1, Expectation::kMay, 0}};
  EXPECT_EQ(write_case(made), R"({
  "about": "a",
  "source": "s",
  "target": [2, 1],
  "samples": 2,
  "scissor": [-1, 0, 2, 3],
  "cull": "back",
  "front_face": "counter_clockwise",
  "half_pixel_first": true,
  "topology": "strip",
  "vertices": [
    ["0", "0"],
    ["4", "0"],
    ["4", "4"]
  ],
  "indices": [0, 1, 2, "restart"],
  "expect": [
    [".?"],
    ["#."]
  ]
}
)");
  made.scene.setting = Setting{{2, 1}, {{12, 12}, {4, 5}}};
  made.scene.rules = {};
  made.scene.assembly.reset();
  made.scene.triangles.clear();
  made.scene.clip = {{0.5f, 0, 2, -1}, {{{{0, 0, 0, 1}, {1, 0, 0.5f, 0x1p-30f}, {0, -2, 0, 2}}}}};
  made.expect.reset();
  EXPECT_EQ(write_case(made), R"({
  "about": "a",
  "source": "s",
  "target": [2, 1],
  "sample_positions": [[12, 12], [4, 5]],
  "viewport": ["0.5", "0", "2", "-1"],
  "clip": [
    [["0", "0", "0", "1"], ["1", "0", "0.5", "0x1p-30"], ["0", "-2", "0", "2"]]
  ]
}
)");
}

constexpr std::string_view kUnderVulkan = R"({"about": "-", "source": "-", "target": [2, 1], "rules": "vulkan",
  "triangles": [[["0.5", "0"], ["9", "0"], ["0.5", "9"]]], "expect": ["?#"]@})";

tl::expected<Case, Error> under_vulkan(const std::string& more) {
  std::string text(kUnderVulkan);
  text.replace(text.find('@'), 1, more);
  return parse_case(text, "a.json", "a");
}

TEST(CaseFile, NamesTheRulesThatJudgeIt) {
  const auto read = under_vulkan("");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->rule_set, find_rule_set("vulkan"));
  EXPECT_EQ(parse_case(write_case(*read), "a.json", "a")->rule_set, read->rule_set);
  EXPECT_FALSE(under_vulkan(R"(, "rounding": "truncate")")) << "Vulkan leaves the rounding open";
  EXPECT_FALSE(under_vulkan(R"(, "subpixel_bits": 3)")) << "Vulkan wants four";
  EXPECT_TRUE(under_vulkan(R"(, "subpixel_bits": 4)"));
}

}  // namespace
}  // namespace edgecase::conformance
