// Plan: into how many tiles, chunks of triangles and threads a drawing is cut, from what each way is estimated to cost.
//
// One tile needs no bins: the first thread draws its share of the triangles in place, each other one into a mask of its
// own, and these are added up. That costs a mask's worth of memory traffic for each of them. Tiles cost less of it, and
// their masks stay in the caches, but binning reads and copies every triangle once more, and triangles on a tile's
// border are drawn in both. So a screen's mask and few threads want one tile; large targets and many threads want more,
// but no more than needed, because threads help each other with a tile (agenda.h).
//
// Rows of tiles before columns: a triangle's rows are what drawing it goes by, so that a cut between rows adds only the
// setup, while one between columns also makes both sides clip.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "rasterizer/fast/tile_grid.h"
#include "rasterizer/format.h"
#include "rasterizer/threads/parts.h"

namespace edgecase::rasterizer {

struct Plan {
  TileGrid grid;
  /// At least one; if one, the other fields do not matter.
  int threads;
  /// Triangles of a chunk, at least one.
  std::size_t chunk;
  /// Of the chunks: what is drawn of a tile at once. Of falling work if there is but one tile. In a grid that has
  /// several, threads are done with one tile after the other, and share only the last ones: there they are even.
  Parts parts;
  /// Estimated ns of drawing each tile.
  std::vector<double> tile_work;
  /// Estimated ns of the whole on these threads, none of which sleeps, and on one.
  double estimate;
  double alone;
  /// ns that must be left of a tile for another thread to join: twice what its mask costs to clear and to add.
  double least_help;
};

/// ns from the call until thread `thread` of several works, 0 being the caller's own: as measured on two processors,
/// assumed for more. First where threads are still waiting for work, as they do for 0.1 to 0.2 ms after a draw that
/// they had a part in; then where they sleep, and the caller has to wake them.
double start_awake(int thread);
double start_asleep(int thread);
/// ns by which a draw by so many threads ends later if they sleep.
double delay_by_waking(int threads);

/// The plan with `columns` by `rows` tiles for exactly `threads` threads.
Plan make_plan(std::span<const FixedTriangle<Format16_8>> triangles, const Target& target, int threads, int columns,
               int rows);

/// Whether `threads` threads may save time, as far as can be told at little cost beside that of drawing the list.
bool may_pay(std::span<const FixedTriangle<Format16_8>> triangles, const Target& target, int threads);

/// The plan that is estimated to be done first with up to `threads` threads, none of which sleeps: one thread's, where
/// more save too little.
Plan make_plan(std::span<const FixedTriangle<Format16_8>> triangles, const Target& target, int threads);

/// Whether threads that sleep are worth waking for a plan of several, by themselves.
bool pays_to_wake(const Plan& plan);

}  // namespace edgecase::rasterizer
