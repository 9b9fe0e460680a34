#include "conformance/bench/scaling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "conformance/bench/bench.h"
#include "conformance/tests/temporary_folder.h"

namespace edgecase::conformance {
namespace {

using testing::HasSubstr;

/// `tiles` tiles in one row, all of the work that `costs` has for them.
rasterizer::Plan plan_for(const TaskCosts& costs, int threads, double least_help) {
  const auto tiles = static_cast<int>(costs.parts.size());
  std::vector<double> work;
  for (const auto& parts : costs.parts) work.push_back(std::accumulate(parts.begin(), parts.end(), 0.0));
  return {rasterizer::TileGrid(*rasterizer::Target::make(1'000, 1'000), tiles, 1),
          threads,
          1,
          rasterizer::Parts::even(costs.parts.front().size(), costs.parts.front().size()),
          work,
          0,
          0,
          least_help};
}

double at_once(int) { return 0; }
double one_by_one(int thread) { return 30.0 * thread; }

TEST(Scaling, ThreadsJoinWhenTheyHaveStarted) {
  const TaskCosts costs{0, {}, {std::vector<double>(9, 10)}, {0}};
  EXPECT_DOUBLE_EQ(play(costs, plan_for(costs, 2, 1), one_by_one).end, 60);
}

TEST(Scaling, OneThreadDoesEverythingOneAfterTheOther) {
  const TaskCosts costs{0, {1, 2}, {{10, 20}, {30, 40}}, {5, 5}};
  const Schedule schedule = play(costs, plan_for(costs, 1, 0), at_once);
  EXPECT_DOUBLE_EQ(schedule.end, 113);
  EXPECT_DOUBLE_EQ(schedule.tasks, 113);
}

TEST(Scaling, TilesAreTakenInFallingOrderByWhoIsFree) {
  // Too little is left anywhere to help: 60 | 40 | 30, then 20 behind the 30, 10 behind the 40.
  const TaskCosts costs{0, {}, {{10}, {60}, {20}, {30}, {40}}, {0, 0, 0, 0, 0}};
  EXPECT_DOUBLE_EQ(play(costs, plan_for(costs, 3, 100), at_once).end, 60);
  EXPECT_DOUBLE_EQ(play(costs, plan_for(costs, 2, 100), at_once).end, 80);  // 60 20 | 40 30 10
}

TEST(Scaling, OneTileIsSharedAtThePriceOfAMaskForEach) {
  const TaskCosts costs{0, {}, {std::vector<double>(8, 10)}, {3}};
  // The first thread needs none. All four add up the others' masks.
  const Schedule schedule = play(costs, plan_for(costs, 4, 1), at_once);
  EXPECT_DOUBLE_EQ(schedule.end, 20 + 9.0 / 4);
  EXPECT_DOUBLE_EQ(schedule.tasks, 89);
  EXPECT_DOUBLE_EQ(play(costs, plan_for(costs, 4, 1'000), at_once).end, 80);
}

TEST(Scaling, APartWaitsForItsBinsAndForNoOthers) {
  // The second thread is done binning at 1, begins with chunk 0 of its tile at 10, when the first one has binned it.
  const TaskCosts costs{0, {10, 1}, {{2, 2}, {5, 5}}, {0, 0}};
  EXPECT_DOUBLE_EQ(play(costs, plan_for(costs, 2, 100), at_once).end, 20);
}

TEST(Scaling, TheCommandWritesATableAndAPicture) {
  const TemporaryFolder folder;
  BenchOptions options;
  options.quick = true;
  options.scaling = folder.string();
  testing::internal::CaptureStdout();
  EXPECT_EQ(bench_command(options), 0);
  const std::string table = testing::internal::GetCapturedStdout();
  EXPECT_THAT(table, testing::AllOf(HasSubstr("large20k"), HasSubstr("wide200")));
  EXPECT_TRUE(std::filesystem::exists(folder / "scaling.json"));
  EXPECT_GT(std::filesystem::file_size(folder / "scaling.png"), 10'000u);
  options.workloads = {"smal10"};
  testing::internal::CaptureStderr();
  EXPECT_EQ(bench_command(options), 2);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("no workload \"smal10\"; did you mean \"small10\"?"));
  options.workloads = {"wide200"};
  options.scaling = "/proc/scaling";
  testing::internal::CaptureStderr();
  EXPECT_EQ(bench_command(options), 2);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("cannot make the folder /proc/scaling"));
}

TEST(Scaling, OutputNamesWhatIsKnown) {
  const std::vector<ScalingPoint> points{
      {"full", 200, 2, 2, 1, 4, 13, 1'000, 1'100, 600, 1.67, 1.4, WholeDraws{1.5, 1.3, 1.1, 1.95, 120}},
      {"full", 200, 4, 4, 1, 4, 13, 1'000, 1'100, 300, 3.33}};
  const auto json = nlohmann::json::parse(scaling_json(points));
  EXPECT_EQ(json.at("points")[0].at("measured_speedup"), 1.5);
  EXPECT_TRUE(json["points"][1].at("measured_speedup").is_null());
  EXPECT_THAT(scaling_table(points),
              testing::AllOf(HasSubstr("3.33x"), HasSubstr("-10 %"), HasSubstr("1.95x"), HasSubstr("120 ns")));
  EXPECT_THAT(scaling_plot_program(points, "a.png"), testing::AllOf(HasSubstr("4 3.33\n"), HasSubstr("2 1.5\n")));
}

// Tiles that fit into a cache beat the number of threads.
TEST(Scaling, PlotReachesUpToTheHighestPoint) {
  ScalingPoint point{"wide200", 200'000, 64, 64, 16, 16, 521, 100'000, 110'000, 1'000, 100, 90};
  EXPECT_THAT(scaling_plot_program(std::span(&point, 1), "a.png"), HasSubstr("set yrange [0.9:110]\n"));
  point.predicted_speedup = 2;
  EXPECT_THAT(scaling_plot_program(std::span(&point, 1), "a.png"), HasSubstr("set yrange [0.9:70.4]\n"));
}

}  // namespace
}  // namespace edgecase::conformance
