// TiledDraw: one drawing as tasks: binning chunks of triangles, drawing parts of tiles, adding tiles to the mask.
//
// If there is but one tile, one thread draws into the target's mask itself, which needs neither to be cleared nor to be
// added to anything: alone, it is as fast as without threads. The others draw into masks of their own, and when the
// last part is drawn, all threads add these up, each another group of strips. Only to read: a mask's cache lines stay
// with its thread, which clears it when the draw is over.
//
// A bin is what one chunk puts into one tile: a copy of those of its triangles that reach the tile, in their order.
// Which do is found as bits, the way of Laine and Karras, "High-Performance Software Rasterization on GPUs" (2011): one
// bit for every column and every row of tiles that a triangle's bounding box reaches; a tile's triangles are the
// conjunction of its column's bits and its row's. Copies rather than indices, because whoever draws a tile would miss
// the cache with almost every triangle: when a chunk is binned, its triangles are at hand. The bins of a chunk are
// written by the one thread that bins it, in memory that only this chunk has, and only read after that.
#pragma once

#include <tbb/spin_mutex.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rasterizer/fast/fast.h"
#include "rasterizer/threads/agenda.h"
#include "rasterizer/threads/plan.h"

namespace edgecase::rasterizer {

class TiledDraw {
 public:
  using Triangle = FixedTriangle<Format16_8>;

  /// A chunk's bins.
  struct alignas(64) Bins {
    std::vector<std::uint64_t> reach;
    std::vector<std::uint32_t> begin;  ///< of each tile, and the last one's end
    std::vector<Triangle> triangles;   ///< and room for more
    std::atomic<bool> done{false};
  };
  /// What is worth keeping from one drawing to the next.
  struct Memory {
    struct alignas(64) Lock {
      tbb::spin_mutex mutex;
    };
    std::vector<std::unique_ptr<Bins>> bins;
    std::array<Lock, 64> locks;
  };

  /// A tile that a thread draws into, and triangles on their way there.
  class Canvas {
   public:
    /// `number`: another one for each thread, so that they do not add to the same words at the same time. Number 0
    /// stands for the target's mask if there is but one tile; it should be for the thread that begins first.
    explicit Canvas(std::size_t number) : number_(number) {}

    /// Clears its mask: done by its thread after a drawing, this saves it the time when the next one begins.
    void clear() { mask_.clear(); }

   private:
    friend class TiledDraw;
    std::size_t number_;
    int tile_ = -1;
    std::size_t drawn_ = 0;  ///< parts of a single tile, not counted yet
    TileMask mask_;
    /// Fewer than fill a vector, of the last bin.
    std::size_t waiting_ = 0;
    std::array<Triangle, kMaxLanes> triangles_;
  };

  /// The arguments must outlive it; `plan` is for these triangles and this mask's target.
  TiledDraw(const FastRasterizer& fast, std::span<const Triangle> triangles, const Plan& plan, StripMask& mask,
            Memory& memory);

  /// Does tasks until none is left for this thread. All of them are done when this has returned on every thread that
  /// called it, plan.threads of them or fewer, each with a canvas of its own.
  void work(Canvas& canvas);

  // The tasks, for those who want to time them, or do them in an order of their own.

  std::size_t chunks() const { return chunks_; }
  int tiles() const { return plan_.grid.count(); }

  /// Whether there are bins. A single tile needs none.
  bool binned() const { return tiles() > 1; }
  /// Each chunk is to be binned once, by any thread.
  void bin(std::size_t chunk);

  /// Draws a part of a tile, from the chunks of the plan's part of that number; waits for their bins. If `canvas` has
  /// another tile, that is finished first. Each part is to be drawn once, by any thread, each thread having a canvas of
  /// its own.
  void draw(const Part& part, Canvas& canvas);

  /// Adds what `canvas` has to the mask, and leaves it without a tile. If there is but one tile: waits until all of its
  /// parts are on canvases that are finished or about to be, and then helps to add every canvas to the mask.
  void finish(Canvas& canvas);

 private:
  /// Of chunks `chunk` to before `end`.
  std::span<const Triangle> triangles_of(std::size_t chunk, std::size_t end) const;
  void draw_bin(int tile, std::size_t chunk, Canvas& canvas) const;
  void draw_waiting(Canvas& canvas) const;
  void draw_in_order(std::span<const Triangle> triangles, Canvas& canvas) const;
  void draw_whole(std::span<const Triangle> triangles, Canvas& canvas);
  void add_canvases();
  bool in_place(const Canvas& canvas) const { return !binned() && canvas.number_ == 0; }

  const FastRasterizer& fast_;
  std::span<const Triangle> triangles_;
  const Plan& plan_;
  StripMask& mask_;
  std::size_t chunks_;
  Memory& memory_;
  Agenda agenda_;
  alignas(64) std::atomic<std::size_t> next_to_bin_{0};

  // Of a single tile: the canvases that are not in place and have been drawn into, and how many parts are drawn. A
  // canvas is noted before its parts count as drawn, which they do when its thread finds no other: each time that a
  // thread counts, it takes the cache line from another one.
  std::vector<Canvas*> apart_;
  std::atomic<std::size_t> apart_count_{0};
  alignas(64) std::atomic<std::size_t> drawn_{0};
  alignas(64) std::atomic<std::size_t> next_to_add_{0};
};

}  // namespace edgecase::rasterizer
