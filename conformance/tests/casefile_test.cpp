#include "conformance/casefile/casefile.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

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
  EXPECT_EQ(read.scene.triangles, (std::vector<Triangle>{{kA, kB, kC}, {kB, kD, kC}, {kC, kD, kE}}));
}

TEST(CaseFile, IndicesPickVertices) {
  const Case read = parsed(with(R"("indices": [0, 1, 2, 2, 3, 0], "watertight": true,
    "vertices": [["0","0"], ["4","0"], ["4","4"], ["0","4"]])"));
  EXPECT_EQ(read.scene.triangles, (std::vector<Triangle>{{kA, kB, kC}, {kC, kD, kA}}));
  EXPECT_EQ(read.scene.meshes, std::vector{(Mesh{0, 2})});
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

}  // namespace
}  // namespace edgecase::conformance
