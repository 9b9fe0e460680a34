// Where llvmpipe loses samples of large triangles, predicted bit for bit.
//
// llvmpipe bins a triangle that touches one tile of 64x64 pixels only without asking how far it reaches beyond the
// target. That is the first tile, and the triangle lies to its left and above. Within a tile its edge values, which
// have the 8 subpixel bits of both factors, are shifted right by 8 and cut to 32 bits, enough for an edge that passes
// the tile. An edge that does not can be further away than that: from 2^39 square subpixels on, 2^23 square pixels, its
// value's sign is a bit like any other, and blocks and samples deep inside of it count as outside. Taken from the order
// of operations in Mesa's lp_setup_tri.c and lp_rast_tri_tmp.h, and measured with Mesa 22.3.6 and 25.0.7:
//
//   1. A triangle of at most 128 px goes another way, in 32 bits that suffice; with one exception, below.
//   2. c is the edge function at the tile's first centre, or corner if it is multisampled, plus 1 for a top or a left
//      edge: inside is c > 0.
//   3. Of the tile's 16 blocks of 16x16 pixels, those are out where some edge's (c >> 8) at the corner furthest inside
//      is negative, in 32 bits, and those are in where all edges' ((c - 1) >> 8) at the opposite corner are not. If all
//      16 are out, nothing is drawn; else those in are filled, even if they are out as well, and what is neither is cut
//      in 16 again, down to 4x4 pixels, of which samples are asked one by one for the sign of ((c - 1) >> 8) in 32
//      bits.
//   4. The sides of the scissor that the triangle crosses are edges, too.
//
// So samples deep inside are lost, most often all that there are, and blocks far outside may be filled. A block of 4x4
// pixels that is filled across the target's border is shaded there, too: shaders must not count those fragments.
//
// The exception: a triangle of at most 128 px that ends within the target's first 16x16 pixels and crosses one side of
// the scissor, or of a smaller target, is asked for the sign of 4 * (c - 1) at each sample, because the steps at hand
// are those of 4 pixels (TRI_16 for four edges). From c - 1 = 2^29 on, 8,192 square pixels, a sample is lost. It takes
// some 90 px to the left and above. Multisampled triangles do not go this way.
#pragma once

#include <span>

#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Whether an edge's value may be too large for llvmpipe, by the triangle's extent alone; if not, it covers what the
/// rules say.
bool llvmpipe_may_wrap(const Triangle& triangle);

/// The same for a whole list: says no only if it does so for each of them.
bool llvmpipe_any_may_wrap(std::span<const Triangle> triangles);

/// Writes every word of `mask`, which has MaskLayout(setting), if some value of an edge is too large for llvmpipe; if
/// not, returns false and leaves it as it is. Positions pass through the viewport transform unchanged
/// (enclosing_viewport.h).
bool predict_llvmpipe_wrap(const Setting& setting, const Triangle& triangle, MutableMaskView mask);

}  // namespace edgecase::conformance
