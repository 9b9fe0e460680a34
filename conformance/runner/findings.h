// From findings to what a person is shown: reproductions, pictures, and lines of a report.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/casefile/casefile.h"
#include "conformance/compare/exhibit.h"
#include "conformance/report/report.h"
#include "conformance/runner/run.h"
#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// Makes the folder of a report if it is not there; why nothing can be written into it. For none, "", there is no why.
/// Asked before an hour of comparing, not after.
std::optional<Error> unwritable(const std::string& folder);

/// The scene and its snapped triangles, and nothing yet of what anybody says about them.
Exhibit exhibit_of(const Scene& scene, const RuleSet& rule_set = kExactRules);

/// One line of the report, without the pictures.
Result describe_result(const RunResult& run, const RunPlan& plan);

/// Where a finding comes from.
struct Origin {
  std::string subject;
  std::string device;
  std::string where;  ///< "case fan/closed_4"
};

/// `scene` as a case file, with what the rules demand as `expect` where the target is small enough to read. It is the
/// finding's own scene, or one around it.
Case reproduction(const Finding& finding, const Origin& origin, const Scene& scene);

/// Writes picture and reproduction of one finding into `folder`, as files that are called `stem`.
tl::expected<Shown, Error> show_finding(const std::filesystem::path& folder, const std::string& stem,
                                        const Finding& finding, const Origin& origin, const Scene& scene);

/// What is said first of a finding.
FirstWrong first_wrong(const Finding& finding, const Origin& origin);

/// Writes pictures and reproductions of all findings of `runs` into `folder`, and notes them in `results`, which run
/// parallel to `runs`.
tl::expected<void, Error> show_findings(const std::filesystem::path& folder, const std::vector<RunResult>& runs,
                                        const RunPlan& plan, std::vector<Result>& results);

}  // namespace edgecase::conformance
