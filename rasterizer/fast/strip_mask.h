// StripMask: a coverage mask in the layout that suits vectors.
//
// The target is cut into columns of 32 pixels, the strips. A strip is a run of 32-bit words, one for each row from top
// to bottom, bit i of a word being the strip's column i: any N consecutive words are the same 32 columns of N rows,
// which one vector of N lanes takes, aligned or not.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rasterizer/sample_pattern.h"
#include "rasterizer/target.h"

namespace edgecase::rasterizer {

inline constexpr int kStripWidth = 32;

/// Lanes of the widest vector.
inline constexpr int kMaxLanes = 16;

/// Words are read and written, though not changed, up to this many rows below a strip's last, and in one strip more
/// than the target has: so that what a triangle covers need not be asked before it is drawn.
inline constexpr int kRowsBelow = 32;

/// Where strips lie: row y of strip s is words[s * stride + y].
struct Strips {
  std::uint32_t* words;
  std::size_t stride;
  int count;
  int height;
};

/// The extent of a target in strips.
struct StripLayout {
  int count;
  std::size_t stride;

  explicit constexpr StripLayout(const Target& target) {
    count = (target.width().value() + kStripWidth - 1) / kStripWidth;
    const std::size_t rows = static_cast<std::size_t>(target.height().value()) + kRowsBelow;
    stride = (rows + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
    // The same row of neighbouring strips would otherwise fall into the same cache set.
    constexpr std::size_t kPage = 4096 / sizeof(std::uint32_t);
    if (stride % kPage == 0) stride += kMaxLanes;
  }
  /// Words of the strips, and with the one that follows them.
  constexpr std::size_t words() const { return static_cast<std::size_t>(count) * stride; }
  constexpr std::size_t allocated_words() const { return words() + stride; }
};

/// Owns a mask, all clear at first: a plane of strips for each sample of a pixel. Bits right of the target in its last
/// strip are no pixels: what they hold is unspecified.
class StripMask {
 public:
  /// `samples`: of a pixel, 1 to kMaxSamples.
  explicit StripMask(const Target& target, int samples = 1)
      : target_(target),
        samples_(samples),
        layout_(target),
        blocks_(((static_cast<std::size_t>(samples) - 1) * layout_.words() + layout_.allocated_words()) / kMaxLanes) {
    assert(samples >= 1 && samples <= kMaxSamples);
  }

  const Target& target() const { return target_; }
  int samples() const { return samples_; }
  /// Words from strips().words on that belong to the mask: pixels and what lies between them.
  std::size_t allocated_words() const { return blocks_.size() * kMaxLanes; }

  void clear() { blocks_.assign(blocks_.size(), Block{}); }

  Strips strips(int sample = 0) {
    return {blocks_.data()->words + static_cast<std::size_t>(sample) * plane_words(), layout_.stride, layout_.count,
            static_cast<int>(target_.height().value())};
  }
  /// From one sample's strips to those of the next.
  std::size_t plane_words() const { return layout_.words(); }

  /// Writes the mask as a Mask lays it out, rows top to bottom in words of 64 samples, bits right of the target zero,
  /// to `rows`, which must have target().mask_words(samples()) words.
  void to_rows(std::span<std::uint64_t> rows) const;

 private:
  struct alignas(64) Block {
    std::uint32_t words[kMaxLanes] = {};
  };
  Target target_;
  int samples_;
  StripLayout layout_;
  std::vector<Block> blocks_;
};

}  // namespace edgecase::rasterizer
