// Exhaustion: every triangle that a lattice over a small target has, against the oracle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "conformance/runner/known_deviations.h"
#include "conformance/scene/error.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// Lattice points are numbered row by row, triangles by the lexicographic order of their ascending triples of points:
/// every set of three points comes once, in whichever winding that order gives it.
struct ExhaustPlan {
  int lattice_bits = 0;  ///< 2^lattice_bits steps a pixel
  Extent target;
  std::string subject;
  const KnownDeviation* deviation = nullptr;  ///< or null
  int jobs = 1;
};

/// What has been found so far, of the triangles from the first on without a gap.
struct Exhaustion {
  struct Wrong {
    std::uint64_t triangle = 0;
    int x = 0;
    int y = 0;
    bool missing = false;  ///< else unexpected
    friend bool operator==(const Wrong&, const Wrong&) = default;
  };
  std::uint64_t triangles = 0;
  std::uint64_t samples_compared = 0;
  std::uint64_t wrong = 0;        ///< samples
  std::uint64_t missing = 0;      ///< of these; the others are unexpected
  std::uint64_t unexplained = 0;  ///< triangles wrong, or with a known deviation: not as it predicts
  std::optional<Wrong> first;     ///< the first wrong sample
  double seconds = 0;             ///< wall-clock time, that of earlier runs included

  void add(const Exhaustion& later);
};

/// One in this many triangles is given to the two oracles, which judge the factored one.
inline constexpr std::uint64_t kExhaustOracleShare = 4096;

/// Triangles of the plan: points choose 3.
std::uint64_t exhaust_triangles(const ExhaustPlan& plan);

/// The vertices of triangle `index` of the plan.
Triangle exhaust_triangle(const ExhaustPlan& plan, std::uint64_t index);

/// Why the plan cannot be carried out with `subject`: one line naming option and value.
std::optional<Error> check_exhaust(const ExhaustPlan& plan, const Subject& subject);

/// Draws all triangles from `done.triangles` on and returns `done` and what came of them. `on_progress` is told how far
/// that has come, from several threads, one at a time. The plan has passed check_exhaust(); `subject` is what it names.
/// An error means that the subject failed, or that the oracles differ.
tl::expected<Exhaustion, Error> exhaust(const ExhaustPlan& plan, std::unique_ptr<Subject> subject, Exhaustion done,
                                        const std::function<void(const Exhaustion&)>& on_progress);

}  // namespace edgecase::conformance
