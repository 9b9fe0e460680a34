#include "conformance/bench/bench.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <set>

#include "conformance/bench/contenders.h"
#include "conformance/bench/plain.h"
#include "conformance/bench/plot.h"
#include "conformance/bench/timing.h"
#include "conformance/subjects/family_subject.h"
#include "conformance/tests/temporary_folder.h"
#include "rasterizer/fast/fast.h"
#include "rasterizer/scalar.h"

namespace edgecase::conformance {
namespace {

using testing::HasSubstr;

tl::expected<std::unique_ptr<Subject>, Error> no_subject(const std::string& name) {
  return tl::unexpected(Error{ErrorKind::absent, "no driver " + name});
}

BenchOptions quick(std::vector<std::string> workloads, std::vector<std::string> subjects) {
  BenchOptions options;
  options.workloads = std::move(workloads);
  options.subjects = std::move(subjects);
  options.quick = true;
  options.make_subject = no_subject;
  return options;
}

TEST(BenchStatistics, MedianAndQuartiles) {
  EXPECT_EQ(statistics({7}).median, 7);
  EXPECT_EQ(statistics({7}).spread, 0);
  EXPECT_EQ(statistics({5, 1, 4, 2, 3}).median, 3);
  EXPECT_EQ(statistics({5, 1, 4, 2, 3}).spread, 2.0 / 3);
  EXPECT_EQ(statistics({4, 1, 3, 2}).median, 2.5);
}

TEST(BenchContenders, ThoseThatAreExactCountNoErrorsOnAnyWorkload) {
  std::set<std::string> names;
  for (const auto& contender : built_in_contenders()) {
    SCOPED_TRACE(contender->name());
    EXPECT_TRUE(names.insert(contender->name()).second);
    if (contender->name().starts_with("inexact:")) continue;
    if (testing::Matches(testing::AnyOf("plain:bits0", "plain:bits2", "plain:bits4", "plain:bits6"))(contender->name()))
      continue;
    for (const Workload& workload : workloads()) {
      SCOPED_TRACE(workload.name);
      const Scene scene = make_workload(workload, workload.name == "full" ? 4 : workload.name == "sliver" ? 20 : 300);
      ASSERT_TRUE(contender->prepare(scene));
      contender->clear();
      ASSERT_TRUE(contender->draw());
      const auto count = count_errors(*contender, scene);
      ASSERT_TRUE(count);
      EXPECT_GT(count->covered, 0u);
      EXPECT_EQ(count->wrong, 0u);
    }
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"plain", "edgecase", "edgecase:portable", "edgecase:larrabee",
                                            "inexact:float", "plain:bits0", "plain:bits16"}));
}

TEST(BenchContenders, TheFastPathSaysWhichInstructionSetItRuns) {
  const auto isas = rasterizer::available_isas();
  std::size_t found = 0;
  for (const auto& contender : built_in_contenders()) {
    if (contender->name() == "edgecase") {
      EXPECT_EQ(contender->isa(), rasterizer::name_of(isas.back()));
    }
    for (const rasterizer::Isa isa : isas) {
      if (contender->name() != "edgecase:" + std::string(rasterizer::name_of(isa))) continue;
      EXPECT_EQ(contender->isa(), rasterizer::name_of(isa));
      ++found;
    }
  }
  EXPECT_EQ(found, isas.size());
}

