// From findings to what a person is shown: reproductions, pictures, and lines of a report.
#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/casefile/casefile.h"
#include "conformance/compare/exhibit.h"
#include "conformance/report/report.h"
#include "conformance/runner/run.h"
#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// What the rules say of the scene's window triangles, one mask a triangle.
MaskBatch by_the_rules(const Scene& scene);

/// The scene and its snapped triangles, and nothing yet of what anybody says about them.
Exhibit exhibit_of(const Scene& scene);

/// One line of the report, without the pictures.
Result describe_result(const RunResult& run, const RunPlan& plan);

/// The finding as a case file of its own, with what the rules demand as `expect` where the target is small enough to
/// read.
Case reproduction(const Finding& finding, const RunResult& run, const RunPlan& plan);

/// Writes pictures and reproductions of all findings of `runs` into `folder`, and notes them in `results`, which run
/// parallel to `runs`.
tl::expected<void, Error> show_findings(const std::filesystem::path& folder, const std::vector<RunResult>& runs,
                                        const RunPlan& plan, std::vector<Result>& results);

}  // namespace edgecase::conformance
