// A suite that cannot fail proves nothing: every planted fault must be caught, by the very run that users start.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "conformance/generators/generator.h"
#include "conformance/runner/case_library.h"
#include "conformance/runner/run.h"
#include "conformance/subjects/fault_subject.h"

namespace edgecase::conformance {
namespace {

constexpr std::uint64_t kCount = 2'000;

const std::vector<Case>& all_cases() {
  static const std::vector<Case> cases = load_all_cases(std::filesystem::path(EDGECASE_SOURCE_DIR) / "cases").value();
  return cases;
}

std::vector<Testcase> all_generators() {
  std::vector<Testcase> all;
  for (const Generator& generator : generators()) all.push_back({nullptr, &generator});
  for (const Generator& generator : clip_generators()) all.push_back({nullptr, &generator});
  return all;
}

// The names of those testcases that catch the subject.
std::vector<std::string> caught_by(const std::string& subject, const std::vector<Testcase>& testcases) {
  RunPlan plan;
  plan.subjects = {subject};
  plan.testcases = testcases;
  plan.count = kCount;
  const auto results = run(plan, [](std::uint64_t) {});
  EXPECT_TRUE(results) << results.error().message;
  std::vector<std::string> names;
  for (const RunResult& result : *results) {
    EXPECT_FALSE(result.trial.failure) << result.trial.failure->message;
    if (result.trial.outcome.unexplained != 0) names.push_back(result.testcase.name());
  }
  return names;
}

std::vector<std::string> caught_by_cases(const std::string& subject) {
  std::vector<Testcase> cases;
  for (const Case& file : all_cases()) cases.push_back({&file, nullptr});
  return caught_by(subject, cases);
}

class FaultDetection : public testing::TestWithParam<FaultInfo> {};

TEST_P(FaultDetection, CasesAndGeneratorsCatchIt) {
  const std::string subject = "fault:" + std::string(GetParam().name);
  EXPECT_FALSE(caught_by_cases(subject).empty()) << "no case file shows that " << GetParam().description;
  const auto generators = all_generators();
  EXPECT_TRUE(std::ranges::any_of(generators,
                                  [&](const Testcase& generator) { return !caught_by(subject, {generator}).empty(); }))
      << "no generator shows that " << GetParam().description;
}

INSTANTIATE_TEST_SUITE_P(Planted, FaultDetection, testing::ValuesIn(faults().begin(), faults().end()),
                         [](const auto& fault) {
                           std::string name(fault.param.name);
                           std::erase(name, '-');
                           return name;
                         });

TEST(FaultDetection, OursIsCleared) {
  EXPECT_EQ(caught_by_cases("edgecase"), std::vector<std::string>());
  EXPECT_EQ(caught_by("edgecase", all_generators()), std::vector<std::string>());
}

// What catches a fault must not catch its host.
TEST(FaultDetection, TheFaultsHostIsCleared) {
  const auto host = make_faultless_subject();
  auto reference = reference_for(host->info().name);
  ASSERT_TRUE(reference);
  const Rules rules = host->info().rules;
  Judge judge(*host, *reference, nullptr);
  for (const Case& file : all_cases()) {
    const Trial trial = try_case(file, *host, rules, kExactRules, judge);
    EXPECT_FALSE(trial.failure) << trial.failure->message;
    EXPECT_EQ(trial.outcome.unexplained, 0u) << file.name;
  }
  for (const Testcase& testcase : all_generators()) {
    const Trial trial = try_generator(*testcase.generator, *host, rules, kExactRules, judge, {kCount, 1});
    EXPECT_FALSE(trial.failure) << trial.failure->message;
    EXPECT_EQ(trial.outcome.unexplained, 0u) << testcase.name();
  }
}

}  // namespace
}  // namespace edgecase::conformance
