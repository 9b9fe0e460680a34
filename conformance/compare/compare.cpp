#include "conformance/compare/compare.h"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <cstring>

#include "conformance/compare/row_bits.h"

namespace edgecase::conformance {
namespace {

std::uint64_t count(std::uint64_t bits) { return static_cast<std::uint64_t>(std::popcount(bits)); }

bool equal(MaskView a, MaskView b) { return std::memcmp(a.data(), b.data(), a.size_bytes()) == 0; }

/// Samples of one mask that the rules leave open. `may` may hold the bits of `must` too.
std::uint64_t open_samples(const MaskLayout& layout, MaskView must, MaskView may) {
  std::uint64_t open = 0;
  const std::size_t row_words = layout.row_words();
  for (std::size_t row = 0; row < must.size(); row += row_words) {
    for (std::size_t word = 0; word < row_words; ++word) {
      const std::uint64_t bits = may[row + word] & ~must[row + word];
      if (bits != 0) open += count(bits & sample_bits(layout, word));
    }
  }
  return open;
}

/// Returns the first wrong sample.
std::optional<WrongSample> compare_triangle(const MaskLayout& layout, MaskView must, MaskView may, MaskView observed,
                                            std::size_t triangle, Comparison& total) {
  std::optional<WrongSample> first;
  const std::size_t row_words = layout.row_words();
  for (std::size_t i = 0; i < must.size(); ++i) {
    if (must[i] == observed[i]) continue;
    const std::uint64_t open = may.empty() ? 0 : may[i];
    const std::uint64_t samples = sample_bits(layout, i % row_words);
    const std::uint64_t missing = must[i] & ~observed[i] & samples;
    const std::uint64_t unexpected = observed[i] & ~must[i] & ~open & samples;
    const std::uint64_t wrong = missing | unexpected;
    if (wrong == 0) continue;
    total.missing += count(missing);
    total.unexpected += count(unexpected);
    if (first) continue;
    const auto bit = static_cast<std::size_t>(std::countr_zero(wrong));
    const auto [x, y, sample] = sample_index(layout, i * 64 + bit);
    const bool is_missing = (missing >> bit & 1) != 0;
    first = {is_missing ? WrongSample::Kind::missing : WrongSample::Kind::unexpected, triangle, x, y, sample};
  }
  if (!first) return std::nullopt;
  ++total.wrong_triangles;
  if (!total.first) total.first = first;
  return first;
}

}  // namespace

const char* name_of(WrongSample::Kind kind) {
  switch (kind) {
    case WrongSample::Kind::missing:
      return "missing";
    case WrongSample::Kind::unexpected:
      return "unexpected";
    case WrongSample::Kind::doubled:
      return "doubled";
  }
  return "";
}

std::string describe(const WrongSample& wrong) {
  return fmt::format("{}: pixel ({}, {}), sample {}, triangle {}", name_of(wrong.kind), wrong.x, wrong.y, wrong.sample,
                     wrong.triangle);
}

void Comparison::add(const Comparison& later) {
  triangles += later.triangles;
  samples_compared += later.samples_compared;
  missing += later.missing;
  unexpected += later.unexpected;
  doubled += later.doubled;
  wrong_triangles += later.wrong_triangles;
  if (!first) first = later.first;
}

void compare_masks(const MaskLayout& layout, std::span<const std::uint64_t> must, std::span<const std::uint64_t> may,
                   std::span<const std::uint64_t> observed, std::size_t first_triangle, Comparison& total,
                   std::vector<WrongSample>* firsts) {
  const std::size_t words = layout.words();
  const std::size_t triangles = must.size() / words;
  assert(must.size() == triangles * words && observed.size() == must.size());
  assert(may.empty() || may.size() == must.size());

  total.triangles += triangles;
  total.samples_compared += triangles * layout.sample_count();
  // Equal masks are the common case: one memcmp per batch, then one per triangle, then words.
  const bool batch_equal = equal(must, observed);
  if (batch_equal && may.empty()) return;
  for (std::size_t i = 0; i < triangles; ++i) {
    const MaskView expected = must.subspan(i * words, words);
    const MaskView open = may.empty() ? MaskView{} : may.subspan(i * words, words);
    const MaskView seen = observed.subspan(i * words, words);
    if (!open.empty()) total.samples_compared -= open_samples(layout, expected, open);
    if (batch_equal || equal(expected, seen)) continue;
    const auto first = compare_triangle(layout, expected, open, seen, first_triangle + i, total);
    if (first && firsts != nullptr) firsts->push_back(*first);
  }
}

}  // namespace edgecase::conformance
