// A suite that cannot fail proves nothing: every planted fault must be caught, by the very run that users start.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "conformance/generators/generator.h"
#include "conformance/runner/case_library.h"
#include "conformance/runner/run.h"
#include "conformance/subjects/fault_subject.h"

namespace edgecase::conformance {
namespace {

const std::vector<Case>& all_cases() {
  static const std::vector<Case> cases =
      load_all_cases(std::filesystem::path(EDGECASE_SOURCE_DIR) / "cases").value();
  return cases;
}

RunPlan plan_for(const std::string& subject) {
  RunPlan plan;
  plan.subjects = {subject};
  for (const Case& file : all_cases()) plan.testcases.push_back({&file, nullptr});
  for (const Generator& generator : generators()) plan.testcases.push_back({nullptr, &generator});
  plan.count = 2'000;
  return plan;
}

std::set<std::string> caught_by(const std::string& subject) {
  const auto results = run(plan_for(subject), [](std::uint64_t) {});
  EXPECT_TRUE(results) << results.error().message;
  std::set<std::string> names;
  for (const RunResult& result : *results) {
    EXPECT_FALSE(result.trial.failure) << result.trial.failure->message;
    if (result.trial.outcome.unexplained != 0) names.insert(result.testcase.name());
  }
  return names;
}

class FaultDetection : public testing::TestWithParam<FaultInfo> {};

TEST_P(FaultDetection, CasesAndGeneratorsCatchIt) {
  const auto caught = caught_by("fault:" + std::string(GetParam().name));
  std::size_t by_cases = 0;
  for (const Case& file : all_cases()) by_cases += caught.count(file.name);
  EXPECT_GT(by_cases, 0u) << "no case file shows that " << GetParam().description;
  // The generators draw on the subpixel grid, where every way of snapping is the same.
  if (!GetParam().name.starts_with("snap-")) {
    EXPECT_GT(caught.size(), by_cases) << "no generator shows that " << GetParam().description;
  }
}

INSTANTIATE_TEST_SUITE_P(Planted, FaultDetection, testing::ValuesIn(faults().begin(), faults().end()),
                         [](const auto& fault) {
                           std::string name(fault.param.name);
                           std::erase(name, '-');
                           return name;
                         });

TEST(FaultDetection, OursIsCleared) { EXPECT_TRUE(caught_by("edgecase").empty()); }

}  // namespace
}  // namespace edgecase::conformance
