#include "rasterizer/fast/tile_mask.h"

namespace edgecase::rasterizer {

void TileMask::add_to(StripMask& mask, std::size_t begin, std::size_t end) {
  const Strips from = strips(), to = mask.strips();
  const auto first_strip = static_cast<std::size_t>(tile_.left / kStripWidth);
  const auto rows = static_cast<std::size_t>(tile_.height);
  for (std::size_t strip = begin; strip < end; ++strip) {
    std::uint32_t* __restrict source = from.words + strip * from.stride;
    std::uint32_t* __restrict target =
        to.words + (first_strip + strip) * to.stride + static_cast<std::size_t>(tile_.top);
    for (std::size_t row = 0; row < rows; ++row) {
      target[row] |= source[row];
      source[row] = 0;
    }
  }
}

}  // namespace edgecase::rasterizer
