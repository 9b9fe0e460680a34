// The plain loop: the baseline that every speed is a multiple of, and the same for a compiler that vectorizes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "rasterizer/format.h"
#include "rasterizer/target.h"

namespace edgecase::conformance {

enum class PlainLoop {
  /// As the articles write it, a pixel after the other; the compiler is kept from making vectors of it. On small
  /// triangles it is the faster of the two, on large ones several times slower: a multiple of it says little there.
  scalar,
  /// The same source, which the compiler makes vectors of, for several instruction sets: the widest that the machine
  /// has
  /// runs. What a compiler gives for nothing; no straw man.
  vectorized,
};

/// Sets the bytes of the pixels that `triangle` covers to 1: three edge functions stepped from pixel to pixel over the
/// bounding box, three adds and an or per pixel, no branch, no hierarchy. It steps in 32 bits where these suffice.
/// `pixels` are the target's, row by row without padding.
///
/// For the formats 16.0, 16.2, 16.4, 16.6, 16.8, 16.10, 16.12 and 16.16; the fewer bits, the more triangles need no
/// more than 32.
template <int Bits>
void cover_plain(PlainLoop loop, const rasterizer::FixedTriangle<rasterizer::Format<16, Bits>>& triangle,
                 const rasterizer::Target& target, std::uint8_t* pixels);

/// The instruction set that it runs with on this machine.
std::string plain_isa(PlainLoop loop);

}  // namespace edgecase::conformance
