#include "rasterizer/fast/fast.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <vector>

#include "rasterizer/fast/kernels.h"

// Every target of Isa, whatever the compiler's flags: tests run them all.
#define HWY_COMPILE_ALL_ATTAINABLE
#define HWY_DISABLED_TARGETS HWY_SSSE3
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rasterizer/fast/fast.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "rasterizer/fast/kernels-inl.h"

#if HWY_ONCE
namespace edgecase::rasterizer {
namespace {

struct Entry {
  Isa isa;
  std::string_view name;
  std::int64_t target;
  const FastRasterizer::Kernels* kernels;
};

// Highway's fallback is one lane with GCC 12 and four emulated ones with Clang.
constexpr std::array kEntries{
    Entry{Isa::portable, "portable", HWY_BASELINE_SCALAR, HWY_CHOOSE_FALLBACK(kKernels)},
    Entry{Isa::sse4, "sse4", HWY_SSE4, &N_SSE4::kKernels},
    Entry{Isa::avx2, "avx2", HWY_AVX2, &N_AVX2::kKernels},
    Entry{Isa::avx3, "avx3", HWY_AVX3, &N_AVX3::kKernels},
};

const Entry& entry(Isa isa) { return kEntries[static_cast<std::size_t>(isa)]; }

}  // namespace

std::string_view name_of(Isa isa) { return entry(isa).name; }

std::span<const Isa> available_isas() {
  struct List {
    std::array<Isa, kEntries.size()> isas{};
    std::size_t count = 0;
  };
  static const List list = [] {
    List found;
    const std::int64_t supported = hwy::SupportedTargets();
    for (const Entry& candidate : kEntries) {
      if (candidate.isa == Isa::portable || (supported & candidate.target) != 0) {
        found.isas[found.count++] = candidate.isa;
      }
    }
    return found;
  }();
  return std::span(list.isas).first(list.count);
}

FastRasterizer::FastRasterizer() : FastRasterizer(*make(available_isas().back())) {}

std::optional<FastRasterizer> FastRasterizer::make(Isa isa) {
  const auto available = available_isas();
  if (std::find(available.begin(), available.end(), isa) == available.end()) return std::nullopt;
  return FastRasterizer(isa, entry(isa).kernels);
}

namespace {

Strips of_region(Strips strips, const Region& region) {
  strips.words += static_cast<std::size_t>(region.first_strip) * strips.stride + static_cast<std::size_t>(region.top);
  strips.count = region.strip_count();
  strips.height = region.height;
  return strips;
}

/// Masks of `planes` planes on `layout`: a vector's lanes of triangles at once, as long as their masks stay in the
/// second-level cache. All clear.
Scratch make_scratch(const StripLayout& layout, int height, int planes, std::vector<std::uint32_t>& words) {
  constexpr std::size_t kMostWords = 1 << 16;
  const std::size_t apart = layout.words() * static_cast<std::size_t>(planes);
  const std::size_t masks = std::clamp<std::size_t>(kMostWords / apart, 1, kMaxLanes);
  words.resize(apart * masks + layout.stride);
  return {{words.data(), layout.stride, layout.count, height}, masks, apart};
}

FirstTriangles of_region(FirstTriangles first, const Region& region) {
  first.numbers += static_cast<std::size_t>(region.top) * first.row_pixels +
                   static_cast<std::size_t>(region.first_strip) * kStripWidth;
  return first;
}

}  // namespace

void StripMask::to_rows(std::span<std::uint64_t> rows) const {
  assert(rows.size() == target_.mask_words(samples_));
  const auto& kernels = *entry(available_isas().back()).kernels;
  const int width = target_.width().value();
  // Only read.
  const Strips strips = const_cast<StripMask*>(this)->strips();
  if (samples_ == 1) return kernels.strips_to_rows(strips, ~std::uint64_t{0} >> (63 - (width - 1) % 64), rows.data());
  std::ranges::fill(rows, std::uint64_t{0});
  const Region whole{0, 0, 0, width, strips.height, samples_, {}};
  kernels.region_to_rows(strips, plane_words(), whole, target_.row_words(samples_), rows.data());
}

bool FastRasterizer::snap_on_grid(std::span<const Triangle> triangles,
                                  std::span<FixedTriangle<Format16_8>> snapped) const {
  assert(triangles.size() == snapped.size());
  return kernels_->snap_on_grid(triangles, snapped.data());
}

void FastRasterizer::cover_union(Triangles triangles, StripMask& mask) const {
  assert(mask.samples() == 1);
  kernels_->cover_union(triangles, mask.target().width().value(), mask.strips());
}

void FastRasterizer::cover_union_in(Triangles triangles, const Region& region, StripMask& mask) const {
  std::vector<std::uint32_t> kept;
  if (region.left != 0 || region.right % kStripWidth != 0) {
    kept.resize(2 * static_cast<std::size_t>(region.height) * static_cast<std::size_t>(region.samples));
  }
  kernels_->cover_union_in(triangles, region, of_region(mask.strips(), region), mask.plane_words(), kept.data());
}

void FastRasterizer::cover_each(Triangles triangles, const Target& target, std::span<std::uint64_t> masks) const {
  assert(masks.size() == triangles.size() * target.mask_words());
  std::vector<std::uint32_t> words;
  const Scratch scratch = make_scratch(StripLayout(target), target.height().value(), 1, words);
  kernels_->cover_each(triangles, target.width().value(), scratch, masks.data());
}

void FastRasterizer::cover_each_in(Triangles triangles, const Region& region, const Target& target,
                                   std::span<std::uint64_t> masks) const {
  std::vector<std::uint32_t> words;
  const StripLayout layout(*Target::make(region.right, region.height));
  const Scratch scratch = make_scratch(layout, region.height, region.samples, words);
  kernels_->cover_each_in(triangles, region, scratch, target.row_words(region.samples),
                          target.mask_words(region.samples), masks.data());
}

std::size_t FastRasterizer::first_difference(Triangles triangles, const Target& target,
                                             std::span<const std::uint64_t> masks) const {
  assert(masks.size() == triangles.size() * target.mask_words());
  std::vector<std::uint32_t> words;
  const Scratch scratch = make_scratch(StripLayout(target), target.height().value(), 1, words);
  return kernels_->first_difference(triangles, target.width().value(), scratch, masks.data());
}

std::size_t FastRasterizer::first_difference(Triangles triangles, const Target& target,
                                             std::span<const std::uint32_t> rows) const {
  const int width = target.width().value(), height = target.height().value();
  assert(width <= kStripWidth && rows.size() == triangles.size() * static_cast<std::size_t>(height));
  std::vector<std::uint32_t> words;
  const Scratch scratch = make_scratch(StripLayout(target), height, 1, words);
  return kernels_->first_short_difference(triangles, width, scratch, rows.data());
}

void FastRasterizer::count_each(Triangles triangles, const Target& target, std::span<std::uint64_t> counts) const {
  assert(counts.size() == triangles.size());
  kernels_->count_each(triangles, target.width().value(), target.height().value(), counts.data());
}

void FastRasterizer::count_each_in(Triangles triangles, const Region& region, std::span<std::uint64_t> counts) const {
  kernels_->count_each_in(triangles, region, counts.data());
}

void FastRasterizer::cover_first(Triangles triangles, VisibilityBuffer& buffer, std::uint32_t first_number) const {
  assert(buffer.samples() == 1);
  const Strips covered = buffer.covered_.strips();
  const Strips scratch{buffer.scratch_.data(), covered.stride, covered.count, covered.height};
  kernels_->cover_first(triangles, buffer.target().width().value(), scratch, covered,
                        {buffer.numbers_.data(), buffer.plane_pixels_, buffer.row_pixels_, first_number});
}

void FastRasterizer::cover_first_in(Triangles triangles, const Region& region, VisibilityBuffer& buffer,
                                    std::uint32_t first_number) const {
  const Strips covered = of_region(buffer.covered_.strips(), region);
  Strips own = covered;
  own.words = buffer.scratch_.data();
  const FirstTriangles first{buffer.numbers_.data(), buffer.plane_pixels_, buffer.row_pixels_, first_number};
  kernels_->cover_first_in(triangles, region, own, covered, buffer.covered_.plane_words(), of_region(first, region));
}

void FastRasterizer::cover_tile(Triangles triangles, TileMask& mask) const {
  kernels_->cover_tile(triangles, mask.tile(), mask.strips());
}

void FastRasterizer::add_strips(const TileMask& from, StripMask& to, std::size_t begin, std::size_t end) const {
  const Tile& tile = from.tile();
  const Strips strips = to.strips();
  const auto first_strip = static_cast<std::size_t>(tile.left / kStripWidth);
  for (std::size_t strip = begin; strip < end; ++strip) {
    kernels_->add_words(from.strip(strip),
                        strips.words + (first_strip + strip) * strips.stride + static_cast<std::size_t>(tile.top),
                        static_cast<std::size_t>(tile.height));
  }
}

void FastRasterizer::find_reach(Triangles triangles, const TileGrid& grid, std::span<std::uint64_t> words) const {
  assert(words.size() >=
         (triangles.size() + kReachBlock - 1) / kReachBlock * static_cast<std::size_t>(grid.columns() + grid.rows()));
  kernels_->find_reach(triangles, grid, words.data());
}

}  // namespace edgecase::rasterizer
#endif  // HWY_ONCE
