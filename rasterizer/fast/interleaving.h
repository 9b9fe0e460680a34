// How the planes of samples become rows of a mask in which the samples of a pixel are neighbours: which bits go where.
//
// Say there are 2^p planes. A bit's place in a strip's words of one row is a number of p + 5 bits: those of the sample,
// s, choose the word, those of the column, x, the bit in it. In the mask they are to be (x, s), read as one number: s
// in the lowest p bits of the bit's number, the lowest 5 - p bits of x above them, and the upper p bits of x choose the
// word. Two words of which one bit of the number differs exchange that bit with one of the bit's number by a masked
// exchange of half of their bits. Each of the five places in the bit's number is filled once by what belongs there, so
// five rounds over all words do it. Rows are in lanes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "rasterizer/fast/strip_mask.h"

namespace edgecase::rasterizer {

/// Bits of the number of a bit in a word.
inline constexpr int kPlaces = 5;
static_assert(1 << kPlaces == kStripWidth);

/// The exchanges for 2^p planes, and where they leave the words.
struct Interleaving {
  struct Exchange {
    int word_bit;
    int bit;
  };
  std::array<Exchange, kPlaces> exchanges{};
  /// Word i of the mask is word order[i] afterwards.
  std::array<int, kMaxSamples> order{};
};

constexpr Interleaving interleaving(int p) {
  // What each bit of a place is: bit i of the sample as i, bit i of the column as p + i, its place in the mask's row.
  std::array<int, 4> word{0, 1, 2, 3};
  std::array<int, kPlaces> bit{p, p + 1, p + 2, p + 3, p + 4};
  Interleaving result;
  for (auto& exchange : result.exchanges) {
    int k = 0;
    while (word[static_cast<std::size_t>(k)] >= kPlaces) ++k;
    const int to = word[static_cast<std::size_t>(k)];
    exchange = {k, to};
    std::swap(word[static_cast<std::size_t>(k)], bit[static_cast<std::size_t>(to)]);
  }
  for (int i = 0; i < 1 << p; ++i) {
    int& from = result.order[static_cast<std::size_t>(i)] = 0;
    for (int k = 0; k < p; ++k) from |= (i >> (word[static_cast<std::size_t>(k)] - kPlaces) & 1) << k;
  }
  return result;
}

/// The bits of a word whose number has bit `bit` clear.
constexpr std::uint32_t bits_without(int bit) {
  std::uint32_t bits = 0;
  for (int i = 0; i < 32; ++i) bits |= std::uint32_t{(i >> bit & 1) == 0} << i;
  return bits;
}

}  // namespace edgecase::rasterizer
