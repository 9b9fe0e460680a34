#include "conformance/compare/watertight.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "conformance/compare/row_bits.h"

namespace edgecase::conformance {
namespace {

using Wide = __int128;

std::uint64_t count(std::uint64_t bits) { return static_cast<std::uint64_t>(std::popcount(bits)); }

/// Smallest integer that is not below n / d, d being positive.
template <typename Int>
Int ceil_div(Int n, Int d) {
  const Int quotient = n / d;
  return quotient + (quotient * d < n ? 1 : 0);
}

/// Sets the bits from `begin` to before `end` of a row that `pattern` has.
void fill(std::uint64_t* row, const std::uint64_t* pattern, std::size_t begin, std::size_t end) {
  for (std::size_t word = begin / 64; word * 64 < end; ++word) {
    std::uint64_t bits = pattern[word];
    if (begin > word * 64) bits &= ~std::uint64_t{0} << (begin - word * 64);
    if (end < word * 64 + 64) bits &= ~(~std::uint64_t{0} << (end - word * 64));
    row[word] |= bits;
  }
}

/// Winding numbers are kept with so much added: those around 0, which come up on the way, differ in three digits only.
constexpr std::uint64_t kNoWinding = 4;
constexpr std::size_t kCommonPlanes = 3;

}  // namespace

void Watertightness::add(const Watertightness& later) {
  meshes += later.meshes;
  folded_meshes += later.folded_meshes;
  wrong_meshes += later.wrong_meshes;
  samples_inside += later.samples_inside;
  missing += later.missing;
  doubled += later.doubled;
  unexpected += later.unexpected;
  if (!first_missing) first_missing = later.first_missing;
  if (!first_doubled) first_doubled = later.first_doubled;
  if (!first_unexpected) first_unexpected = later.first_unexpected;
}

WatertightChecker::WatertightChecker(const Setting& setting, int subpixel_bits)
    : setting_(setting),
      layout_(setting),
      subpixel_bits_(subpixel_bits),
      scale_bits_(std::max(subpixel_bits, kSampleGridBits)),
      sample_words_(static_cast<std::size_t>(layout_.samples) * layout_.row_words()),
      drawn_(layout_.words()),
      inside_(layout_.words()),
      outline_(layout_.words()),
      once_(layout_.words()),
      twice_(layout_.words()) {
  for (int sample = 0; sample < layout_.samples; ++sample) {
    const MutableMaskView row =
        std::span(sample_words_).subspan(static_cast<std::size_t>(sample) * layout_.row_words(), layout_.row_words());
    for (int x = 0; x < layout_.target.width; ++x) cover(row, layout_.bit(x, 0, sample));
  }
  const Rect kept = setting.scissor.value_or(Rect{0, 0, setting.target.width, setting.target.height});
  for (std::int64_t y = 0; y < setting.target.height; ++y) {
    if (y < kept.y || y >= std::int64_t{kept.y} + kept.height) continue;
    for (std::int64_t x = 0; x < setting.target.width; ++x) {
      if (x < kept.x || x >= std::int64_t{kept.x} + kept.width) continue;
      for (int s = 0; s < layout_.samples; ++s) {
        cover(drawn_, layout_.bit(static_cast<int>(x), static_cast<int>(y), s));
      }
    }
  }
}

template <typename Int>
void WatertightChecker::scan_edge(const OutlineEdge& edge, int turn, const SampleLocation& location,
                                  std::size_t sample) {
  // Everything in units of 2^-scale_bits px, relative to this sample's location in pixel (0, 0), so that sample (x, y)
  // lies at (x << scale_bits, y << scale_bits).
  const Int unit = Int{1} << scale_bits_;
  const auto place = [&](std::int64_t vertex, int sixteenths) {
    return (Int{vertex} << (scale_bits_ - subpixel_bits_)) - (Int{sixteenths} << (scale_bits_ - kSampleGridBits));
  };
  const bool up = edge.to.y < edge.from.y;
  const GridPoint& upper = up ? edge.to : edge.from;
  const GridPoint& lower = up ? edge.from : edge.to;
  const Int x0 = place(upper.x, location.x);
  const Int y0 = place(upper.y, location.y);
  const Int x1 = place(lower.x, location.x);
  const Int y1 = place(lower.y, location.y);
  const Int width = layout_.target.width;
  const auto first_sample = [&](Int v) { return std::max(Int{0}, (v + unit - 1) >> scale_bits_); };
  const Int first_row = first_sample(y0);
  const Int last_row = std::min(Int{layout_.target.height} - 1, y1 >> scale_bits_);
  const std::size_t row_words = layout_.row_words();
  const std::uint64_t* pattern = sample_words_.data() + sample * row_words;
  const auto mark_outline = [&](Int row, Int begin, Int end) {
    fill(outline_.data() + static_cast<std::size_t>(row) * row_words, pattern,
         static_cast<std::size_t>(begin) * static_cast<std::size_t>(layout_.samples),
         static_cast<std::size_t>(end) * static_cast<std::size_t>(layout_.samples));
  };

  if (y0 == y1) {
    const Int begin = first_sample(std::min(x0, x1));
    const Int end = std::min(width, (std::max(x0, x1) >> scale_bits_) + 1);
    if (first_row <= last_row && begin < end) mark_outline(first_row, begin, end);
    return;
  }
  // In row y the edge lies at x = (x0 * dy + (y - y0) * dx) / dy. The winding number of a sample is the sum over the
  // edges on its left, +1 for one that goes up if the triangles turn clockwise. Rows are half open at an edge's lower
  // end and crossings belong to the sample they hit: that is the winding number of the sample moved down and right by
  // an infinitesimal, so it is always that of a face, and plain off the outline.
  const Int dx = x1 - x0;
  const Int dy = y1 - y0;
  // An edge left over twice separates windings that are not both 0 and 1; more than that need not be told apart.
  const int times = std::min(edge.times, 2);
  const int winding = (up ? times : -times) * turn;
  if (first_row > last_row) return;
  // Right of the target an edge changes nothing; on its left only which rows it crosses matters.
  if (std::min(x0, x1) > (width - 1) << scale_bits_) return;
  if (std::max(x0, x1) < 0) {
    for (Int row = first_row; row <= last_row && row << scale_bits_ != y1; ++row) {
      add_winding(static_cast<std::size_t>(row), 0, winding, pattern);
    }
    return;
  }
  // The first row's sample column at or right of the edge, and how far right of it: excess / denominator columns, less
  // than one. From row to row the edge moves by dx / dy columns.
  const Int denominator = dy << scale_bits_;
  const Int numerator = x0 * dy + ((first_row << scale_bits_) - y0) * dx;
  Int column = ceil_div(numerator, denominator);
  Int excess = column * denominator - numerator;
  const Int step = ceil_div(dx, dy);
  const Int step_excess = (step * dy - dx) << scale_bits_;
  for (Int row = first_row; row <= last_row; ++row) {
    if (column < width) {
      if (column >= 0 && excess == 0) mark_outline(row, column, column + 1);
      if (row << scale_bits_ == y1) return;
      const std::size_t first_bit =
          static_cast<std::size_t>(std::max(Int{0}, column)) * static_cast<std::size_t>(layout_.samples);
      add_winding(static_cast<std::size_t>(row), first_bit, winding, pattern);
    }
    column += step;
    excess += step_excess;
    if (excess >= denominator) {
      excess -= denominator;
      --column;
    }
  }
}

void WatertightChecker::reset_windings(std::span<const OutlineEdge> outline) {
  std::uint64_t most = 0;
  for (const OutlineEdge& edge : outline) most += static_cast<std::uint64_t>(std::min(edge.times, 2));
  // So many bits tell all of -most .. most apart, whatever is added to them.
  const std::size_t planes = std::max(kCommonPlanes, static_cast<std::size_t>(std::bit_width(2 * most)));
  if (windings_.size() < planes * layout_.words()) windings_.resize(planes * layout_.words());
  planes_ = planes;
  for (std::size_t plane = 0; plane < kCommonPlanes; ++plane) {
    const auto begin = windings_.begin() + static_cast<std::ptrdiff_t>(plane * layout_.words());
    std::fill_n(begin, layout_.words(), (kNoWinding >> plane & 1) != 0 ? ~std::uint64_t{0} : 0);
  }
  touched_planes_ = kCommonPlanes;
}

void WatertightChecker::add_winding(std::size_t row, std::size_t first_bit, int winding, const std::uint64_t* pattern) {
  const std::size_t words = layout_.words();
  const std::uint64_t down = winding < 0 ? ~std::uint64_t{0} : 0;
  std::uint64_t from = ~std::uint64_t{0} << (first_bit % 64);
  for (std::size_t word = first_bit / 64; word < layout_.row_words(); ++word, from = ~std::uint64_t{0}) {
    // The planes are as many binary counters as a word has bits; 2 is added to their second digit.
    std::uint64_t carry = pattern[word] & from;
    std::size_t plane = winding == 1 || winding == -1 ? 0 : 1;
    for (; carry != 0 && plane < planes_; ++plane) {
      std::uint64_t& digits = windings_[plane * words + row * layout_.row_words() + word];
      const std::uint64_t before = digits;
      digits ^= carry;
      carry &= before ^ down;
    }
    touched_planes_ = std::max(touched_planes_, plane);
  }
}

bool WatertightChecker::fill_inside() {
  const std::size_t words = layout_.words();
  std::uint64_t beyond = 0;  // 0 and 1 differ in the last digit only
  for (std::size_t plane = 1; plane < touched_planes_; ++plane) {
    const std::uint64_t none = (kNoWinding >> plane & 1) != 0 ? ~std::uint64_t{0} : 0;
    for (std::size_t word = 0; word < words; ++word) beyond |= windings_[plane * words + word] ^ none;
  }
  std::copy_n(windings_.begin(), words, inside_.begin());
  const auto rarely_used = windings_.begin() + static_cast<std::ptrdiff_t>(kCommonPlanes * words);
  std::fill_n(rarely_used, (touched_planes_ - kCommonPlanes) * words, 0);
  return beyond == 0;
}

template <typename Int>
bool WatertightChecker::classify(std::span<const OutlineEdge> outline, int turn) {
  std::fill(outline_.begin(), outline_.end(), 0);
  reset_windings(outline);
  for (std::size_t sample = 0; sample < setting_.sample_locations.size(); ++sample) {
    for (const OutlineEdge& edge : outline) scan_edge<Int>(edge, turn, setting_.sample_locations[sample], sample);
  }
  return fill_inside();
}

void WatertightChecker::count_layers(std::span<const std::uint64_t> masks) {
  // A cache line of every mask at a time, so that the counters stay in registers.
  constexpr std::size_t kAtOnce = 8;
  const std::size_t words = layout_.words();
  const auto count_words = [&](std::size_t first, std::size_t size) {
    std::array<std::uint64_t, kAtOnce> once{}, twice{};
    for (std::size_t mask = first; mask < masks.size(); mask += words) {
      for (std::size_t i = 0; i < size; ++i) {
        twice[i] |= once[i] & masks[mask + i];
        once[i] |= masks[mask + i];
      }
    }
    std::copy_n(once.begin(), size, once_.begin() + static_cast<std::ptrdiff_t>(first));
    std::copy_n(twice.begin(), size, twice_.begin() + static_cast<std::ptrdiff_t>(first));
  };
  std::size_t first = 0;
  for (; first + kAtOnce <= words; first += kAtOnce) count_words(first, kAtOnce);
  count_words(first, words - first);
}

WrongSample WatertightChecker::locate(WrongSample::Kind kind, std::size_t word, std::uint64_t bits,
                                      std::span<const std::uint64_t> masks, std::size_t first_triangle) const {
  const std::size_t bit = word * 64 + static_cast<std::size_t>(std::countr_zero(bits));
  const auto [x, y, sample] = sample_index(layout_, bit);
  WrongSample wrong{kind, first_triangle, x, y, sample};
  int layers_to_skip = kind == WrongSample::Kind::doubled ? 1 : 0;
  for (std::size_t mask = 0; kind != WrongSample::Kind::missing && mask < masks.size(); mask += layout_.words()) {
    if (!covered(masks.subspan(mask, layout_.words()), bit)) continue;
    if (layers_to_skip-- > 0) continue;
    wrong.triangle = first_triangle + mask / layout_.words();
    break;
  }
  return wrong;
}

void WatertightChecker::check(std::span<const GridTriangle> mesh, std::span<const std::uint64_t> masks,
                              std::size_t first_triangle, Watertightness& total, MaskView open) {
  assert(masks.size() == mesh.size() * layout_.words());
  ++total.meshes;
  const std::optional<int> turn = common_orientation(mesh);
  // The widest value of a scan is numerator, a sum of two products of differences. Coordinates below 2^28 in scaled
  // units keep differences below 2^30, also with the target's own extent of at most 2^30, and the sum below 2^61.
  const std::int64_t narrow = std::int64_t{1} << 28 >> (scale_bits_ - subpixel_bits_);
  const bool fits = static_cast<std::int64_t>(kMaxTargetExtent) << scale_bits_ <= std::int64_t{1} << 28 &&
                    std::all_of(mesh.begin(), mesh.end(), [&](const GridTriangle& triangle) {
                      return std::all_of(triangle.begin(), triangle.end(), [&](const GridPoint& p) {
                        return -narrow < p.x && p.x < narrow && -narrow < p.y && p.y < narrow;
                      });
                    });
  const std::span<const OutlineEdge> outline = builder_.build(mesh);
  if (!turn || !(fits ? classify<std::int64_t>(outline, *turn) : classify<Wide>(outline, *turn))) {
    ++total.folded_meshes;
    return;
  }
  for (std::size_t i = 0; i < open.size(); ++i) outline_[i] |= open[i];
  count_layers(masks);

  // Nothing to report is the common case.
  std::uint64_t any_wrong = 0;
  for (std::size_t word = 0; word < layout_.row_words(); ++word) {
    const std::uint64_t samples = sample_bits(layout_, word);
    for (std::size_t i = word; i < layout_.words(); i += layout_.row_words()) {
      const std::uint64_t allowed = (inside_[i] | outline_[i]) & drawn_[i];
      const std::uint64_t strictly_inside = inside_[i] & ~outline_[i] & drawn_[i];
      if (strictly_inside != 0) total.samples_inside += count(strictly_inside);
      any_wrong |= ((strictly_inside & ~once_[i]) | (twice_[i] & allowed) | (once_[i] & ~allowed)) & samples;
    }
  }
  if (any_wrong == 0) return;

  const auto report = [&](WrongSample::Kind kind, std::size_t word, std::uint64_t bits, std::uint64_t& counter,
                          std::optional<WrongSample>& first) {
    if (bits == 0) return;
    counter += count(bits);
    if (!first) first = locate(kind, word, bits, masks, first_triangle);
  };
  for (std::size_t i = 0; i < layout_.words(); ++i) {
    const std::uint64_t samples = sample_bits(layout_, i % layout_.row_words());
    const std::uint64_t strictly_inside = inside_[i] & ~outline_[i] & drawn_[i];
    const std::uint64_t outside = ~((inside_[i] | outline_[i]) & drawn_[i]) & samples;
    report(WrongSample::Kind::missing, i, strictly_inside & ~once_[i], total.missing, total.first_missing);
    report(WrongSample::Kind::doubled, i, twice_[i] & ~outside & samples, total.doubled, total.first_doubled);
    report(WrongSample::Kind::unexpected, i, once_[i] & outside, total.unexpected, total.first_unexpected);
  }
  ++total.wrong_meshes;
}

}  // namespace edgecase::conformance
