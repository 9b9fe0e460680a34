#include "rasterizer/threads/threads.h"

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rasterizer/edge.h"

namespace edgecase::rasterizer {
namespace {

/// Words or-ed together by one task: a multiple of a cache line, and small enough to stay in the first-level cache.
constexpr std::size_t kMergeWords = 2048;

/// Pieces of the list per thread. The last piece to end keeps the others waiting for half a piece on average: 1/32 of
/// the whole time.
constexpr std::size_t kPiecesPerThread = 16;

/// How long a list takes to draw, in words or-ed by merge(), roughly: from some of its triangles.
std::size_t estimated_work(std::span<const FixedTriangle<Format16_8>> triangles, const Target& target) {
  constexpr std::size_t kSamples = 32;
  constexpr std::size_t kSetup = 64;
  const std::size_t step = std::max<std::size_t>(triangles.size() / kSamples, 1);
  std::size_t work = 0, samples = 0;
  for (std::size_t i = 0; i < triangles.size(); i += step, ++samples) {
    const auto box = pixel_box<Format16_8>(triangles[i], View<>{target});
    if (!box) continue;
    const auto rows = static_cast<std::size_t>((box->bottom - box->top).value());
    const auto columns = static_cast<std::size_t>((box->right - box->left).value());
    work += kSetup + 2 * rows + rows * columns / kStripWidth;
  }
  return samples == 0 ? 0 : work * (triangles.size() / samples);
}

/// Adds `from` to `to` and leaves it clear.
void merge(std::uint32_t* __restrict from, std::uint32_t* __restrict to, std::size_t words) {
  for (std::size_t i = 0; i < words; ++i) {
    to[i] |= from[i];
    from[i] = 0;
  }
}

}  // namespace

struct ThreadedRasterizer::State {
  State(const FastRasterizer& rasterizer, int threads) : fast(rasterizer), arena(threads) {}

  FastRasterizer fast;
  tbb::task_arena arena;
  /// Of all workers but one, apart from each other in memory; clear between calls.
  std::vector<std::unique_ptr<StripMask>> owns;
};

ThreadedRasterizer::ThreadedRasterizer(const FastRasterizer& fast, int threads) {
  assert(threads >= 1);
  state_ = std::make_unique<State>(fast, threads);
}
ThreadedRasterizer::~ThreadedRasterizer() = default;
ThreadedRasterizer::ThreadedRasterizer(ThreadedRasterizer&&) noexcept = default;
ThreadedRasterizer& ThreadedRasterizer::operator=(ThreadedRasterizer&&) noexcept = default;

void ThreadedRasterizer::cover_union(std::span<const FixedTriangle<Format16_8>> triangles, StripMask& mask) {
  State& state = *state_;
  const auto threads = static_cast<std::size_t>(state.arena.max_concurrency());
  const std::size_t words = mask.allocated_words();
  // A thread more has to save more than its mask costs.
  const std::size_t worth = 1 + estimated_work(triangles, mask.target()) / (4 * words);
  const std::size_t workers = std::min({threads, worth, triangles.size()});
  if (workers <= 1) return state.fast.cover_union(triangles, mask);

  auto& owns = state.owns;
  if (!owns.empty() && !(owns.front()->target() == mask.target())) owns.clear();
  while (owns.size() + 1 < workers) owns.push_back(std::make_unique<StripMask>(mask.target()));

  const std::size_t piece = std::max<std::size_t>(triangles.size() / (workers * kPiecesPerThread), 1);
  // A worker's first piece is its own, so that every mask is drawn into, even where one thread plays all workers.
  alignas(64) std::atomic<std::size_t> next{workers * piece};
  const auto draw = [&](std::size_t worker) {
    StripMask& own = worker == 0 ? mask : *owns[worker - 1];
    for (std::size_t begin = worker * piece; begin < triangles.size(); begin = next.fetch_add(piece)) {
      state.fast.cover_union(triangles.subspan(begin, std::min(piece, triangles.size() - begin)), own);
    }
  };
  const auto add_own_masks = [&](std::size_t block) {
    const std::size_t begin = block * kMergeWords;
    const std::size_t count = std::min(kMergeWords, words - begin);
    for (std::size_t i = 0; i + 1 < workers; ++i) {
      merge(owns[i]->strips().words + begin, mask.strips().words + begin, count);
    }
  };
  const std::size_t blocks = (words + kMergeWords - 1) / kMergeWords;
  state.arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, workers, draw, tbb::simple_partitioner());
    tbb::parallel_for(std::size_t{0}, blocks, add_own_masks, tbb::static_partitioner());
  });
}

}  // namespace edgecase::rasterizer
