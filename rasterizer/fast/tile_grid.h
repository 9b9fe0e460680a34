// TileGrid: a target cut into tiles, rectangles of which no two share a cache line of a StripMask.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rasterizer/fast/strip_mask.h"
#include "rasterizer/target.h"

namespace edgecase::rasterizer {

/// Pixels left <= x < left + width, top <= y < top + height of a target; left is a multiple of kStripWidth.
struct Tile {
  int left;
  int top;
  int width;
  int height;
};

/// Triangles of which a word says what they reach.
inline constexpr std::size_t kReachBlock = 64;

class TileGrid {
 public:
  static constexpr int kMostASide = 32;
  /// A cache line holds this many rows of a strip, and begins at a multiple of them.
  static constexpr int kRowUnit = kMaxLanes;

  /// `columns` by `rows` tiles of about the same size; fewer where the target has fewer strips or units of rows. Both
  /// at least 1 and at most kMostASide.
  constexpr TileGrid(const Target& target, int columns, int rows) {
    columns_ = cut(target.width().value(), kStripWidth, columns, columns_at_);
    rows_ = cut(target.height().value(), kRowUnit, rows, rows_at_);
  }

  constexpr int columns() const { return columns_; }
  constexpr int rows() const { return rows_; }
  constexpr int count() const { return columns_ * rows_; }

  /// Tile `index`, counted row by row.
  constexpr Tile tile(int index) const {
    const auto column = static_cast<std::size_t>(index % columns_), row = static_cast<std::size_t>(index / columns_);
    return {columns_at_[column], rows_at_[row], columns_at_[column + 1] - columns_at_[column],
            rows_at_[row + 1] - rows_at_[row]};
  }

  /// Where the columns and rows of tiles begin, and where the last one ends: the target's extent.
  constexpr std::span<const std::int32_t> columns_at() const {
    return std::span(columns_at_).first(static_cast<std::size_t>(columns_) + 1);
  }
  constexpr std::span<const std::int32_t> rows_at() const {
    return std::span(rows_at_).first(static_cast<std::size_t>(rows_) + 1);
  }

 private:
  using Bounds = std::array<std::int32_t, kMostASide + 1>;

  static constexpr int cut(int extent, int unit, int wanted, Bounds& at) {
    assert(wanted >= 1 && wanted <= kMostASide);
    const int units = (extent + unit - 1) / unit;
    const int count = wanted < units ? wanted : units;
    for (int i = 0; i < count; ++i) at[static_cast<std::size_t>(i)] = units * i / count * unit;
    at[static_cast<std::size_t>(count)] = extent;
    return count;
  }

  Bounds columns_at_{}, rows_at_{};
  int columns_ = 1, rows_ = 1;
};

}  // namespace edgecase::rasterizer
