#include "rasterizer/threads/threads.h"

#include <cassert>
#include <chrono>
#include <cstddef>
#include <vector>

#include "rasterizer/threads/crew.h"
#include "rasterizer/threads/tiled_draw.h"
#include "rasterizer/threads/waking.h"

namespace edgecase::rasterizer {

struct ThreadedRasterizer::State {
  State(const FastRasterizer& rasterizer, int threads)
      : fast(rasterizer), crew(threads, [this](std::size_t place) { canvases[place].clear(); }) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(threads); ++i) canvases.emplace_back(i);
  }

  FastRasterizer fast;
  std::vector<TiledDraw::Canvas> canvases;  ///< one for each place of the crew, which ends before they do
  TiledDraw::Memory memory;
  Crew crew;
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
  const int threads = state_->crew.threads();
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
  assert(plan.threads <= state_->crew.threads());
  if (plan.threads <= 1) return state_->fast.cover_union(triangles, mask);
  TiledDraw drawing(state_->fast, triangles, plan, mask, state_->memory);
  // The caller has place 0, whose canvas is in place.
  state_->crew.run(plan.threads, [&](std::size_t place) { drawing.work(state_->canvases[place]); });
}

}  // namespace edgecase::rasterizer
