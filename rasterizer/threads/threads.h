// The union of a list of triangles, drawn by several threads: the same bits as one thread's, whatever their number.
//
// The way of Giesen's and Larrabee's articles: the target is cut into tiles, the list into chunks. First every chunk is
// binned: which tiles does each triangle reach (tiled_draw.h)? Then every tile is drawn from its bins. A thread that
// finds no chunk left to bin goes on to the tiles at once, and waits for another's chunk only when it needs that
// chunk's bins: there is no barrier. How many tiles, decides an estimate of what they cost (plan.h); it may be a single
// one, which needs no bins.
//
// Tiles are drawn in the order of falling work; towards the end, threads without a tile help with one that has much
// left (agenda.h). What limits many threads:
//   - before they start, one to three us for the plan; and if they sleep, 8 us for the call that wakes them and 25 to
//     40 until they are there (waking.h says when that is done). oneTBB lets them wait for a draw for 0.1 to 0.2 ms,
//     within which they begin after one us;
//   - whenever a thread takes a part of a tile that others draw, too, a cache line: so parts are few, and of falling
//     size (parts.h). Of the last one half is lost on average: it is 1/128 to 1/64 of a thread's share of a single
//     tile, and 1/32 of several;
//   - in the end, adding the helpers' masks, of which each thread does its share; clearing them is left to each helper
//     when the draw is over (crew.h);
//   - in total, the triangles on tiles' borders, which are drawn twice, and a mask for each tile and each helper.
// `edgecase bench --scaling` plays these tasks, with the times they take on one thread, through the agenda for up to
// 64 threads; conformance/bench/scaling.h says what it leaves out.
//
// The caller is one of the threads. It begins at once, and waits for a part that another thread is drawing, never for a
// thread that has not begun: if none comes, it draws everything itself, as fast as without threads but for waking them.
//
// No two threads write to a cache line at the same time: chunks have bins of their own, threads have masks of their
// own, and a tile's part of the target begins and ends between cache lines (tile_grid.h) and is added to under a lock.
#pragma once

#include <memory>
#include <span>

#include "rasterizer/fast/fast.h"
#include "rasterizer/threads/plan.h"

namespace edgecase::rasterizer {

class ThreadedRasterizer {
 public:
  /// Draws with `fast` on up to `threads` threads, at least one, of oneTBB's.
  ThreadedRasterizer(const FastRasterizer& fast, int threads);
  ~ThreadedRasterizer();
  ThreadedRasterizer(ThreadedRasterizer&&) noexcept;
  ThreadedRasterizer& operator=(ThreadedRasterizer&&) noexcept;

  /// Adds the coverage of every triangle to `mask`: their union. Lists too short to be worth it are drawn by one
  /// thread. Allocates; where that fails while several threads draw, the program ends. One call at a time.
  void cover_union(std::span<const FixedTriangle<Format16_8>> triangles, StripMask& mask);

  /// The same by a given plan, which must be for that list and target.
  void cover_union(std::span<const FixedTriangle<Format16_8>> triangles, StripMask& mask, const Plan& plan);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace edgecase::rasterizer
