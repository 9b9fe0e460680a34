// Planes of strips, one for each sample, written out as rows of a Mask, in which the samples of a pixel are neighbours.
#include "rasterizer/fast/interleaving.h"
#include "rasterizer/fast/lanes-inl.h"

#if defined(EDGECASE_FAST_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_ROWS_INL_H_
#undef EDGECASE_FAST_ROWS_INL_H_
#else
#define EDGECASE_FAST_ROWS_INL_H_
#endif

#include <algorithm>
#include <bit>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

template <int P, std::size_t Round>
HWY_INLINE void exchange(U32* words) {
  constexpr auto kExchange = interleaving(P).exchanges[Round];
  constexpr std::uint32_t kMask = bits_without(kExchange.bit);
  const U32 mask = hn::Set(DU32(), kMask);
  for (int i = 0; i < 1 << P; ++i) {
    if ((i >> kExchange.word_bit & 1) != 0) continue;
    U32& a = words[i];
    U32& b = words[i + (1 << kExchange.word_bit)];
    const U32 change = hn::And(hn::Xor(hn::ShiftRight<1 << kExchange.bit>(a), b), mask);
    b = hn::Xor(b, change);
    a = hn::Xor(a, hn::ShiftLeft<1 << kExchange.bit>(change));
  }
}

/// 2^P words of which word s, bit x is sample s of column x, to words in which that is bit x * 2^P + s.
template <int P>
HWY_INLINE void interleave(U32* words) {
  exchange<P, 0>(words), exchange<P, 1>(words), exchange<P, 2>(words), exchange<P, 3>(words), exchange<P, 4>(words);
  constexpr auto kOrder = interleaving(P).order;
  U32 ordered[1 << P];
  for (std::size_t i = 0; i < 1 << P; ++i) ordered[i] = words[kOrder[i]];
  for (std::size_t i = 0; i < 1 << P; ++i) words[i] = ordered[i];
}

/// Adds 32 pixels, `samples` samples each, of which each has the lowest bits of a field of 2^P bits, from pixel `pixel`
/// of a row on.
template <int P>
HWY_INLINE void pack_fields(const std::uint64_t* fields, int samples, int pixel, std::uint64_t* row) {
  constexpr int kField = 1 << P;
  auto at = static_cast<std::size_t>(pixel) * static_cast<std::size_t>(samples);
  for (int x = 0; x < kStripWidth; ++x, at += static_cast<std::size_t>(samples)) {
    const std::uint64_t field = fields[x * kField / 64] >> (x * kField % 64) & ((std::uint64_t{1} << kField) - 1);
    if (field == 0) continue;
    row[at / 64] |= field << (at % 64);
    if (at % 64 + static_cast<std::size_t>(samples) > 64) row[at / 64 + 1] |= field >> (64 - at % 64);
  }
}

/// Adds a strip of a region, at `words` and `apart` words further on for each further sample, to a mask.
template <int P>
HWY_INLINE void add_strip(const std::uint32_t* words, std::size_t apart, const Region& region, int strip,
                          std::size_t row_words, std::uint64_t* rows) {
  constexpr int kPlanes = 1 << P;
  constexpr int kStripWords = kPlanes * kStripWidth / 64;
  const auto d = DU32();
  const U32 columns = hn::Set(d, region.columns(strip));
  const int first_pixel = (region.first_strip + strip) * kStripWidth;
  for (int y = 0; y < region.height; y += static_cast<int>(kLanes)) {
    U32 planes[kPlanes];
    U32 any = hn::Zero(d);
    for (int s = 0; s < kPlanes; ++s) {
      planes[s] = s < region.samples ? hn::And(columns, hn::LoadU(d, words + static_cast<std::size_t>(s) * apart + y))
                                     : hn::Zero(d);
      any = hn::Or(any, planes[s]);
    }
    if (hn::AllTrue(d, hn::Eq(any, hn::Zero(d)))) continue;
    interleave<P>(planes);
    HWY_ALIGN std::uint32_t lanes[kPlanes][kMaxLanes];
    for (int i = 0; i < kPlanes; ++i) hn::Store(planes[i], d, lanes[i]);
    const int live = std::min(region.height - y, static_cast<int>(kLanes));
    for (int r = 0; r < live; ++r) {
      std::uint64_t* row = rows + static_cast<std::size_t>(region.top + y + r) * row_words;
      std::uint64_t pixels[kStripWords];
      for (int i = 0; i < kStripWords; ++i) {
        pixels[i] = lanes[2 * i][r] | std::uint64_t{lanes[2 * i + 1][r]} << 32;
      }
      if (region.samples != kPlanes) {
        pack_fields<P>(pixels, region.samples, first_pixel, row);
        continue;
      }
      const std::size_t first = static_cast<std::size_t>(first_pixel) * kPlanes / 64;
      const auto end = std::min(first + kStripWords, row_words);
      for (std::size_t i = first; i < end; ++i) row[i] = pixels[i - first];
    }
  }
}

