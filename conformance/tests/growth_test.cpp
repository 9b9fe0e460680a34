#include "conformance/bench/growth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "conformance/bench/bench.h"
#include "conformance/bench/workloads.h"
#include "conformance/oracle/oracle.h"
#include "conformance/subjects/edgecase_subject.h"
#include "conformance/tests/temporary_folder.h"

namespace edgecase::conformance {
namespace {

using testing::HasSubstr;

tl::expected<std::unique_ptr<Subject>, Error> ours(const std::string& name) {
  return make_edgecase_subject(name == "edgecase" ? "" : name.substr(name.find(':') + 1));
}

const GrowthAxis& axis(std::string_view name) { return *std::ranges::find(growth_axes(), name, &GrowthAxis::name); }

TEST(Growth, ScenesAreWhatTheirAxisSays) {
  EXPECT_EQ(axis("triangles").scene(1'000, 5, 1).triangles.size(), 1'000u);
  EXPECT_EQ(axis("area").scene(0.1, 500, 1).triangles.size(), 500u);
  EXPECT_EQ(axis("area").scene(1e6, 500, 1).triangles.size(), 20u);
  EXPECT_EQ(axis("target").scene(256, 50, 1).setting.target, (Extent{256, 256}));
  EXPECT_EQ(axis("samples").scene(8, 50, 1).setting.samples(), 8);
  for (const GrowthAxis& each : growth_axes()) {
    SCOPED_TRACE(each.name);
    const Scene scene = each.scene(each.values[1], 50, 1);
    EXPECT_EQ(scene.triangles, each.scene(each.values[1], 50, 1).triangles);
    for (const Triangle& triangle : scene.triangles) {
      for (const Position& p : triangle) ASSERT_EQ(p.x * 256, std::floor(p.x * 256));
    }
  }
  // The mean area on the grid is the area asked for.
  double doubled = 0;
  const Scene even = axis("area").scene(10, 2'000, 1);
  for (const auto& [a, b, c] : even.triangles)
    doubled += std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
  EXPECT_NEAR(doubled / 2 / static_cast<double>(even.triangles.size()), 10, 0.1);
}

TEST(Growth, FarVerticesLeaveHalfOfTheTargetCovered) {
  for (const double value : axis("range").values) {
    const Scene scene = axis("range").scene(value, 30, 1);
    std::vector<std::uint64_t> mask(MaskLayout(scene.setting).words());
    for (const Triangle& triangle : scene.triangles) {
      for (const Position& p : triangle) EXPECT_NEAR(std::hypot(p.x - 32, p.y - 32), value, 6);
      oracle::cover_by_definition(scene.setting, scene.rules, triangle, mask);
      std::size_t covered = 0;
      for (const std::uint64_t word : mask) covered += static_cast<std::size_t>(std::popcount(word));
      EXPECT_GT(covered, 64u * 64 * 3 / 10) << value;
      EXPECT_LT(covered, 64u * 64 * 7 / 10) << value;
    }
  }
}

std::vector<GrowthPoint> some_points() {
  return {{"triangles", 1'000, "plain", "avx2", 1'000, 100, 0.1},
          {"triangles", 100'000, "plain", "avx2", 100'000, 100, 0.1},
          {"area", 1, "plain", "avx2", 10, 100, 0.1},
          {"area", 100, "plain", "avx2", 10, 1'000, 0.1}};
}

TEST(Growth, TheSlopeIsTheExponentOfWhatIsShown) {
  EXPECT_DOUBLE_EQ(slope_of(axis("triangles"), some_points(), "plain"), 1);
  EXPECT_NEAR(slope_of(axis("area"), some_points(), "plain"), 0.5, 1e-12);
  EXPECT_EQ(slope_of(axis("area"), some_points(), "absent"), 0);
  EXPECT_EQ(last_slope_of(axis("area"), some_points(), "absent"), 0);
  // A bend from exponent 0 to 1: between them for the whole line, 1 at its end.
  auto points = some_points();
  points.push_back({"area", 1'000, "plain", "avx2", 10, 10'000, 0.1});
  points.push_back({"area", 0.01, "plain", "avx2", 10, 100, 0.1});
  std::ranges::sort(points, {}, &GrowthPoint::value);
  EXPECT_NEAR(slope_of(axis("area"), points, "plain"), 0.390, 0.001);
  EXPECT_DOUBLE_EQ(last_slope_of(axis("area"), points, "plain"), 1);
}

TEST(Growth, OutputNamesAxesAndValues) {
  const auto json = nlohmann::json::parse(growth_json(some_points()));
  ASSERT_EQ(json.at("points").size(), 4u);
  EXPECT_EQ(json["points"][3].at("axis"), "area");
  EXPECT_EQ(json["points"][3].at("value"), 100);
  EXPECT_EQ(json["points"][3].at("ns_per_triangle"), 1'000);
  EXPECT_THAT(growth_table(some_points()), testing::AllOf(HasSubstr("area in px"), HasSubstr("0.50"),
                                                          HasSubstr("\nand 1 where it goes with its pixels")));
  const std::string program = growth_plot_program(axis("area"), some_points(), "a.png");
  EXPECT_THAT(program, testing::AllOf(HasSubstr("plain (avx2), slope 0.50"), HasSubstr("100 1000\n")));
}

TEST(Growth, TheCommandWritesAPictureForEachAxis) {
  const TemporaryFolder folder;
  BenchOptions options;
  options.quick = true;
  options.growth = folder.string();
  options.make_subject = ours;
  testing::internal::CaptureStdout();
  EXPECT_EQ(bench_command(options), 0);
  const std::string table = testing::internal::GetCapturedStdout();
  EXPECT_TRUE(std::filesystem::exists(folder / "growth.json"));
  for (const GrowthAxis& each : growth_axes()) {
    EXPECT_THAT(table, HasSubstr(std::string(each.title)));
    EXPECT_GT(std::filesystem::file_size(folder / ("growth-" + std::string(each.name) + ".png")), 10'000u);
  }
  options.growth = "/proc/growth";
  testing::internal::CaptureStderr();
  EXPECT_EQ(bench_command(options), 2);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("cannot make the folder /proc/growth"));
}

}  // namespace
}  // namespace edgecase::conformance
