// Masks as drivers write them, which may be half as long as those that all others speak of.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "conformance/scene/mask.h"

namespace edgecase::conformance {

/// Masks of equal layout, owned elsewhere: whole, or with short rows (MaskLayout::has_short_rows()).
class DrawnMasks {
 public:
  DrawnMasks() = default;
  /// Whole masks.
  DrawnMasks(const MaskBatchView& whole) : whole_(whole) {}
  /// `rows`: layout.driver_words() for each mask. The layout has short rows.
  DrawnMasks(const MaskLayout& layout, std::span<const std::uint32_t> rows) : layout_(layout), rows_(rows) {}

  bool have_short_rows() const { return layout_.has_value(); }
  /// The rows of masks `first` to `first + count - 1`, if they are short.
  std::span<const std::uint32_t> short_rows(std::size_t first, std::size_t count) const {
    return rows_.subspan(first * layout_->driver_words(), count * layout_->driver_words());
  }
  std::size_t size() const { return layout_ ? rows_.size() / layout_->driver_words() : whole_.size(); }

  /// Masks `first` to `first + count - 1`, whole: where they are, or in `scratch`.
  MaskBatchView whole(std::size_t first, std::size_t count, MaskBatch& scratch) const {
    if (!layout_) return whole_.part(first, count);
    scratch.reset(*layout_, count);
    std::ranges::copy(short_rows(first, count), scratch.data().begin());
    return scratch;
  }
  /// All of them.
  MaskBatchView whole(MaskBatch& scratch) const { return whole(0, size(), scratch); }

  /// Writes all of them, whole, from `words` on.
  void copy_to(std::uint64_t* words) const {
    if (layout_) {
      std::ranges::copy(rows_, words);
    } else {
      std::ranges::copy(whole_.data(), words);
    }
  }

 private:
  MaskBatchView whole_;
  std::optional<MaskLayout> layout_;  ///< of short rows
  std::span<const std::uint32_t> rows_;
};

}  // namespace edgecase::conformance
