// What a subject is tested with: a case file's scene, a generator's stream of them, or a metamorphic check.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "conformance/casefile/casefile.h"
#include "conformance/generators/generator.h"
#include "conformance/metamorphic/metamorphosis.h"
#include "conformance/runner/categories.h"
#include "conformance/runner/judge.h"
#include "conformance/scene/rule_set.h"

namespace edgecase::conformance {

/// Exactly one of the three is there.
struct Testcase {
  const Case* file = nullptr;
  const Generator* generator = nullptr;
  const Metamorphosis* metamorphosis = nullptr;

  /// About how many triangles are judged where a generator makes `count`.
  std::uint64_t triangles(std::uint64_t count) const;
  std::string name() const;
  std::string category() const;
};

/// What a testcase came to for one subject: an outcome, or a reason why it was not drawn.
struct Trial {
  Outcome outcome;
  std::optional<std::string> skipped;
  /// Set if the subject was judged by its own way of snapping because the case's would have it cover other samples.
  std::optional<std::string> own_snap;
  std::optional<Error> failure;  ///< the subject crashed, or the suite contradicts itself
  double seconds = 0;
  double subject_seconds = 0;  ///< of these, inside the subject's own drawing
};

struct TrialOptions {
  std::uint64_t count = 0;  ///< at least so many triangles of a generator, whole scenes
  std::uint64_t seed = 1;
  /// Told how many triangles have been judged since it was last called.
  std::function<void(std::uint64_t)> on_progress = [](std::uint64_t) {};
};

/// Runs one testcase against one subject, judged by `rules` unless it follows each scene's own. A `rule_set` that is
/// not exact goes before that of the case.
Trial try_case(const Case& file, Subject& subject, const Rules& rules, const RuleSet& rule_set, Judge& judge);
Trial try_generator(const Generator& generator, Subject& subject, const Rules& rules, const RuleSet& rule_set,
                    Judge& judge, const TrialOptions& options);

/// The scene of `file` under the rules that a subject is judged by: the case's own if it follows each scene's, else
/// `rules`, if the grid is the same or every vertex lies on both; otherwise why the case says nothing about it. Under a
/// set that leaves the snap open, what is left of the rules is a grid that the set allows.
tl::expected<Scene, std::string> scene_for(const Case& file, const SubjectInfo& subject, const Rules& rules,
                                           const RuleSet& rule_set = kExactRules);

}  // namespace edgecase::conformance