/// The same for one sample a pixel.
template <>
HWY_INLINE void add_strip<0>(const std::uint32_t* words, std::size_t, const Region& region, int strip,
                             std::size_t row_words, std::uint64_t* rows) {
  const std::uint32_t columns = region.columns(strip);
  const int number = region.first_strip + strip;
  std::uint64_t* to = rows + static_cast<std::size_t>(region.top) * row_words + static_cast<std::size_t>(number / 2);
  for (int y = 0; y < region.height; ++y, to += row_words) {
    *to |= std::uint64_t{words[y] & columns} << (number % 2 * kStripWidth);
  }
}

/// Writes a mask, of `row_words` words a row, of which nothing is covered outside `region`, whose planes lie `apart`
/// words apart. `rows` is clear.
inline void region_to_rows(const Strips& strips, std::size_t apart, const Region& region, std::size_t row_words,
                           std::uint64_t* rows) {
  const std::uint32_t* words = strips.words;
  for (int strip = 0; strip < strips.count; ++strip, words += strips.stride) {
    switch (std::bit_width(static_cast<unsigned>(region.samples - 1))) {
      case 0:
        add_strip<0>(words, apart, region, strip, row_words, rows);
        break;
      case 1:
        add_strip<1>(words, apart, region, strip, row_words, rows);
        break;
      case 2:
        add_strip<2>(words, apart, region, strip, row_words, rows);
        break;
      case 3:
        add_strip<3>(words, apart, region, strip, row_words, rows);
        break;
      default:
        add_strip<4>(words, apart, region, strip, row_words, rows);
    }
  }
}

/// strips_to_rows where a row is a part of one strip: its words only become longer.
inline void strip_to_rows(const Strips& strip, std::uint64_t pixels, std::uint64_t* rows) {
  const hn::CappedTag<std::uint64_t, kMaxLanes / 2> d;
  const hn::Rebind<std::uint32_t, decltype(d)> d_strip;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int y = 0;
  for (; y + lanes <= strip.height; y += lanes) {
    hn::StoreU(hn::And(hn::PromoteTo(d, hn::LoadU(d_strip, strip.words + y)), hn::Set(d, pixels)), d, rows + y);
  }
  for (; y < strip.height; ++y) rows[y] = strip.words[y] & pixels;
}

/// Writes a whole target's mask of one sample a pixel. `last_word`: the pixels of a row's last word.
inline void strips_to_rows(const Strips& strips, std::uint64_t last_word, std::uint64_t* rows) {
  if (strips.count == 1) return strip_to_rows(strips, last_word, rows);
  const std::uint32_t* left = strips.words;
  const int words = (strips.count + 1) / 2;
  for (int word = 0; word < words; ++word, left += 2 * strips.stride) {
    const bool single = 2 * word + 1 == strips.count;
    const std::uint64_t pixels = word + 1 == words ? last_word : ~std::uint64_t{0};
    for (int y = 0; y < strips.height; ++y) {
      const std::uint64_t right = single ? 0 : left[strips.stride + static_cast<std::size_t>(y)];
      rows[y * words + word] = (left[y] | right << 32) & pixels;
    }
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
