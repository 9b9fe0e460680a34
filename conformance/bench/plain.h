// The plain loop: the baseline that every speed is a multiple of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "rasterizer/format.h"
#include "rasterizer/target.h"

namespace edgecase::conformance {

/// Sets the bytes of the pixels that `triangle` covers to 1: three edge functions stepped from pixel to pixel over the
/// bounding box, three adds and an or per pixel, no hierarchy, no hand-written vectors. `pixels` are the target's, row
/// by row without padding.
///
/// So that it is no straw man, it is compiled for several instruction sets and runs the widest that the machine has,
/// has no branch in its inner loop, so that the compiler can vectorize it, and steps in 32 bits where these suffice.
///
/// For the formats 16.0, 16.2, 16.4, 16.6, 16.8, 16.10, 16.12 and 16.16; the fewer bits, the more triangles need no
/// more than 32.
template <int Bits>
void cover_plain(const rasterizer::FixedTriangle<rasterizer::Format<16, Bits>>& triangle,
                 const rasterizer::Target& target, std::uint8_t* pixels);

/// The instruction set that cover_plain runs with on this machine.
std::string plain_isa();

}  // namespace edgecase::conformance
