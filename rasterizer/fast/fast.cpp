#include "rasterizer/fast/fast.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "rasterizer/fast/kernels.h"

// Every target of Isa, whatever the compiler's flags: tests run them all.
#define HWY_COMPILE_ALL_ATTAINABLE
#define HWY_DISABLED_TARGETS HWY_SSSE3
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rasterizer/fast/fast.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "rasterizer/fast/reach-inl.h"

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

void FastRasterizer::cover_union(std::span<const FixedTriangle<Format16_8>> triangles, StripMask& mask) const {
  kernels_->cover_union(triangles, mask.target().width().value(), mask.strips());
}

void FastRasterizer::cover_each(std::span<const FixedTriangle<Format16_8>> triangles, const Target& target,
                                std::span<std::uint64_t> masks) const {
  assert(masks.size() == triangles.size() * target.mask_words());
  const StripLayout layout(target);
  // A vector's lanes of triangles at once, as long as their masks stay in the second-level cache.
  constexpr std::size_t kMostWords = 1 << 16;
  const std::size_t at_once = layout.words() <= kMostWords / kMaxLanes ? kMaxLanes : 1;
  std::vector<std::uint32_t> scratch(layout.words() * at_once + layout.stride);
  kernels_->cover_each(triangles, target.width().value(), at_once, layout.words(),
                       {scratch.data(), layout.stride, layout.count, target.height().value()}, masks.data());
}

void FastRasterizer::cover_tile(std::span<const FixedTriangle<Format16_8>> triangles, TileMask& mask) const {
  kernels_->cover_tile(triangles, mask.tile(), mask.strips());
}

void FastRasterizer::find_reach(std::span<const FixedTriangle<Format16_8>> triangles, const TileGrid& grid,
                                std::span<std::uint64_t> words) const {
  assert(words.size() >=
         (triangles.size() + kReachBlock - 1) / kReachBlock * static_cast<std::size_t>(grid.columns() + grid.rows()));
  kernels_->find_reach(triangles, grid, words.data());
}

}  // namespace edgecase::rasterizer
#endif  // HWY_ONCE
