// The fast rasterizer: the coverage of scalar.h, bit for bit, in vectors, for one sample in the pixel's centre.
//
// One source is compiled for every instruction set; the best that the machine has is chosen at run time. Vertices are
// snapped already, see snap(), and lie anywhere in the 16.8 format; a list of them is read as it is. Nothing allocates
// for a triangle, and nothing can fail.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "rasterizer/fast/strip_mask.h"
#include "rasterizer/fast/tile_grid.h"
#include "rasterizer/fast/tile_mask.h"
#include "rasterizer/format.h"

namespace edgecase::rasterizer {

/// Instruction sets, from the least to the best: scalar code for any processor, SSE4.2, AVX2 with FMA and BMI2, and
/// AVX-512 (F, BW, DQ, VL, CD).
enum class Isa { portable, sse4, avx2, avx3 };

std::string_view name_of(Isa isa);

/// The instruction sets that this program was built for and this machine has, ascending; `portable` is always there.
std::span<const Isa> available_isas();

class FastRasterizer {
 public:
  /// For the best of available_isas().
  FastRasterizer();
  /// Nothing if `isa` is not available.
  static std::optional<FastRasterizer> make(Isa isa);

  Isa isa() const { return isa_; }

  /// Adds the coverage of every triangle to `mask`: their union.
  void cover_union(std::span<const FixedTriangle<Format16_8>> triangles, StripMask& mask) const;

  /// Writes the mask of every triangle on its own, triangle i's to the target.mask_words() words from i *
  /// target.mask_words() on, laid out as a Mask is. `masks` has that many words for each triangle.
  void cover_each(std::span<const FixedTriangle<Format16_8>> triangles, const Target& target,
                  std::span<std::uint64_t> masks) const;

  /// Adds the coverage of every triangle, as far as it lies in mask.tile(), to `mask`.
  void cover_tile(std::span<const FixedTriangle<Format16_8>> triangles, TileMask& mask) const;

  /// Which columns and rows of tiles the bounding boxes of triangles reach with a sample: for every kReachBlock
  /// triangles grid.columns() + grid.rows() words, the columns' first, in which bit i is set if triangle i reaches that
  /// column or row. A triangle reaches a tile if both bits are set. Writes all these words, which `words` has room for.
  void find_reach(std::span<const FixedTriangle<Format16_8>> triangles, const TileGrid& grid,
                  std::span<std::uint64_t> words) const;

  /// What a target's kernels look like from outside.
  struct Kernels;

 private:
  FastRasterizer(Isa isa, const Kernels* kernels) : isa_(isa), kernels_(kernels) {}
  Isa isa_;
  const Kernels* kernels_;
};

}  // namespace edgecase::rasterizer
