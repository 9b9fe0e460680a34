// The fast rasterizer: the coverage of scalar.h, bit for bit, in vectors.
//
// One source is compiled for every instruction set; the best that the machine has is chosen at run time. Vertices are
// snapped already, see snap(), and lie anywhere in the 16.8 format; a list of them is read as it is. Nothing allocates
// for a triangle, and nothing can fail.
//
//   const FastRasterizer fast;
//   StripMask mask(target);
//   fast.cover_union(triangles, mask);  // one sample in the centre, the whole target
//   StripMask four(target, 4);
//   fast.cover_union(triangles, View<SamplePattern, Scissor>{target, *samples, {0, 0, 640, 480}}, four);
//
// What a scene asks for is chosen by type: a target or a View, as for cover() in rasterizer.h, and one of the functions
// below. The code for one sample in the centre of the whole target knows of nothing else.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include "rasterizer/fast/strip_mask.h"
#include "rasterizer/fast/tile_grid.h"
#include "rasterizer/fast/tile_mask.h"
#include "rasterizer/fast/visibility_buffer.h"
#include "rasterizer/format.h"
#include "rasterizer/input_error.h"
#include "rasterizer/sample_pattern.h"

namespace edgecase::rasterizer {

/// Instruction sets, from the least to the best: scalar code for any processor, SSE4.2, AVX2 with FMA and BMI2, and
/// AVX-512 (F, BW, DQ, VL, CD).
enum class Isa { portable, sse4, avx2, avx3 };
inline constexpr std::array kAllIsas{Isa::portable, Isa::sse4, Isa::avx2, Isa::avx3};

std::string_view name_of(Isa isa);

/// The instruction sets that this program was built for and this machine has, ascending; `portable` is always there.
std::span<const Isa> available_isas();

struct Region;

class FastRasterizer {
 public:
  using Triangles = std::span<const FixedTriangle<Format16_8>>;

  /// For the best of available_isas().
  FastRasterizer();
  /// Nothing if `isa` is not available.
  static std::optional<FastRasterizer> make(Isa isa);

  Isa isa() const { return isa_; }

  /// Snaps triangles of which every vertex lies on the grid of 16.8 within kGridReach, as most do that were made for a
  /// test or snapped before: every way of rounding leaves it where it is. False if one does not, and then `snapped`,
  /// which is as long, is unspecified; snap_list() takes them all.
  bool snap_on_grid(std::span<const Triangle> triangles, std::span<FixedTriangle<Format16_8>> snapped) const;
  static constexpr float kGridReach = 1 << 14;

  /// Adds the coverage of every triangle to `mask`: their union. The mask has the view's target and number of samples.
  void cover_union(Triangles triangles, StripMask& mask) const;
  template <class Samples, class Clip>
  void cover_union(Triangles triangles, const View<Samples, Clip>& view, StripMask& mask) const;

  /// Writes the mask of every triangle on its own, triangle i's to the words from i * n on, n =
  /// target.mask_words(samples), laid out as a Mask is. `masks` has that many words for each triangle.
  void cover_each(Triangles triangles, const Target& target, std::span<std::uint64_t> masks) const;
  template <class Samples, class Clip>
  void cover_each(Triangles triangles, const View<Samples, Clip>& view, std::span<std::uint64_t> masks) const;

  /// The index of the first triangle of which `masks` does not hold what cover_each() would write, or
  /// triangles.size(). No mask is written for it: what is drawn is compared where it is drawn.
  std::size_t first_difference(Triangles triangles, const Target& target, std::span<const std::uint64_t> masks) const;
  /// The same of masks whose rows are 32 bits, for targets of at most 32 columns: a word for each row.
  std::size_t first_difference(Triangles triangles, const Target& target, std::span<const std::uint32_t> rows) const;

  /// Writes how many samples every triangle covers: as many numbers as there are triangles. No mask is drawn for it.
  void count_each(Triangles triangles, const Target& target, std::span<std::uint64_t> counts) const;
  template <class Samples, class Clip>
  void count_each(Triangles triangles, const View<Samples, Clip>& view, std::span<std::uint64_t> counts) const;

  /// Gives a number to every sample that has none and that a triangle covers: that of the first triangle to do so,
  /// triangle i having the number first_number + i. The buffer has the view's target and number of samples. A list may
  /// be given in parts.
  void cover_first(Triangles triangles, VisibilityBuffer& buffer, std::uint32_t first_number = 0) const;
  template <class Samples, class Clip>
  void cover_first(Triangles triangles, const View<Samples, Clip>& view, VisibilityBuffer& buffer,
                   std::uint32_t first_number = 0) const;

  /// Adds the coverage of every triangle, as far as it lies in mask.tile(), to `mask`.
  void cover_tile(Triangles triangles, TileMask& mask) const;

  /// Adds strips `begin` to before `end` of the tile that `from` is of to the target's mask.
  void add_strips(const TileMask& from, StripMask& to, std::size_t begin, std::size_t end) const;

  /// Which columns and rows of tiles the bounding boxes of triangles reach with a sample: for every kReachBlock
  /// triangles grid.columns() + grid.rows() words, the columns' first, in which bit i is set if triangle i reaches that
  /// column or row. A triangle reaches a tile if both bits are set. Writes all these words, which `words` has room for.
  void find_reach(Triangles triangles, const TileGrid& grid, std::span<std::uint64_t> words) const;

  /// What a target's kernels look like from outside.
  struct Kernels;

 private:
  template <class Samples, class Clip>
  static constexpr bool kIsPlain = std::is_same_v<Samples, CentreSample>&& std::is_same_v<Clip, WholeTarget>;

  void cover_union_in(Triangles triangles, const Region& region, StripMask& mask) const;
  void cover_each_in(Triangles triangles, const Region& region, const Target& target,
                     std::span<std::uint64_t> masks) const;
  void count_each_in(Triangles triangles, const Region& region, std::span<std::uint64_t> counts) const;
  void cover_first_in(Triangles triangles, const Region& region, VisibilityBuffer& buffer,
                      std::uint32_t first_number) const;

  FastRasterizer(Isa isa, const Kernels* kernels) : isa_(isa), kernels_(kernels) {}
  Isa isa_;
  const Kernels* kernels_;
};

}  // namespace edgecase::rasterizer

#include "rasterizer/fast/fast_views.h"
