// The exact answer, twice, by two methods that share no code: neither with each other nor with the rasterizer they
// judge.
//
// Both first snap each vertex to the subpixel grid as the rules say and then decide every sample exactly. A triangle
// covers nothing if the setting culls the way its snapped vertices face, or if they enclose no area (D3D11.3
// functional specification, 15.11.1). Precondition of everything here: coordinates are finite and at most 2^24 px from
// the origin; subpixel_bits is 0 to 16.
#pragma once

#include "conformance/scene/explanation.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance::oracle {

/// By definition (D3D11.3 functional specification, 3.4.2.1), in 128-bit integers: a sample is covered if all three
/// edge functions are positive there, or zero on an edge that is a top or a left edge. Writes every word of `mask`.
void cover_by_definition(const Setting& setting, const Rules& rules, const Triangle& triangle, MutableMaskView mask);

/// By infinitesimal shift, in checked integers: the sample moved by (e, e^2), e -> 0, lies on no edge; it is covered if
/// it lies inside. Solved row by row for the half-open interval between the two edges that the moved row crosses.
/// Writes every word of `mask`.
void cover_by_shift(const Setting& setting, const Rules& rules, const Triangle& triangle, MutableMaskView mask);

/// Where the rules snap a position to.
GridPoint snap(const Rules& rules, const Position& position);

/// The numbers behind cover_by_definition's answer for one sample of the pixel in column x, row y.
Explanation explain(const Setting& setting, const Rules& rules, const Triangle& triangle, int x, int y, int sample);

}  // namespace edgecase::conformance::oracle
