// What the code of an instruction set looks like from outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rasterizer/fast/fast.h"
#include "rasterizer/fast/region.h"

namespace edgecase::rasterizer {

/// Room for `masks` masks of strips, `apart` words from one to the next, with a strip behind the last.
struct Scratch {
  Strips strips;
  std::size_t masks;
  std::size_t apart;
};

/// Where the numbers of first triangles go: the pixel in column x and row y of plane s has numbers[s * apart + y *
/// row_pixels + x], whole strips in a row.
struct FirstTriangles {
  std::uint32_t* numbers;
  std::size_t apart;
  std::size_t row_pixels;
  std::uint32_t first_number;  ///< of the first triangle in the list
};

/// Each comes twice: for one sample in the centre on the whole of a target, and for the planes of a region, but for
/// first_difference. `apart`: words from one sample's plane to the next.
struct FastRasterizer::Kernels {
  using Triangles = std::span<const FixedTriangle<Format16_8>>;

  bool (*snap_on_grid)(std::span<const Triangle>, FixedTriangle<Format16_8>* snapped);
  void (*cover_union)(Triangles, int width, const Strips&);
  /// `kept` has room for two strips of the region for each of its samples.
  void (*cover_union_in)(Triangles, const Region&, const Strips&, std::size_t apart, std::uint32_t* kept);
  void (*cover_each)(Triangles, int width, const Scratch&, std::uint64_t* masks);
  /// The scratch is the region's.
  void (*cover_each_in)(Triangles, const Region&, const Scratch&, std::size_t row_words, std::size_t mask_words,
                        std::uint64_t* masks);
  /// The scratch is clear.
  std::size_t (*first_difference)(Triangles, int width, const Scratch&, const std::uint64_t* masks);
  std::size_t (*first_short_difference)(Triangles, int width, const Scratch&, const std::uint32_t* rows);
  void (*count_each)(Triangles, int width, int height, std::uint64_t* counts);
  /// The region begins with its first pixel.
  void (*count_each_in)(Triangles, const Region&, std::uint64_t* counts);
  /// The scratch, strips like those of what is covered, is clear, and is left so.
  void (*cover_first)(Triangles, int width, const Strips& scratch, const Strips& covered, const FirstTriangles&);
  void (*cover_first_in)(Triangles, const Region&, const Strips& scratch, const Strips& covered, std::size_t apart,
                         const FirstTriangles&);
  void (*strips_to_rows)(const Strips&, std::uint64_t last_word, std::uint64_t* rows);
  void (*region_to_rows)(const Strips&, std::size_t apart, const Region&, std::size_t row_words, std::uint64_t* rows);
  /// The strips are a TileMask's.
  void (*cover_tile)(Triangles, const Tile&, const Strips&);
  void (*find_reach)(Triangles, const TileGrid&, std::uint64_t* words);
  /// Adds words to others.
  void (*add_words)(const std::uint32_t* from, std::uint32_t* to, std::size_t words);
};

}  // namespace edgecase::rasterizer
