// What the code of an instruction set looks like from outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rasterizer/fast/fast.h"

namespace edgecase::rasterizer {

struct FastRasterizer::Kernels {
  void (*cover_union)(std::span<const FixedTriangle<Format16_8>> triangles, int width, const Strips& strips);
  /// `scratch` has room for `at_once` masks, `apart` words from one to the next, and a strip behind the last.
  void (*cover_each)(std::span<const FixedTriangle<Format16_8>> triangles, int width, std::size_t at_once,
                     std::size_t apart, const Strips& scratch, std::uint64_t* masks);
  /// `strips` are a TileMask's.
  void (*cover_tile)(std::span<const FixedTriangle<Format16_8>> triangles, const Tile& tile, const Strips& strips);
  void (*find_reach)(std::span<const FixedTriangle<Format16_8>> triangles, const TileGrid& grid, std::uint64_t* words);
};

}  // namespace edgecase::rasterizer
