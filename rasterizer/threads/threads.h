// The union of a list of triangles, drawn by several threads: the same bits as one thread's, whatever their number.
//
// The list is cut into pieces that the threads take as they come free. Every thread but one draws into a mask of its
// own, so that no two ever write to the same cache line; afterwards the masks are or-ed together, each thread its part
// of the words. An or knows no order, which is why neither does the result.
//
// Coverage of a pixel is one bit, so a whole screen's mask fits into a core's second-level cache, and or-ing it costs
// about as much as drawing one or two triangles of the screen's size. Sorting triangles into bins of tiles first would
// read and write every triangle twice more, at a cost beyond that of drawing a small one. What bins would save is
// memory: here, it is a mask for every thread.
#pragma once

#include <memory>
#include <span>

#include "rasterizer/fast/fast.h"

namespace edgecase::rasterizer {

class ThreadedRasterizer {
 public:
  /// Draws with `fast` on up to `threads` threads, at least one, of oneTBB's.
  ThreadedRasterizer(const FastRasterizer& fast, int threads);
  ~ThreadedRasterizer();
  ThreadedRasterizer(ThreadedRasterizer&&) noexcept;
  ThreadedRasterizer& operator=(ThreadedRasterizer&&) noexcept;

  /// Adds the coverage of every triangle to `mask`: their union. Keeps threads - 1 masks of the target's size for the
  /// next call; allocates if it is the first for a target. Lists too short to be worth it are drawn by one thread. One
  /// call at a time.
  void cover_union(std::span<const FixedTriangle<Format16_8>> triangles, StripMask& mask);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace edgecase::rasterizer
