// Fixed-point formats of window coordinates, and vertices in them.
#pragma once

#include <algorithm>
#include <array>

#include "rasterizer/int.h"

namespace edgecase::rasterizer {

/// A signed fixed-point format: IntegerBits, sign included, before the binary point and SubpixelBits after it. A
/// coordinate is an integer in units of 2^-SubpixelBits px, from -2^(IntegerBits-1) px to one unit below
/// +2^(IntegerBits-1) px.
template <int IntegerBits, int SubpixelBits>
struct Format {
  static_assert(IntegerBits >= 2 && IntegerBits <= 24);
  static_assert(SubpixelBits >= 0 && SubpixelBits <= 16);

  static constexpr int kSubpixelBits = SubpixelBits;
  static constexpr int kBits = IntegerBits + SubpixelBits;
  /// Sample locations lie on sixteenths of a pixel, the grid of the standard sample positions. A format coarser than
  /// that is brought to this finer grid before samples and vertices are subtracted.
  static constexpr int kSampleBits = std::max(SubpixelBits, 4);

  using Coordinate = Int<kBits>;
};

/// D3D11.3 functional specification 3.4.1: the format in which window coordinates are rasterized.
using Format16_8 = Format<16, 8>;

template <class F>
struct FixedVertex {
  typename F::Coordinate x;
  typename F::Coordinate y;
};

/// Vertices on the subpixel grid, in the order in which they are drawn; either winding is drawn.
template <class F>
using FixedTriangle = std::array<FixedVertex<F>, 3>;

}  // namespace edgecase::rasterizer
