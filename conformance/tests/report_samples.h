// Results that the tests of the report's forms share.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "conformance/report/report.h"

namespace edgecase::conformance {

inline Result passed(const std::string& subject, const std::string& testcase, const std::string& category) {
  Result result;
  result.subject = subject;
  result.device = subject == "lavapipe" ? "llvmpipe (LLVM 15.0.6, 256 bits)" : "";
  result.testcase = testcase;
  result.category = category;
  result.triangles = 4;
  result.samples_compared = 1024;
  result.seconds = 0.25;
  result.subject_seconds = 0.125;
  return result;
}

inline Result failed(const std::string& subject, const std::string& testcase, const std::string& category) {
  Result result = passed(subject, testcase, category);
  result.verdict = Verdict::fail;
  result.missing = 3;
  result.unexpected = 1;
  result.reason = "3 samples of a left edge are missing";
  result.first = FirstWrong{.kind = "missing",
                            .triangle = 2,
                            .x = 12,
                            .y = 7,
                            .sample = 0,
                            .text = "..#\n.!#",
                            .vertices = {{{"0x1.8p+0", "0x0p+0"}, {"0x1.8p+0", "0x1.8p+1"}, {"0x1p+2", "0x1.8p+1"}}},
                            .command = "edgecase run 'left edge.json' --subject " + subject};
  return result;
}

inline Result deviating(const std::string& subject, const std::string& testcase, const std::string& category) {
  Result result = passed(subject, testcase, category);
  result.verdict = Verdict::known;
  result.doubled = 2;
  result.meshes_checked = 3;
  result.known_triangles = 1;
  result.reason = "breaks ties to the right";
  return result;
}

inline Result skipped(const std::string& subject, const std::string& testcase, const std::string& category) {
  Result result;
  result.subject = subject;
  result.testcase = testcase;
  result.category = category;
  result.verdict = Verdict::skip;
  result.reason = "16 samples are not supported";
  return result;
}

inline Report one_of_each() {
  Report report;
  report.version = "0.1.0";
  report.seed = UINT64_MAX;
  report.seconds = 1.5;
  report.results = {passed("lavapipe", "cases/a.json", "edges"), failed("softpipe", "cases/a.json", "edges"),
                    deviating("softpipe", "cases/b.json", "edges"), skipped("lavapipe", "cases/c.json", "samples")};
  return report;
}

/// Everything that some format or terminal would act on: markup, quotes, a colour sequence, a C1 control, a NUL, a line
/// feed, a stray continuation byte and a surrogate, besides two letters that have to survive.
using namespace std::string_view_literals;
inline constexpr std::string_view kHostile =
    "<b a=\"1\" c='2'>&amp; ]]> \x1b[31m \xc2\x9b \0 \x7f \n \r \x80 \xed\xa0\x80 \xc3\xa9\xe2\x82\xac"sv;

}  // namespace edgecase::conformance
