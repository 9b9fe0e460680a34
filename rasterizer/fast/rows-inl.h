// Planes of strips, one for each sample, written out as rows of a Mask, in which the samples of a pixel are neighbours.
#include "rasterizer/fast/interleaving.h"
#include "rasterizer/fast/lanes-inl.h"
#include "rasterizer/fast/strip_box.h"

#if defined(EDGECASE_FAST_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_ROWS_INL_H_
#undef EDGECASE_FAST_ROWS_INL_H_
#else
#define EDGECASE_FAST_ROWS_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

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

/// Brings pixels together whose `samples` samples are the lowest bits of fields of 2^P bits.
template <int P>
class FieldPacking {
 public:
  explicit FieldPacking(int samples) : samples_(samples) {
    for (int i = 0; i < kRounds; ++i) {
      const std::uint64_t used = (std::uint64_t{1} << (samples << i)) - 1;
      lower_[i] = 0;
      for (int field = 0; field < 64; field += kField << (i + 1)) lower_[i] |= used << field;
    }
  }

  /// Adds 32 pixels to a row, from pixel `pixel` on.
  HWY_INLINE void add(const std::uint64_t* fields, int pixel, std::uint64_t* row) const {
    auto at = static_cast<std::size_t>(pixel) * static_cast<std::size_t>(samples_);
    const std::size_t bits = static_cast<std::size_t>(samples_) << kRounds;
    for (int i = 0; i < kStripWidth * kField / 64; ++i, at += bits) {
      const std::uint64_t packed = pack(fields[i]);
      // What is not covered may lie beyond the row's last word.
      if (packed == 0) continue;
      row[at / 64] |= packed << (at % 64);
      if (const std::uint64_t rest = packed >> 1 >> (63 - at % 64); rest != 0) row[at / 64 + 1] |= rest;
    }
  }

 private:
  static constexpr int kField = 1 << P;
  static constexpr int kRounds = 6 - P;

  /// Round by round, the upper of two neighbours moves down to where the lower one's samples end.
  HWY_INLINE std::uint64_t pack(std::uint64_t fields) const {
    for (int i = 0; i < kRounds; ++i) {
      const int apart = (kField - samples_) << i;
      fields = (fields & lower_[i]) | (fields >> apart & (lower_[i] << (samples_ << i)));
    }
    return fields;
  }

  int samples_;
  std::uint64_t lower_[kRounds];  ///< the lower neighbours' samples in a round
};

/// kLanes rows of interleaved pixels, as a mask has them: those of a strip's row are `kWords` words.
template <int P>
class PixelRows {
 public:
  static constexpr int kWords = (1 << P) * kStripWidth / 64;

  /// `words`: as interleave() leaves them, rows in lanes.
  HWY_INLINE explicit PixelRows(const U32* words) {
    const auto d = DU32();
#if HWY_TARGET == HWY_SCALAR
    for (int i = 0; i < 1 << P; ++i) hn::Store(words[i], d, words_ + i);
#else
    // Four rows' words become neighbours within each 128 bits: pairs first, then, if there are four, pairs of pairs.
    const hn::Repartition<std::uint64_t, DU32> pairs;
    for (int i = 0; i < 1 << P; i += kTogether) {
      std::uint32_t* to = words_ + i * kStep;
      const U32 low01 = hn::InterleaveLower(d, words[i], words[i + 1]);
      const U32 high01 = hn::InterleaveUpper(d, words[i], words[i + 1]);
      if constexpr (kTogether == 2) {
        hn::Store(low01, d, to);
        hn::Store(high01, d, to + kLanes);
      } else {
        const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(d, words[i + 2], words[i + 3]));
        const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(d, words[i + 2], words[i + 3]));
        const auto low = hn::BitCast(pairs, low01), high = hn::BitCast(pairs, high01);
        hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, low, low23)), d, to);
        hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, low, low23)), d, to + kLanes);
        hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, high, high23)), d, to + 2 * kLanes);
        hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, high, high23)), d, to + 3 * kLanes);
      }
    }
#endif
  }

  /// The first `count` words of a row.
  HWY_INLINE void copy(int row, int count, std::uint64_t* to) const {
    if (count < kWords) {
      for (int i = 0; i < count; ++i) std::memcpy(to + i, at(row, i), sizeof(*to));
      return;
    }
    constexpr int kAtOnce = kTogether / 2;
    for (int i = 0; i < kWords; i += kAtOnce) std::memcpy(to + i, at(row, i), kAtOnce * sizeof(*to));
  }

 private:
#if HWY_TARGET == HWY_SCALAR
  static constexpr int kTogether = 2;
  const std::uint32_t* at(int, int i) const { return words_ + 2 * i; }
#else
  static constexpr int kTogether = P == 1 ? 2 : 4;  ///< words of a row side by side
  static constexpr int kStep = static_cast<int>(kLanes);
  HWY_INLINE const std::uint32_t* at(int row, int i) const {
    // Of the four rows of a 128-bit block, as many are side by side as make it full.
    constexpr int kRows = 4 / kTogether;
    const int part = row % 4 / kRows;
    return words_ + (2 * i / kTogether * kTogether + part) * kStep + row / 4 * 4 + row % kRows * 2 + 2 * i % kTogether;
  }
#endif
  HWY_ALIGN std::uint32_t words_[(1 << P) * kLanes];
};

/// What becomes of a strip's words once they are in a mask.
enum class Afterwards { kept, cleared };

