// What a specification demands, where it leaves a choice: the exact answer for every choice at once, by the two
// methods.
//
// A triangle's vertices may be snapped in up to 2^6 ways: each coordinate between two grid points to one or either of
// them, equal positions alike. A sample must be covered if it is for every choice, and must not be if it is for none;
// the rest may be. Where a set leaves samples on edges open, a choice covers for certain what lies strictly inside, and
// possibly what lies on an edge, for which a triangle without area is all edge.
//
// Where a set does not say that the snapped vertices decide the facing, a triangle that does not face the same way for
// every choice may cover what any choice covers, or nothing, if the setting culls at all. The area is linear in each
// coordinate, so that of the vertices before the snap lies between those of the choices: if they agree, it agrees too.
#pragma once

#include <vector>

#include "conformance/scene/explanation.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/rule_set.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance::oracle {

/// Of the samples in `asked`, those that have to be covered go to `must`, and those that are open to `may`; writes
/// every word of both. `rules` give the grid, and the rounding if the set leaves none open; `rule_set` is one of
/// kRuleSets. Coordinates as in oracle.h.
void allow_by_definition(const Setting& setting, const Rules& rules, const RuleSet& rule_set, const Triangle& triangle,
                         MaskView asked, MutableMaskView must, MutableMaskView may);

/// The same by the method of cover_by_shift, with the edges as lines in exact integers.
void allow_by_shift(const Setting& setting, const Rules& rules, const RuleSet& rule_set, const Triangle& triangle,
                    MaskView asked, MutableMaskView must, MutableMaskView may);

/// The grid points that `position` may be snapped to: one, two or four.
std::vector<GridPoint> snap_choices(const Rules& rules, const RuleSet& rule_set, const Position& position);

}  // namespace edgecase::conformance::oracle
