#include "rasterizer/fast/strip_mask.h"

#include <cassert>

namespace edgecase::rasterizer {

void StripMask::to_rows(std::span<std::uint64_t> rows) const {
  assert(rows.size() == target_.mask_words());
  const std::uint32_t* words = blocks_.data()->words;
  const std::size_t row_words = target_.row_words();
  const auto height = static_cast<std::size_t>(target_.height().value());
  const int last_bit = (target_.width().value() - 1) % 64;
  for (std::size_t word = 0; word < row_words; ++word) {
    const std::uint32_t* left = words + 2 * word * layout_.stride;
    const bool has_right = 2 * word + 1 < static_cast<std::size_t>(layout_.count);
    const std::uint64_t pixels = word + 1 == row_words ? ~std::uint64_t{0} >> (63 - last_bit) : ~std::uint64_t{0};
    for (std::size_t y = 0; y < height; ++y) {
      const std::uint64_t right = has_right ? left[layout_.stride + y] : 0;
      rows[y * row_words + word] = (left[y] | right << 32) & pixels;
    }
  }
}

}  // namespace edgecase::rasterizer