TEST(BenchContenders, InexactOnesCountWrongPixels) {
  for (const auto& contender : built_in_contenders()) {
    if (contender->name() != "inexact:bits4") continue;
    const Scene scene = make_workload(*find_workload("small10"), 2'000);
    ASSERT_TRUE(contender->prepare(scene));
    const auto count = count_errors(*contender, scene);
    ASSERT_TRUE(count);
    // Vertices move by up to 1/32 px, along 15 px of edges or so: of 10 px, some hundredths.
    EXPECT_GT(count->wrong * 1'000, count->covered);
    EXPECT_LT(count->wrong * 10, count->covered);
  }
}

/// Covers nothing but one pixel in the target's last corner.
class Stray : public Contender {
 public:
  std::string name() const override { return "stray"; }
  std::string isa() const override { return {}; }
  tl::expected<void, Error> prepare(const Scene&) override { return {}; }
  void clear() override {}
  tl::expected<void, Error> draw() override { return {}; }
  void cover(std::size_t, MutableMaskView mask) override { mask.back() |= 1; }
};

TEST(BenchErrors, MissingAndUnexpectedPixelsAddUpWhereverTheyAre) {
  Scene scene;
  scene.setting.target = {70, 40};
  scene.triangles = {{{{0, 0}, {4, 0}, {0, 4}}}, {{{0, 1}, {4, 1}, {0, 5}}}};  // six pixels each
  Stray stray;
  const auto count = count_errors(stray, scene);
  ASSERT_TRUE(count);
  EXPECT_EQ(count->covered, 12u);
  EXPECT_EQ(count->wrong, 12u + 1u);
}

/// Notes what is asked of it.
class Noting : public Stray {
 public:
  void clear() override { asked_ += 'c'; }
  void shuffle(std::mt19937_64&) override { asked_ += 's'; }
  tl::expected<void, Error> draw() override {
    asked_ += 'd';
    return {};
  }
  const std::string& asked() const { return asked_; }

 private:
  std::string asked_;
};

TEST(BenchTime, EachDrawComesAfterClearingAndShuffling) {
  std::vector<std::unique_ptr<Contender>> contenders;
  contenders.push_back(std::make_unique<Noting>());
  const std::string& asked = static_cast<const Noting&>(*contenders.front()).asked();
  ASSERT_TRUE(time_draws(contenders, {2, 1e-6}));
  ASSERT_GE(asked.size(), 6u);
  for (std::size_t i = 0; i < asked.size(); ++i) ASSERT_EQ(asked[i], "csd"[i % 3]) << i;
}

TEST(BenchTime, ShortListsAreShuffledAndLongOnesAreNot) {
  std::mt19937_64 random;
  std::vector<std::size_t> numbers(kShortList);
  std::iota(numbers.begin(), numbers.end(), 0);
  std::vector<std::size_t> shuffled = numbers;
  shuffle_if_short(shuffled, random);
  EXPECT_NE(shuffled, numbers);
  std::ranges::sort(shuffled);
  EXPECT_EQ(shuffled, numbers);
  shuffled.push_back(0);
  const std::vector<std::size_t> longer = shuffled;
  shuffle_if_short(shuffled, random);
  EXPECT_EQ(shuffled, longer);
}

TEST(BenchErrors, TheMoreBitsTheNearerToTheRealGeometry) {
  BenchOptions options = quick({"small10"}, {"plain:bits0", "plain:bits4", "plain:bits12", "plain:bits16", "edgecase"});
  const auto rows = bench(options);
  ASSERT_TRUE(rows) << rows.error().message;
  const auto real = [&](const char* name) {
    const auto row = std::ranges::find(*rows, name, &BenchRow::rasterizer);
    return row->wrong_per_million_real.value();
  };
  EXPECT_EQ(real("edgecase"), real("plain"));
  // 16 times the distance, 16 times the pixels, roughly; whole pixels are too coarse for such a law.
  EXPECT_GT(real("plain:bits0"), 3 * real("plain:bits4"));
  EXPECT_NEAR(real("plain:bits4") / real("plain"), 16, 8);
  EXPECT_GT(real("plain"), 4 * real("plain:bits12"));
  EXPECT_GE(real("plain:bits12"), real("plain:bits16"));
  EXPECT_FALSE(bench(quick({"full"}, {"edgecase"}))->front().wrong_per_million_real);
}

TEST(BenchPlain, IsExactInNarrowAndInWideSteps) {
  using F = rasterizer::Format16_8;
  const auto target = *rasterizer::Target::make(90, 50);
  std::mt19937_64 random(40);
  for (int i = 0; i < 3'000; ++i) {
    const int shift = static_cast<int>(random() % 16);  // vertices from 1/2 px to the end of the range away
    const auto coordinate = [&] {
      return F::Coordinate::checked((static_cast<std::int64_t>(random()) >> (40 + shift)) + (shift > 2 ? 6'000 : 0))
          .value();
    };
    const auto vertex = [&] {
      const auto x = coordinate();
      return rasterizer::FixedVertex<F>{x, coordinate()};
    };
    rasterizer::FixedTriangle<F> triangle;
    for (auto& v : triangle) v = vertex();
    std::vector<std::uint8_t> observed(90 * 50), vectorized(90 * 50), expected(90 * 50);
    cover_plain<8>(PlainLoop::scalar, triangle, target, observed.data());
    cover_plain<8>(PlainLoop::vectorized, triangle, target, vectorized.data());
    rasterizer::cover_scalar<F>(triangle, rasterizer::View<>{target}, [&](int y, int word, std::uint64_t bits) {
      for (int bit = 0; bit < 64; ++bit) {
        if (bits >> bit & 1) expected.at(static_cast<std::size_t>(y * 90 + word * 64 + bit)) = 1;
      }
    });
    ASSERT_EQ(observed, expected) << i;
    ASSERT_EQ(vectorized, expected) << i;
  }
}

TEST(Bench, MeasuresWhatWasAskedForBesidePlain) {
  const auto rows = bench(quick({"small10", "ties"}, {"edgecase:trapezoid", "inexact:bits0"}));
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->size(), 6u);
  for (const BenchRow& row : *rows) {
    EXPECT_GT(row.ns_per_triangle, 0);
    EXPECT_GT(row.ratio_to_plain, 0);
    EXPECT_GE(row.spread, 0);
    EXPECT_GT(row.covered_px_per_second, 0);
    EXPECT_EQ(row.wrong_per_million > 0, row.rasterizer == "inexact:bits0") << row.rasterizer;
  }
  EXPECT_EQ(rows->front().rasterizer, "plain");
  EXPECT_EQ(rows->front().workload, "small10");
  EXPECT_EQ(rows->front().ratio_to_plain, 1);
  EXPECT_EQ(rows->front().triangles, 10'000u);
  EXPECT_EQ((*rows)[4].rasterizer, "edgecase:trapezoid");
  EXPECT_EQ((*rows)[4].workload, "ties");
}

TEST(Bench, ASubjectIsFoundByTheCallersFactory) {
  BenchOptions options = quick({"med200"}, {"some-driver"});
  options.make_subject = [](const std::string&) -> tl::expected<std::unique_ptr<Subject>, Error> {
    return make_family_subject("quads");
  };
  const auto rows = bench(options);
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->size(), 2u);
  EXPECT_EQ((*rows)[1].rasterizer, "edgecase:quads");
  EXPECT_EQ((*rows)[1].triangles, 2'000u);
  EXPECT_EQ((*rows)[1].clock, Clock::wall);
  EXPECT_LT((*rows)[1].target.width, 64);
  EXPECT_EQ((*rows)[0].target, (Extent{1920, 1080}));
  EXPECT_EQ((*rows)[1].wrong_per_million, 0);
}

/// Draws what it should, and says that its driver took a millisecond a draw.
class TimedSubject : public Subject {
 public:
  const SubjectInfo& info() const override { return drawing_->info(); }
  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    seconds_ += 1e-3;
    return drawing_->draw(scene, masks);
  }
  double driver_seconds() const override { return seconds_; }

 private:
  std::unique_ptr<Subject> drawing_ = make_family_subject("quads");
  double seconds_ = 0;
};

TEST(Bench, ADriversOwnClockCounts) {
  BenchOptions options = quick({"large20k", "full"}, {"timed"});
  options.make_subject = [](const std::string&) -> tl::expected<std::unique_ptr<Subject>, Error> {
    return std::make_unique<TimedSubject>();
  };
  const auto rows = bench(options);
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->size(), 4u);
  for (const std::size_t i : {1u, 3u}) {
    const BenchRow& row = (*rows)[i];
    EXPECT_EQ(row.clock, Clock::driver);
    EXPECT_NEAR(row.ns_per_triangle, 1e6 / static_cast<double>(row.triangles), 1);
    EXPECT_EQ(row.wrong_per_million, 0);
  }
}

TEST(BenchCommand, BadInputIsOneLineAndAnExitStatus) {
  const auto status = [](const BenchOptions& options, const char* words) {
    testing::internal::CaptureStderr();
    const int result = bench_command(options);
    const std::string text = testing::internal::GetCapturedStderr();
    EXPECT_THAT(text, HasSubstr(words));
    EXPECT_EQ(std::ranges::count(text, '\n'), 1);
    return result;
  };
  EXPECT_EQ(status(quick({"smal10"}, {}), "there is no workload \"smal10\"; did you mean \"small10\"?"), 2);
  EXPECT_EQ(status(quick({"full"}, {"nvidia"}), "no driver nvidia"), 3);
  BenchOptions unwritable = quick({"full"}, {});
  unwritable.json = "/nonexistent/rows.json";
  EXPECT_EQ(status(unwritable, "cannot write /nonexistent/rows.json"), 2);
  // A run that fails leaves no file behind.
  BenchOptions failing = quick({"smal10"}, {});
  const TemporaryFolder folder;
  failing.json = (folder / "rows.json").string();
  EXPECT_EQ(status(failing, "small10"), 2);
  EXPECT_FALSE(std::filesystem::exists(failing.json));
}

std::vector<BenchRow> some_rows() {
  return {{"plain", "avx2", "full", 200, 150'000, 0.01, 1, 0, 1e9},
          {"inexact:float", "sse2", "full", 200, 300'000, 0.02, 0.5, 25, 1e8},
          {"it's", "", "full", 200, 30'000, 0.02, 5, 0, 1e10}};
}

TEST(BenchOutput, JsonHasARowForEach) {
  const auto json = nlohmann::json::parse(bench_json(some_rows()));
  ASSERT_EQ(json.at("rows").size(), 3u);
  const auto& row = json["rows"][1];
  EXPECT_EQ(row.at("rasterizer"), "inexact:float");
  EXPECT_EQ(row.at("isa"), "sse2");
  EXPECT_EQ(row.at("workload"), "full");
  EXPECT_EQ(row.at("triangles"), 200);
  EXPECT_EQ(row.at("ns_per_triangle"), 300'000);
  EXPECT_EQ(row.at("spread"), 0.02);
  EXPECT_EQ(row.at("ratio_to_plain"), 0.5);
  EXPECT_EQ(row.at("wrong_per_million"), 25);
  EXPECT_TRUE(row.at("wrong_per_million_real").is_null());
  EXPECT_TRUE(row.at("instructions_per_triangle").is_null());
  auto rows = some_rows();
  rows[1].wrong_per_million_real = 24;
  rows[1].instructions_per_triangle = 320;
  const auto full = nlohmann::json::parse(bench_json(rows))["rows"][1];
  EXPECT_EQ(full.at("wrong_per_million_real"), 24);
  EXPECT_EQ(full.at("instructions_per_triangle"), 320);
}

TEST(BenchOutput, TheTableHasEveryRasterizer) {
  const std::string table = bench_table(some_rows());
  EXPECT_THAT(table, HasSubstr("inexact:float"));
  EXPECT_THAT(table, HasSubstr("300000"));
  EXPECT_THAT(table, HasSubstr("wrong px per million, by the rules"));
  // What no row has is no section.
  EXPECT_THAT(table, testing::Not(HasSubstr("real geometry")));
  EXPECT_THAT(table, testing::Not(HasSubstr("subpixel bits")));
  auto rows = some_rows();
  rows[1].rasterizer = "plain:bits4";
  rows[1].wrong_per_million_real = 24;
  EXPECT_THAT(bench_table(rows), HasSubstr("real geometry"));
  EXPECT_THAT(bench_table(rows), testing::Not(HasSubstr("as plain:vectorized")));
  rows[2].rasterizer = "plain:vectorized";
  EXPECT_THAT(bench_table(rows), testing::ContainsRegex("as plain:vectorized +full\nplain +0.2\nplain:bits4 +0.1\n"));
  rows[2].rasterizer = "it's";
  EXPECT_THAT(bench_table(rows), testing::ContainsRegex("full +4 +300000 +0.5 +25 +24\n"));
}

TEST(BenchOutput, ThePlotIsAPicture) {
  EXPECT_THAT(plot_program(some_rows(), "a'b.png"), HasSubstr("'a''b.png'"));
  EXPECT_THAT(plot_program(some_rows(), "p.png"), HasSubstr("'it''s'"));
  const TemporaryFolder folder;
  const auto path = folder / "plot.png";
  const auto drawn = plot_bench(some_rows(), path.string());
  ASSERT_TRUE(drawn) << drawn.error().message;
  std::ifstream file(path, std::ios::binary);
  std::string signature(4, ' ');
  file.read(signature.data(), 4);
  EXPECT_EQ(signature, "\x89PNG");
  EXPECT_GT(std::filesystem::file_size(path), 10'000u);
  EXPECT_FALSE(plot_bench(some_rows(), "/nonexistent/plot.png"));
}

}  // namespace
}  // namespace edgecase::conformance
