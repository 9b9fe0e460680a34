// The stability table: nothing wrong where arithmetic is exact, and wrong where it is known to break.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "conformance/runner/stability.h"

namespace edgecase::conformance {
namespace {

using testing::HasSubstr;

const Stability& measured() {
  static const Stability stability = [] {
    const std::vector<std::string> subjects{"edgecase", "inexact:int32", "inexact:bits0", "inexact:float"};
    auto found = measure_stability(subjects, 1, 200, [](std::uint64_t) {});
    EXPECT_TRUE(found) << found.error().message;
    return found.value_or(Stability{});
  }();
  return stability;
}

const StabilityRow& row(const std::string& subject, const std::string& family) {
  return *std::ranges::find_if(measured().rows,
                               [&](const StabilityRow& r) { return r.subject == subject && r.family == family; });
}

TEST(Stability, TheExactSubjectIsNowhereWrong) {
  std::size_t rows = 0;
  for (const StabilityRow& r : measured().rows) {
    if (r.subject != "edgecase") continue;
    ++rows;
    EXPECT_GE(r.triangles, 200u) << r.family;
    EXPECT_GT(r.to_cover, 0u) << r.family;
    EXPECT_EQ(r.wrong + r.gaps + r.doubles, 0u) << r.family;
    EXPECT_FALSE(r.refused) << r.family;
  }
  EXPECT_EQ(rows, families().size());
}

TEST(Stability, InexactArithmeticFailsWhereItsNumbersEnd) {
  EXPECT_EQ(row("inexact:int32", "range_32").wrong, 0u);
  EXPECT_GT(row("inexact:int32", "range_1024").wrong_per_million(), 100'000);
  EXPECT_GT(row("inexact:int32", "big_triangulation").gaps, 0u);
  EXPECT_EQ(row("inexact:int32", "off_grid").wrong, 0u);
  EXPECT_GT(row("inexact:bits0", "off_grid").wrong, 0u);
  EXPECT_GT(row("inexact:bits0", "fan").doubles, 0u);
  EXPECT_EQ(row("inexact:float", "range_16").wrong, 0u);
  EXPECT_GT(row("inexact:float", "off_grid").wrong + row("inexact:float", "sliver").wrong, 0u);
}

TEST(Stability, SaysWhereEachFirstFails) {
  const auto& limits = measured().limits;
  ASSERT_EQ(limits.size(), 4u);
  EXPECT_TRUE(limits[0].limit.refused);
  EXPECT_GT(limits[1].limit.pixels(), 64);
  EXPECT_LT(limits[1].limit.pixels(), 128);
  EXPECT_EQ(limits[2].limit.exact, 0);
}

TEST(Stability, IsShownAsTextJsonAndPlot) {
  const std::string text = stability_text(measured());
  EXPECT_THAT(text, HasSubstr("big_triangulation"));
  EXPECT_THAT(text, HasSubstr("exact to ±32,767.99609375 px; beyond: not accepted"));
  const auto json = nlohmann::json::parse(stability_json(measured(), 1));
  EXPECT_EQ(json["rows"].size(), measured().rows.size());
  EXPECT_EQ(json["limits"][1]["subject"], "inexact:int32");
  EXPECT_EQ(json["rows"][0]["wrong"], 0);
  const std::string plot = stability_plot(measured(), "it's.png");
  EXPECT_THAT(plot, HasSubstr("set output 'it''s.png'"));
  EXPECT_THAT(plot, HasSubstr("title 'bits0'"));
  EXPECT_THAT(plot, HasSubstr("\n1024 "));
  EXPECT_THAT(plot, HasSubstr(": doubles'"));
  EXPECT_THAT(plot, HasSubstr("\"exact to ±"));
}

}  // namespace
}  // namespace edgecase::conformance
