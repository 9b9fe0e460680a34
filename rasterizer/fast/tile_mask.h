// TileMask: what one thread draws of one tile, in memory of its own.
//
// A tile cannot be drawn in place: what the kernels write, though unchanged, beyond a triangle would meet another
// thread in the next tile. With margins round it, a small triangle that crosses the tile's border needs no clipping
// either.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rasterizer/fast/strip_mask.h"
#include "rasterizer/fast/tile_grid.h"

namespace edgecase::rasterizer {

/// What triangles of up to 32 rows and 64 columns, counted from a strip's left side, can reach beyond a tile that they
/// meet: above and below it as many rows, and one strip on either side. What is drawn there is of no use.
inline constexpr int kMarginRows = 32;
inline constexpr int kMarginStrips = 1;
static_assert(kMarginRows % TileGrid::kRowUnit == 0 && kMarginRows <= kRowsBelow);

class TileMask {
 public:
  /// From here on the mask is that of `tile`, all clear.
  void begin(const Tile& tile) {
    const int count = (tile.width + kStripWidth - 1) / kStripWidth;
    if (count == count_ && tile.height == tile_.height) {
      clear();
    } else {
      count_ = count;
      // The rows above a strip are those below the one before it.
      const auto rows = static_cast<std::size_t>(tile.height + kRowsBelow);
      stride_ = (rows + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
      const std::size_t words = first_word() + static_cast<std::size_t>(count_ + kMarginStrips) * stride_;
      blocks_.assign(words / kMaxLanes, Block{});
    }
    tile_ = tile;
    clear_ = false;
  }

  /// Clears its strips, unless they are. A tile as large as the last one will find nothing else to clear: what the
  /// margins hold is of no use.
  void clear() {
    if (clear_) return;
    std::fill_n(blocks_.begin() + static_cast<std::ptrdiff_t>(first_word() / kMaxLanes),
                static_cast<std::size_t>(count_) * stride_ / kMaxLanes, Block{});
    clear_ = true;
  }

  const Tile& tile() const { return tile_; }

  /// Strip 0 and row 0 are the tile's first.
  Strips strips() { return {blocks_.data()->words + first_word(), stride_, count_, tile_.height}; }

  const std::uint32_t* strip(std::size_t number) const {
    return blocks_.data()->words + first_word() + number * stride_;
  }

 private:
  std::size_t first_word() const { return kMarginRows + kMarginStrips * stride_; }

  struct alignas(64) Block {
    std::uint32_t words[kMaxLanes] = {};
  };
  Tile tile_{};
  int count_ = 0;
  bool clear_ = true;
  std::size_t stride_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace edgecase::rasterizer