/// The number of a pixel's samples, where that is 2^P and nothing needs packing.
template <int P>
using EverySample = std::integral_constant<int, 1 << P>;

/// Adds a strip of a region, at `words` and `apart` words further on for each further sample, to a mask: rows `top` <=
/// y < `bottom`, outside of which nothing is covered. `samples`: EverySample, or fewer.
template <int P, Afterwards A, class Samples>
HWY_INLINE void add_strip(std::uint32_t* words, std::size_t apart, const Region& region, Samples samples, int strip,
                          int top, int bottom, std::size_t row_words, std::uint64_t* rows) {
  constexpr int kPlanes = 1 << P;
  using Rows = PixelRows<P>;
  const auto d = DU32();
  const U32 columns = hn::Set(d, region.columns(strip));
  const int first_pixel = (region.first_strip + strip) * kStripWidth;
  const std::size_t first = static_cast<std::size_t>(first_pixel) * kPlanes / 64;
  const FieldPacking<P> packing(samples);
  for (int y = top; y < bottom; y += static_cast<int>(kLanes)) {
    U32 planes[kPlanes];
    U32 any = hn::Zero(d);
    for (int s = 0; s < kPlanes; ++s) {
      planes[s] = hn::Zero(d);
      if (s >= samples) continue;
      std::uint32_t* plane = words + static_cast<std::size_t>(s) * apart + y;
      planes[s] = hn::And(columns, hn::LoadU(d, plane));
      any = hn::Or(any, planes[s]);
      if constexpr (A == Afterwards::cleared) hn::StoreU(hn::Zero(d), d, plane);
    }
    if (hn::AllTrue(d, hn::Eq(any, hn::Zero(d)))) continue;
    interleave<P>(planes);
    const Rows pixels(planes);
    const int live = std::min(bottom - y, static_cast<int>(kLanes));
    std::uint64_t* row = rows + static_cast<std::size_t>(region.top + y) * row_words;
    for (int r = 0; r < live; ++r, row += row_words) {
      if constexpr (std::is_same_v<Samples, EverySample<P>>) {
        pixels.copy(r, static_cast<int>(std::min<std::size_t>(Rows::kWords, row_words - first)), row + first);
      } else {
        std::uint64_t fields[Rows::kWords];
        pixels.copy(r, Rows::kWords, fields);
        packing.add(fields, first_pixel, row);
      }
    }
  }
}

/// The same for one sample a pixel.
template <Afterwards A>
HWY_INLINE void add_single(std::uint32_t* words, const Region& region, int strip, int top, int bottom,
                           std::size_t row_words, std::uint64_t* rows) {
  const std::uint32_t columns = region.columns(strip);
  const int number = region.first_strip + strip;
  std::uint64_t* to = rows + static_cast<std::size_t>(region.top + top) * row_words + number / 2;
  for (int y = top; y < bottom; ++y, to += row_words) {
    *to |= std::uint64_t{words[y] & columns} << (number % 2 * kStripWidth);
    if constexpr (A == Afterwards::cleared) words[y] = 0;
  }
}

/// Writes a mask, of `row_words` words a row, of which nothing is covered outside `region` and `box`, and whose planes
/// lie `apart` words apart. `rows` is clear.
template <Afterwards A>
HWY_INLINE void box_to_rows(const Strips& strips, std::size_t apart, const Region& region, const StripBox& box,
                            std::size_t row_words, std::uint64_t* rows) {
  std::uint32_t* words = strips.words + static_cast<std::size_t>(box.first_strip) * strips.stride;
  const auto add = [&](const auto& add_one) {
    for (int strip = box.first_strip; strip < box.end_strip; ++strip, words += strips.stride) add_one(strip);
  };
  const auto add_samples = [&]<int P>(std::integral_constant<int, P>) {
    if (region.samples == 1 << P) {
      add([&](int strip) HWY_ATTR {
        add_strip<P, A>(words, apart, region, EverySample<P>(), strip, box.top, box.bottom, row_words, rows);
      });
    } else {
      add([&](int strip) HWY_ATTR {
        add_strip<P, A>(words, apart, region, region.samples, strip, box.top, box.bottom, row_words, rows);
      });
    }
  };
  switch (std::bit_width(static_cast<unsigned>(region.samples - 1))) {
    case 0:
      return add([&](int strip) { add_single<A>(words, region, strip, box.top, box.bottom, row_words, rows); });
    case 1:
      return add([&](int strip) HWY_ATTR {
        add_strip<1, A>(words, apart, region, EverySample<1>(), strip, box.top, box.bottom, row_words, rows);
      });
    case 2:
      return add_samples(std::integral_constant<int, 2>());
    case 3:
      return add_samples(std::integral_constant<int, 3>());
    default:
      return add_samples(std::integral_constant<int, 4>());
  }
}

/// All of a region, only read.
inline void region_to_rows(const Strips& strips, std::size_t apart, const Region& region, std::size_t row_words,
                           std::uint64_t* rows) {
  box_to_rows<Afterwards::kept>(strips, apart, region, StripBox(strips), row_words, rows);
}

/// A region in which only `box` is covered, cleared.
inline void take_to_rows(const Strips& strips, std::size_t apart, const Region& region, const StripBox& box,
                         std::size_t row_words, std::uint64_t* rows) {
  box_to_rows<Afterwards::cleared>(strips, apart, region, box, row_words, rows);
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
