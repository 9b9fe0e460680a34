// Metamorphic checks as testcases.
#pragma once

#include "conformance/metamorphic/metamorphosis.h"
#include "conformance/runner/known_deviations.h"
#include "conformance/runner/testcase.h"

namespace edgecase::conformance {

/// Triangles to try a metamorphosis on where a generator makes `count`: each is drawn two to five times.
std::uint64_t metamorphic_count(std::uint64_t count);

/// Draws metamorphic_count(options.count) triangles, at least, on the grid of `rules`, as they are and as the
/// metamorphosis has them. In the outcome a sample counts as missing if it is covered before and not after, as
/// unexpected if after and not before, as doubled if by two pieces. What fails is known only if `deviation`, which may
/// be null, predicts every mask involved.
Trial try_metamorphosis(const Metamorphosis& metamorphosis, Subject& subject, const Rules& rules,
                        const KnownDeviation* deviation, const TrialOptions& options);

}  // namespace edgecase::conformance
