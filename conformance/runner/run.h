// Every subject against every testcase, on several threads.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/runner/known_deviations.h"
#include "conformance/runner/subject_model.h"
#include "conformance/runner/testcase.h"
#include "conformance/scene/error.h"
#include "conformance/scene/rule_set.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

struct RunPlan {
  std::vector<std::string> subjects;
  std::vector<Testcase> testcases;
  std::vector<KnownDeviation> known_deviations;
  /// What is asked of the subjects. Unless it is exact, a case's own set is not, and no known deviation excuses
  /// anything.
  const RuleSet* rule_set = &kExactRules;
  std::uint64_t count = 0;  ///< triangles of each generator, at least
  std::uint64_t seed = 1;
  int jobs = 1;
};

/// One line of the result: subject and testcase are those of the plan.
struct RunResult {
  std::string subject;
  std::string device;
  std::string snap;  ///< how the subject transforms and snaps vertices, as found out by drawing
  Testcase testcase;
  Trial trial;
};

/// What explains the subject's deviations in a run of `plan`; null if nothing does.
const KnownDeviation* excuse(const RunPlan& plan, const std::string& subject, const std::string& device);

/// What a run compares if nothing is named.
const std::vector<std::string>& default_subjects();

/// What a subject is held against: the oracle, if it is ours; our own, judged by the oracles, if not. Clip space can be
/// judged only with a model of the subject.
tl::expected<Reference, Error> reference_for(const std::string& subject, const SubjectModel* model = nullptr);

/// Runs the plan. The results come subject by subject, testcase by testcase, whatever the number of jobs; on_progress
/// is called from several threads, one at a time. An error is a subject that cannot be had, before anything is drawn.
tl::expected<std::vector<RunResult>, Error> run(const RunPlan& plan,
                                                const std::function<void(std::uint64_t triangles)>& on_progress);

/// Triangles that `plan` will judge, about: what on_progress adds up to.
std::uint64_t planned_triangles(const RunPlan& plan);

}  // namespace edgecase::conformance
