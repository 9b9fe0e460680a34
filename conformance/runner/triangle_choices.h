// What a set of rules allows of a triangle besides what the exact rules cover.
#pragma once

#include <cstdint>
#include <tl/expected.hpp>

#include "conformance/runner/reference.h"
#include "conformance/scene/error.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/rule_set.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Turns `expected`, what `reference` last said of `scene`, into what `rule_set` demands, and takes over from
/// `observed` what it leaves open. Gives the number of open samples that are covered otherwise than by the exact rules.
/// An error is a fault of ours: the oracles differ. `first_index` as in Reference::expect.
tl::expected<std::uint64_t, Error> grant_choices(const Scene& scene, const RuleSet& rule_set, std::uint64_t first_index,
                                                 const MaskBatchView& observed, Reference& reference,
                                                 MaskBatch& expected);

}  // namespace edgecase::conformance
