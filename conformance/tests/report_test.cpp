#include "conformance/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "conformance/report/escape.h"
#include "conformance/report/summary.h"
#include "conformance/tests/report_samples.h"

namespace edgecase::conformance {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Escape, LeavesNoControlCharacterAndNoInvalidByte) {
  EXPECT_EQ(visible(kHostile),
            "<b a=\"1\" c='2'>&amp; ]]> \\x1b[31m \\x9b \\x00 \\x7f \n \\x0d \xef\xbf\xbd "
            "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd \xc3\xa9\xe2\x82\xac");
  EXPECT_EQ(visible_line("a\n\tb"), "a\\n\\tb");
}

TEST(Escape, KnowsWhatUtf8IsWellFormed) {
  const std::string bad = "\xef\xbf\xbd";
  for (const std::string_view good : {"\x7e", "\xc2\xa0", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80",
                                      "\xef\xbf\xbd", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbd"}) {
    EXPECT_EQ(visible(good), good);
  }
  EXPECT_EQ(visible("\xc1\xbf"), bad + bad);                      // overlong
  EXPECT_EQ(visible("\xe0\x9f\xbf"), bad + bad + bad);            // overlong
  EXPECT_EQ(visible("\xf0\x8f\xbf\xbf"), bad + bad + bad + bad);  // overlong
  EXPECT_EQ(visible("\xf4\x90\x80\x80"), bad + bad + bad + bad);  // above U+10FFFF
  EXPECT_EQ(visible("\xf9\x80\x80\x80"), bad + bad + bad + bad);  // no lead byte
  EXPECT_EQ(visible("\xe2\x28"), bad + "(");                      // cut off
  EXPECT_EQ(visible("\xc3\xc3\xa9"), bad + "\xc3\xa9");           // a lead byte where a continuation should be
  EXPECT_EQ(visible("\xe2\x82"), bad + bad);                      // cut off
  EXPECT_EQ(visible("\xef\xbf\xbf"), bad);                        // U+FFFF, which XML forbids
  EXPECT_EQ(columns("a\xc3\xa9\xe2\x82\xac"), 3u);
}

TEST(Escape, MarkupIsInert) {
  EXPECT_EQ(markup("<a b=\"c\" d='e'>&\n"), "&lt;a b=&quot;c&quot; d=&#39;e&#39;&gt;&amp;\n");
  EXPECT_EQ(markup_attribute("a\n\tb"), "a&#10;&#9;b");
  EXPECT_EQ(relative_url("javascript:alert(1)"), "./javascript%3Aalert%281%29");
  EXPECT_EQ(relative_url("a b#c?d%e\".png"), "./a%20b%23c%3Fd%25e%22.png");
}

TEST(Summary, GroupsDigits) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(123456), "123,456");
  EXPECT_EQ(grouped(UINT64_MAX), "18,446,744,073,709,551,615");
}

TEST(Summary, SaysItInWords) {
  Report report;
  report.results = {passed("lavapipe", "a", "edges"), passed("lavapipe", "b", "edges")};
  EXPECT_EQ(sentence(by_subject(report)[0]),
            "lavapipe (llvmpipe (LLVM 15.0.6, 256 bits)) agrees on every one of 2,048 samples of 8 triangles");
  report.results = {passed("edgecase", "a", "edges"), skipped("edgecase", "b", "edges")};
  EXPECT_EQ(sentence(by_subject(report)[0]),
            "edgecase agrees on every one of 1,024 samples of 4 triangles; 1 case skipped");
  report.results = {passed("s", "a", "edges"), deviating("s", "b", "edges")};
  EXPECT_EQ(
      sentence(by_subject(report)[0]),
      "s differs in 1 of 2 cases, and only as its list of known deviations says: 2 doubled among 2,048 samples of 8 "
      "triangles");
  // Known deviations beside a failure are no part of what failed.
  report.results = {failed("s", "a", "edges"), deviating("s", "b", "edges")};
  EXPECT_EQ(sentence(by_subject(report)[0]),
            "s failed 1 of 2 cases: 3 missing, 1 unexpected among 2,048 samples of 8 triangles");
  report.results = {skipped("s", "a", "edges")};
  EXPECT_EQ(sentence(by_subject(report)[0]), "s was not compared; 1 case skipped");
  Result empty = passed("s", "a", "edges");
  empty.samples_compared = 0;
  report.results = {empty};
  EXPECT_EQ(sentence(by_subject(report)[0]), "s passed 1 case, which compared no sample");
}

