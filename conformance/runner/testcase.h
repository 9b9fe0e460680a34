// What a subject is tested with: a case file's scene, or a generator's stream of them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "conformance/casefile/casefile.h"
#include "conformance/generators/generator.h"
#include "conformance/runner/judge.h"

namespace edgecase::conformance {

/// Exactly one of the two is there.
struct Testcase {
  const Case* file = nullptr;
  const Generator* generator = nullptr;

  std::uint64_t triangles(std::uint64_t count) const { return file != nullptr ? file->scene.triangles.size() : count; }
  std::string name() const { return file != nullptr ? file->name : std::string(generator->name); }
  std::string category() const { return file != nullptr ? file->category : std::string(generator->category); }
};

/// What a testcase came to for one subject: an outcome, or a reason why it was not drawn.
struct Trial {
  Outcome outcome;
  std::optional<std::string> skipped;
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

/// Runs one testcase against one subject.
Trial try_case(const Case& file, Subject& subject, Judge& judge);
Trial try_generator(const Generator& generator, Subject& subject, Judge& judge, const TrialOptions& options);

/// The scene of `file` under the rules of `subject`: the case's own for a subject that follows a scene's rules or if
/// every vertex lies on both grids; otherwise why the case says nothing about this subject.
tl::expected<Scene, std::string> scene_for(const Case& file, const SubjectInfo& subject);

}  // namespace edgecase::conformance
