// VisibilityBuffer: which triangle is the first to cover a sample.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rasterizer/fast/strip_mask.h"

namespace edgecase::rasterizer {

/// Owns a number for each sample of a target, and the mask of those that have one. Memory: 4 bytes a sample for the
/// numbers, and half as much for what FastRasterizer draws with.
class VisibilityBuffer {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// `samples`: of a pixel, 1 to kMaxSamples.
  explicit VisibilityBuffer(const Target& target, int samples = 1)
      : covered_(target, samples),
        row_pixels_(static_cast<std::size_t>(StripLayout(target).count) * kStripWidth),
        plane_pixels_(row_pixels_ * static_cast<std::size_t>(target.height().value())),
        numbers_(plane_pixels_ * static_cast<std::size_t>(samples), kNone),
        scratch_(StripLayout(target).allocated_words()) {}

  const Target& target() const { return covered_.target(); }
  int samples() const { return covered_.samples(); }

  /// No sample has a number any more.
  void clear() {
    covered_.clear();
    numbers_.assign(numbers_.size(), kNone);
  }

  /// The number of the first triangle that covered it, or kNone.
  std::uint32_t at(int x, int y, int sample = 0) const {
    assert(x >= 0 && x < target().width().value() && y >= 0 && y < target().height().value());
    return row(y, sample)[x];
  }
  /// The numbers of a row of pixels.
  const std::uint32_t* row(int y, int sample = 0) const {
    return numbers_.data() + static_cast<std::size_t>(sample) * plane_pixels_ +
           static_cast<std::size_t>(y) * row_pixels_;
  }
  /// The samples that have a number.
  const StripMask& covered() const { return covered_; }

 private:
  friend class FastRasterizer;
  StripMask covered_;
  std::size_t row_pixels_;
  std::size_t plane_pixels_;
  std::vector<std::uint32_t> numbers_;
  std::vector<std::uint32_t> scratch_;  ///< clear
};

}  // namespace edgecase::rasterizer