TEST(JsonReport, HasEveryKeyInTheDesignsOrder) {
  const auto root = nlohmann::ordered_json::parse(to_json(one_of_each()));
  const auto keys = [](const nlohmann::ordered_json& object) {
    std::vector<std::string> names;
    for (const auto& [key, value] : object.items()) names.push_back(key);
    return names;
  };
  EXPECT_THAT(keys(root), ElementsAre("edgecase", "seed", "rules", "results", "categories", "totals"));
  ASSERT_EQ(root["results"].size(), 4u);
  for (const auto& result : root["results"]) {
    EXPECT_THAT(keys(result),
                ElementsAre("subject", "device", "snap", "case", "category", "verdict", "triangles", "samples_compared",
                            "missing", "unexpected", "doubled", "meshes_checked", "known_triangles", "unpredicted",
                            "may", "cracks", "first", "reason", "seconds", "subject_seconds"));
  }
  EXPECT_THAT(keys(root["totals"]),
              ElementsAre("pass", "fail", "known", "skip", "triangles", "samples_compared", "missing", "unexpected",
                          "doubled", "meshes_checked", "known_triangles", "unpredicted", "may", "cracks", "seconds"));
  ASSERT_EQ(root["categories"].size(), 3u);
  for (const auto& category : root["categories"]) {
    EXPECT_THAT(keys(category), ElementsAre("subject", "category", "pass", "fail", "known", "skip", "triangles",
                                            "samples_compared", "missing", "unexpected", "doubled", "meshes_checked",
                                            "known_triangles", "unpredicted", "may", "cracks", "causes"));
  }
  EXPECT_THAT(keys(root["results"][1]["first"]),
              ElementsAre("kind", "triangle", "x", "y", "sample", "text", "vertices", "command"));
}

TEST(JsonReport, KeepsEveryValue) {
  const json root = json::parse(to_json(one_of_each()));
  EXPECT_EQ(root["edgecase"], "0.1.0");
  EXPECT_EQ(root["seed"].get<std::uint64_t>(), UINT64_MAX);
  EXPECT_EQ(root["results"][0], json::parse(R"j({
      "subject": "lavapipe", "device": "llvmpipe (LLVM 15.0.6, 256 bits)", "snap": null, "case": "cases/a.json", "category": "edges",
      "verdict": "pass", "triangles": 4, "samples_compared": 1024, "missing": 0, "unexpected": 0, "doubled": 0,
      "meshes_checked": 0, "known_triangles": 0, "unpredicted": 0, "may": 0,
      "cracks": {"meshes": 0, "torn_meshes": 0, "samples_inside": 0, "holes": 0, "doubled": 0, "first": null},
      "first": null, "reason": null, "seconds": 0.25, "subject_seconds": 0.125
})j"));
  EXPECT_EQ(root["results"][1]["verdict"], "fail");
  EXPECT_EQ(root["results"][1]["device"], nullptr);
  EXPECT_EQ(root["results"][1]["first"], json::parse(R"j({
      "kind": "missing", "triangle": 2, "x": 12, "y": 7, "sample": 0, "text": "..#\n.!#",
      "vertices": [["0x1.8p+0", "0x0p+0"], ["0x1.8p+0", "0x1.8p+1"], ["0x1p+2", "0x1.8p+1"]],
      "command": "edgecase run 'left edge.json' --subject softpipe"})j"));
  EXPECT_EQ(root["results"][2]["verdict"], "known");
  EXPECT_EQ(root["results"][2]["meshes_checked"], 3);
  EXPECT_EQ(root["results"][2]["known_triangles"], 1);
  EXPECT_EQ(root["results"][3]["verdict"], "skip");
  EXPECT_EQ(root["results"][3]["reason"], "16 samples are not supported");
  EXPECT_EQ(root["totals"], json::parse(R"j({
      "pass": 1, "fail": 1, "known": 1, "skip": 1, "triangles": 12, "samples_compared": 3072, "missing": 3,
      "unexpected": 1, "doubled": 2, "meshes_checked": 3, "known_triangles": 1, "unpredicted": 0,
      "may": 0, "cracks": 0, "seconds": 1.5})j"));
  EXPECT_EQ(root["categories"][2], json::parse(R"j({
      "subject": "softpipe", "category": "edges", "pass": 0, "fail": 1, "known": 1, "skip": 0, "triangles": 8,
      "samples_compared": 2048, "missing": 3, "unexpected": 1, "doubled": 2, "meshes_checked": 3,
      "known_triangles": 1, "unpredicted": 0, "may": 0, "cracks": 0, "causes": [{"verdict": "known", "reason": "breaks ties to the right", "cases": 1}]})j"));
}

TEST(JsonReport, TakesAnyBytes) {
  Report report = one_of_each();
  report.results[0].testcase = kHostile;
  const json root = json::parse(to_json(report));
  EXPECT_THAT(root["results"][0]["case"].get<std::string>(),
              HasSubstr("\x1b[31m"));  // JSON carries controls as they are
  EXPECT_THAT(root["results"][0]["case"].get<std::string>(), HasSubstr(" \xef\xbf\xbd "));  // the stray byte
  report.results.clear();
  EXPECT_EQ(json::parse(to_json(report))["results"], json::array());
}

