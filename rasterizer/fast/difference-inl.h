// Masks of each triangle compared with others that are at hand, in the strips in which they are drawn.
//
// Writing rows out and comparing these would move every mask through the cache twice more. Here a mask never leaves its
// strips, a few kilobytes for a whole group of triangles; each word is cleared when it has been compared, which is what
// the next group needs.
#include "rasterizer/fast/union-inl.h"

#if defined(EDGECASE_FAST_DIFFERENCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_DIFFERENCE_INL_H_
#undef EDGECASE_FAST_DIFFERENCE_INL_H_
#else
#define EDGECASE_FAST_DIFFERENCE_INL_H_
#endif

#include <algorithm>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// Whether `rows`, a word each of 32 or 64 bits, are the strip's rows, as far as these are `pixels`. Clears the strip.
template <class Word>
HWY_INLINE bool take_equal_strip(const Strips& strip, Word pixels, const Word* rows) {
  const hn::CappedTag<Word, kMaxLanes * sizeof(std::uint32_t) / sizeof(Word)> d;
  const hn::Rebind<std::uint32_t, decltype(d)> d_strip;
  const auto load = [&](const std::uint32_t* words) HWY_ATTR {
    if constexpr (sizeof(Word) == sizeof(std::uint32_t)) {
      return hn::LoadU(d, words);
    } else {
      return hn::PromoteTo(d, hn::LoadU(d_strip, words));
    }
  };
  const int lanes = static_cast<int>(hn::Lanes(d));
  auto differing = hn::Zero(d);
  int y = 0;
  for (; y + lanes <= strip.height; y += lanes) {
    const auto drawn = hn::And(load(strip.words + y), hn::Set(d, pixels));
    differing = hn::Or(differing, hn::Xor(drawn, hn::LoadU(d, rows + y)));
    hn::StoreU(hn::Zero(d_strip), d_strip, strip.words + y);
  }
  Word rest = 0;
  for (; y < strip.height; ++y) {
    rest |= (strip.words[y] & pixels) ^ rows[y];
    strip.words[y] = 0;
  }
  return rest == 0 && hn::AllTrue(d, hn::Eq(differing, hn::Zero(d)));
}

/// Whether `rows` are what strips_to_rows() would write. Clears the strips.
HWY_INLINE bool take_equal(const Strips& strips, std::uint64_t last_word, const std::uint64_t* rows) {
  if (strips.count == 1) return take_equal_strip(strips, last_word, rows);
  const int words = (strips.count + 1) / 2;
  const std::uint32_t* left = strips.words;
  std::uint64_t differing = 0;
  for (int word = 0; word < words; ++word, left += 2 * strips.stride) {
    const bool single = 2 * word + 1 == strips.count;
    const std::uint64_t pixels = word + 1 == words ? last_word : ~std::uint64_t{0};
    for (int y = 0; y < strips.height; ++y) {
      const std::uint64_t right = single ? 0 : left[strips.stride + static_cast<std::size_t>(y)];
      differing |= ((left[y] | right << 32) & pixels) ^ rows[y * words + word];
    }
  }
  std::memset(strips.words, 0, static_cast<std::size_t>(strips.count) * strips.stride * sizeof(std::uint32_t));
  return differing == 0;
}

/// The first triangle for which take_equal(strips, i) is false, the strips being those that it was drawn into;
/// triangles.size() if there is none.
template <class TakeEqual>
HWY_INLINE std::size_t first_taken_unequal(std::span<const SnappedTriangle> triangles, int width,
                                           const Scratch& scratch, const TakeEqual& take_equal) {
  for (std::size_t first = 0; first < triangles.size(); first += scratch.masks) {
    const auto list = triangles.subspan(first, std::min(scratch.masks, triangles.size() - first));
    draw_list(list, CentrePlane(), width, scratch.apart, scratch.strips);
    Strips own = scratch.strips;
    for (std::size_t i = 0; i < list.size(); ++i, own.words += scratch.apart) {
      if (!take_equal(own, first + i)) return first + i;
    }
  }
  return triangles.size();
}

inline std::size_t first_difference(std::span<const SnappedTriangle> triangles, int width, const Scratch& scratch,
                                    const std::uint64_t* masks) {
  const std::uint64_t last_word = ~std::uint64_t{0} >> (63 - (width - 1) % 64);
  const std::size_t mask_words =
      static_cast<std::size_t>(scratch.strips.count + 1) / 2 * static_cast<std::size_t>(scratch.strips.height);
  return first_taken_unequal(triangles, width, scratch, [&](const Strips& strips, std::size_t i) HWY_ATTR {
    return take_equal(strips, last_word, masks + i * mask_words);
  });
}

inline std::size_t first_short_difference(std::span<const SnappedTriangle> triangles, int width, const Scratch& scratch,
                                          const std::uint32_t* rows) {
  const std::uint32_t pixels = ~std::uint32_t{0} >> (kStripWidth - width);
  const auto height = static_cast<std::size_t>(scratch.strips.height);
  return first_taken_unequal(triangles, width, scratch, [&](const Strips& strips, std::size_t i) HWY_ATTR {
    return take_equal_strip(strips, pixels, rows + i * height);
  });
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
