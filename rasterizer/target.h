// What is drawn into: the size of a target, and masks of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "rasterizer/int.h"

namespace edgecase::rasterizer {

/// Pixels along one side of a target, at most.
inline constexpr int kMaxExtent = 16384;

/// A pixel's column or row, or the end of a range of them: 0 to kMaxExtent.
using PixelIndex = Int<width_of(kMaxExtent)>;

/// The size of a target in pixels, known to be legal.
class Target {
 public:
  /// Nothing unless both are from 1 to kMaxExtent.
  static constexpr std::optional<Target> make(int width, int height) {
    if (width < 1 || width > kMaxExtent || height < 1 || height > kMaxExtent) return std::nullopt;
    return Target(*PixelIndex::checked(width), *PixelIndex::checked(height));
  }

  constexpr PixelIndex width() const { return width_; }
  constexpr PixelIndex height() const { return height_; }
  /// 64-bit words in a row of a mask with that many samples a pixel.
  constexpr std::size_t row_words(int samples = 1) const {
    return (static_cast<std::size_t>(width_.value()) * static_cast<std::size_t>(samples) + 63) / 64;
  }
  /// 64-bit words in a mask.
  constexpr std::size_t mask_words(int samples = 1) const {
    return row_words(samples) * static_cast<std::size_t>(height_.value());
  }
  friend constexpr bool operator==(const Target& a, const Target& b) {
    return a.width_ == b.width_ && a.height_ == b.height_;
  }

 private:
  constexpr Target(PixelIndex width, PixelIndex height) : width_(width), height_(height) {}
  PixelIndex width_;
  PixelIndex height_;
};

/// A coverage mask, owned by the caller: rows top to bottom, each padded to whole words; sample s of the pixel in
/// column x is bit b % 64, counted from the least significant, of word b / 64 of its row, b = x * samples + s.
class Mask {
 public:
  /// Nothing unless `words` has exactly target.mask_words(samples) words, and samples is positive.
  static constexpr std::optional<Mask> over(Target target, std::span<std::uint64_t> words, int samples = 1) {
    if (samples < 1 || words.size() != target.mask_words(samples)) return std::nullopt;
    return Mask(target, words, samples);
  }

  constexpr const Target& target() const { return target_; }
  constexpr int samples() const { return samples_; }

  /// Adds up to 64 samples of row y, beginning with bit 64 * word of the row.
  constexpr void add(int y, int word, std::uint64_t bits) const {
    words_[static_cast<std::size_t>(y) * row_words_ + static_cast<std::size_t>(word)] |= bits;
  }

 private:
  constexpr Mask(Target target, std::span<std::uint64_t> words, int samples)
      : target_(target), samples_(samples), row_words_(target.row_words(samples)), words_(words) {}
  Target target_;
  int samples_;
  std::size_t row_words_;
  std::span<std::uint64_t> words_;
};

}  // namespace edgecase::rasterizer
