// Coverage masks: one bit per sample.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "conformance/scene/setting.h"

namespace edgecase::conformance {

/// How a mask lies in memory: rows top to bottom, each padded with zero bits to whole 64-bit words; sample s of the
/// pixel in column x is bit x * samples + s of its row, counted from the least significant bit of the row's first word.
struct MaskLayout {
  Extent target;
  int samples = 1;

  explicit MaskLayout(const Setting& setting) : target(setting.target), samples(setting.samples()) {}

  std::size_t row_words() const {
    return (static_cast<std::size_t>(target.width) * static_cast<std::size_t>(samples) + 63) / 64;
  }
  std::size_t words() const { return row_words() * static_cast<std::size_t>(target.height); }
  /// Samples of one mask; the bits that are not padding.
  std::size_t sample_count() const {
    return static_cast<std::size_t>(target.width) * static_cast<std::size_t>(target.height) *
           static_cast<std::size_t>(samples);
  }
  std::size_t bit(int x, int y, int sample) const {
    return static_cast<std::size_t>(y) * row_words() * 64 +
           static_cast<std::size_t>(x) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(sample);
  }
  friend bool operator==(const MaskLayout&, const MaskLayout&) = default;

  /// Drivers write masks in 32-bit words, the less significant half of a word first, and where all samples of a row
  /// find room in one, nothing but that one: half of what would have to be cleared, moved and compared.
  bool has_short_rows() const { return target.width * samples <= 32; }
  /// 32-bit words of a row as a driver writes it, and of such a mask.
  std::size_t driver_row_words() const { return has_short_rows() ? 1 : 2 * row_words(); }
  std::size_t driver_words() const { return driver_row_words() * static_cast<std::size_t>(target.height); }
};

/// Words of one mask in some MaskLayout, owned elsewhere.
using MaskView = std::span<const std::uint64_t>;
using MutableMaskView = std::span<std::uint64_t>;

inline bool covered(MaskView mask, std::size_t bit) { return (mask[bit / 64] >> (bit % 64) & 1) != 0; }
inline void cover(MutableMaskView mask, std::size_t bit) { mask[bit / 64] |= std::uint64_t{1} << (bit % 64); }
/// Bits `begin` to `end - 1`.
inline void cover_span(MutableMaskView mask, std::size_t begin, std::size_t end) {
  if (begin >= end) return;
  const std::size_t last = (end - 1) / 64;
  std::uint64_t bits = ~std::uint64_t{0} << (begin % 64);
  for (std::size_t word = begin / 64; word < last; ++word) {
    mask[word] |= bits;
    bits = ~std::uint64_t{0};
  }
  mask[last] |= bits & ~std::uint64_t{0} >> (63 - (end - 1) % 64);
}

/// Masks of equal layout, one after the other, owned elsewhere: mask i is that of triangle i.
class MaskBatchView {
 public:
  MaskBatchView() = default;
  /// `data` holds whole masks of `words` words each.
  MaskBatchView(std::size_t words, std::span<const std::uint64_t> data) : words_(words), data_(data) {}
  std::size_t size() const { return words_ == 0 ? 0 : data_.size() / words_; }
  MaskView operator[](std::size_t i) const { return data_.subspan(i * words_, words_); }
  /// Masks `first` to `first + count - 1`.
  std::span<const std::uint64_t> data(std::size_t first, std::size_t count) const {
    return data_.subspan(first * words_, count * words_);
  }
  std::span<const std::uint64_t> data() const { return data_; }
  MaskBatchView part(std::size_t first, std::size_t count) const { return {words_, data(first, count)}; }

 private:
  std::size_t words_ = 0;
  std::span<const std::uint64_t> data_;
};

/// The same, owned.
class MaskBatch {
 public:
  /// Resizes to `count` masks. What they hold afterwards is unspecified: writers write every word.
  void reset(const MaskLayout& layout, std::size_t count) {
    words_ = layout.words();
    count_ = count;
    data_.resize(words_ * count);
  }
  std::size_t size() const { return count_; }
  MaskView operator[](std::size_t i) const { return {data_.data() + i * words_, words_}; }
  MutableMaskView operator[](std::size_t i) { return {data_.data() + i * words_, words_}; }
  std::span<std::uint64_t> data() { return data_; }
  std::span<const std::uint64_t> data() const { return data_; }
  operator MaskBatchView() const { return {words_, data_}; }

 private:
  std::size_t words_ = 0;
  std::size_t count_ = 0;
  std::vector<std::uint64_t> data_;
};

}  // namespace edgecase::conformance