TEST(TextReport, IsAligned) {
  Report report = one_of_each();
  report.results[0].samples_compared = 1234567;
  report.results[1].subject = "d\xc3\xa9j\xc3\xa0";
  const auto expected = R"(
subject   category  cases  triangles    samples  missing  unexpected  doubled  failed  known  skipped
lavapipe  edges         1          4  1,234,567        0           0        0       0      0        0
lavapipe  samples       1          -          -        -           -        -       0      0        1
déjà      edges         1          4      1,024        3           1        0       1      0        0
softpipe  edges         1          4      1,024        0           0        2       0      1        0
)";
  EXPECT_EQ(to_text(report, false).substr(0, std::string(expected).size()), std::string(expected).substr(1) + "\n");
}

TEST(TextReport, HasALineForEachSubjectAndCategory) {
  Report report;
  for (int i = 0; i < 80; ++i) {
    report.results.push_back(passed("lavapipe", "case" + std::to_string(i), "edges"));
    report.results.push_back(i == 7 ? failed("softpipe", "case7", "edges") : passed("softpipe", "case", "edges"));
  }
  const auto lines = lines_of(to_text(report, false));
  EXPECT_EQ(lines[1],
            "lavapipe  edges        80        320   81,920        0           0        0       0      0        0");
  EXPECT_EQ(lines[2],
            "softpipe  edges        80        320   81,920        3           1        0       1      0        0");
  EXPECT_EQ(lines[3], "");
}

TEST(TextReport, NamesCausesWithTheirCategories) {
  Report report;
  report.results = {skipped("s", "a", "edges"), skipped("s", "b", "samples"), passed("s", "c", "edges")};
  EXPECT_THAT(to_text(report, false),
              HasSubstr("\nskip s: 2 cases (edges, samples)\n  16 samples are not supported\n"));
}

Result torn_by_clipping() {
  Result result = passed("lavapipe", "clip_grids", "clip_mesh");
  result.cracks = {.meshes = 70,
                   .torn_meshes = 2,
                   .samples_inside = 4096,
                   .holes = 12,
                   .doubled = 3,
                   .first = WrongSample{WrongSample::Kind::missing, 5, 12, 7, 0}};
  return result;
}

TEST(Reports, CracksAreShownAndNoFailure) {
  Report report;
  report.results = {torn_by_clipping()};
  const std::string text = to_text(report, false);
  EXPECT_THAT(text, HasSubstr("\ncracks lavapipe: clip_grids\n"
                              "  12 holes, 3 doubled among 4,096 samples inside; 2 of 70 clipped meshes torn\n"
                              "  first: hole at pixel (12, 7), sample 0, mesh from triangle 5\n"));
  EXPECT_THAT(lines_of(text)[0], HasSubstr("  cracks"));
  EXPECT_THAT(text, HasSubstr("1 passed, 0 failed"));
  const json root = json::parse(to_json(report));
  EXPECT_EQ(root["results"][0]["cracks"], json::parse(R"j({"meshes": 70, "torn_meshes": 2, "samples_inside": 4096,
      "holes": 12, "doubled": 3, "first": {"kind": "missing", "triangle": 5, "x": 12, "y": 7, "sample": 0}})j"));
  EXPECT_EQ(root["categories"][0]["cracks"], 15);
  const std::string page = to_html(report);
  EXPECT_THAT(page, HasSubstr("Meshes that clipping tears"));
  EXPECT_THAT(page, HasSubstr("12 holes, 3 doubled among 4,096 samples inside"));
}

TEST(TextReport, ExplainsWhatDidNotPass) {
  const std::string text = to_text(one_of_each(), false);
  EXPECT_THAT(text, HasSubstr("\nFAIL softpipe: cases/a.json\n"
                              "  3 samples of a left edge are missing\n"
                              "  3 missing, 1 unexpected among 1,024 samples of 4 triangles\n"
                              "  first: missing at pixel (12, 7), sample 0, triangle 2: (0x1.8p+0, 0x0p+0) "
                              "(0x1.8p+0, 0x1.8p+1) (0x1p+2, 0x1.8p+1)\n"
                              "  ..#\n"
                              "  .!#\n"
                              "  to see it again: edgecase run 'left edge.json' --subject softpipe\n"));
  EXPECT_THAT(text, HasSubstr("\nknown softpipe: cases/b.json\n  breaks ties to the right\n"));
  EXPECT_THAT(text, HasSubstr("\nskip lavapipe: cases/c.json\n  16 samples are not supported\n"));
  EXPECT_THAT(text, HasSubstr("\n1 passed, 1 failed, 1 known to deviate, 1 skipped, in 1.5 s (rules exact, seed "
                              "18446744073709551615).\n"));
}

TEST(TextReport, ColoursOnlyATerminal) {
  Report report = one_of_each();
  report.results[0].testcase = kHostile;
  EXPECT_THAT(to_text(report, false), Not(HasSubstr("\x1b")));
  const std::string text = to_text(report, true);
  EXPECT_THAT(text, HasSubstr("     \x1b[1;31m1\x1b[0m  "));
  EXPECT_THAT(text, Not(HasSubstr("\x1b[31m")));  // the name's own colour sequence
}

TEST(TextReport, SaysThatNothingWasCompared) { EXPECT_EQ(to_text(Report{}, false), "Nothing was compared.\n"); }

}  // namespace
}  // namespace edgecase::conformance
