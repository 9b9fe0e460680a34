#include "rasterizer/threads/threads.h"

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <cassert>
#include <chrono>
#include <cstddef>
#include <vector>

#include "rasterizer/threads/tiled_draw.h"
#include "rasterizer/threads/waking.h"

namespace edgecase::rasterizer {

struct ThreadedRasterizer::State {
  State(const FastRasterizer& rasterizer, int threads) : fast(rasterizer), arena(threads) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(threads); ++i) canvases.emplace_back(i);
  }

  FastRasterizer fast;
  tbb::task_arena arena;
  std::vector<TiledDraw::Canvas> canvases;
  TiledDraw::Memory memory;
  Waking waking;
};

ThreadedRasterizer::ThreadedRasterizer(const FastRasterizer& fast, int threads) {
  assert(threads >= 1);
  state_ = std::make_unique<State>(fast, threads);
}
ThreadedRasterizer::~ThreadedRasterizer() = default;
ThreadedRasterizer::ThreadedRasterizer(ThreadedRasterizer&&) noexcept = default;
ThreadedRasterizer& ThreadedRasterizer::operator=(ThreadedRasterizer&&) noexcept = default;

void ThreadedRasterizer::cover_union(std::span<const FixedTriangle<Format16_8>> triangles, StripMask& mask) {
  const int threads = state_->arena.max_concurrency();
  if (!may_pay(triangles, mask.target(), threads)) return state_->fast.cover_union(triangles, mask);
  const Plan plan = make_plan(triangles, mask.target(), threads);
  if (plan.threads == 1) return state_->fast.cover_union(triangles, mask);
  using Clock = std::chrono::steady_clock;
  const bool shared = state_->waking.shares(plan, Clock::now());
  if (shared) {
    cover_union(triangles, mask, plan);
  } else {
    state_->fast.cover_union(triangles, mask);
  }
  state_->waking.end(shared, Clock::now());
}

void ThreadedRasterizer::cover_union(std::span<const FixedTriangle<Format16_8>> triangles, StripMask& mask,
                                     const Plan& plan) {
  assert(plan.threads <= static_cast<int>(state_->canvases.size()));
  if (plan.threads <= 1) return state_->fast.cover_union(triangles, mask);
  TiledDraw drawing(state_->fast, triangles, plan, mask, state_->memory);
  const auto work = [&](std::size_t worker) { drawing.work(state_->canvases[worker]); };
  // The caller begins with worker 0, the canvas in place, and takes over what no other thread has come for.
  state_->arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, static_cast<std::size_t>(plan.threads), work, tbb::simple_partitioner());
  });
}

}  // namespace edgecase::rasterizer
