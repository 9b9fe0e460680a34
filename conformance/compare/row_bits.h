// Which bits of a mask row are samples.
#pragma once

#include <cstddef>
#include <cstdint>

#include "conformance/scene/mask.h"

namespace edgecase::conformance {

/// The bits of word `word` of a row that are samples; the others are padding.
inline std::uint64_t sample_bits(const MaskLayout& layout, std::size_t word) {
  const std::size_t used =
      static_cast<std::size_t>(layout.target.width) * static_cast<std::size_t>(layout.samples) - word * 64;
  return used >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << used) - 1;
}

/// Where in the target one bit of a mask lies: the inverse of MaskLayout::bit.
struct SampleIndex {
  int x = 0;
  int y = 0;
  int sample = 0;
};

inline SampleIndex sample_index(const MaskLayout& layout, std::size_t bit) {
  const std::size_t row_bits = layout.row_words() * 64;
  const auto samples = static_cast<std::size_t>(layout.samples);
  const std::size_t column = bit % row_bits;
  return {static_cast<int>(column / samples), static_cast<int>(bit / row_bits), static_cast<int>(column % samples)};
}

}  // namespace edgecase::conformance
