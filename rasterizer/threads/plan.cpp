#include "rasterizer/threads/plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rasterizer/edge.h"
#include "rasterizer/fast/strip_mask.h"

namespace edgecase::rasterizer {
namespace {

using Triangle = FixedTriangle<Format16_8>;

// Costs in ns, as measured on a Zen 4 core with AVX-512. Only their ratios decide, and a factor of two in one of them
// changes little: between the right plan and the next one the difference is small.
constexpr double kSetup = 6, kRow = 0.6, kPixel = 0.001;  // of drawing a triangle
constexpr double kBin = 2.6, kBinBound = 0.22;            // of binning one, and for each column and row of tiles
constexpr double kCopy = 1.5;                             // of a triangle in a bin
constexpr double kCutRows = 60;                           // of a cut between rows of a triangle, at most
constexpr double kCutColumns = 2;   // of one between its columns, in the work on the whole: it is then drawn clipped,
constexpr double kUnclipped = 64;   // unless it has no more rows and columns than this
constexpr double kMergeWord = 0.3;  // of a word of a tile's mask: clearing and adding it
constexpr double kStart = 5'000, kStartThread = 500;  // of having threads at all, and of each

/// What a cache line of a mask costs if the mask, of so many bytes, is drawn into anywhere.
double miss(double bytes) { return bytes <= (1 << 20) ? 0 : bytes <= (16 << 20) ? 4 : 20; }

/// A triangle's pixels on the target; it stands for `count` triangles.
struct Sample {
  int left, top, right, bottom;
  double count;
  double work;  ///< of one
  double columns() const { return right - left; }
  double rows() const { return bottom - top; }
  double lines() const { return (rows() / TileGrid::kRowUnit + 1) * (columns() / kStripWidth + 1); }
};

std::vector<Sample> sample(std::span<const Triangle> triangles, const Target& target) {
  // All of this is done before any thread starts: it must take a few us at most.
  constexpr std::size_t kSamples = 64;
  const std::size_t count = std::min(kSamples, triangles.size());
  std::vector<Sample> samples;
  samples.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& triangle = triangles[triangles.size() * i / count];
    const auto box = pixel_box<Format16_8>(triangle, View<>{target});
    if (!box) continue;
    Sample& s = samples.emplace_back();
    s = {box->left.value(), box->top.value(), box->right.value(), box->bottom.value(), 0, 0};
    s.count = static_cast<double>(triangles.size()) / static_cast<double>(count);
    const double area = std::abs(static_cast<double>(doubled_area<Format16_8>(triangle).value())) / (2 * 256 * 256);
    s.work = kSetup + kRow * s.rows() + kPixel * std::min(area, s.rows() * s.columns());
  }
  return samples;
}

struct Estimate {
  double one_thread;  ///< without tiles
  double total;       ///< of the tasks of all threads
  double least;       ///< which no grid can make less
};

Estimate estimate(std::span<const Sample> samples, std::size_t triangles, const TileGrid& grid, int threads) {
  const Tile tile = grid.tile(0);
  const double tiles = grid.count(), width = tile.width, height = tile.height;
  const double tile_words = height * ((width + kStripWidth - 1) / kStripWidth);
  const double miss_target = miss(tiles * tile_words * 4), miss_tile = miss(tile_words * 4);
  Estimate sum{0, std::max<double>(tiles + threads - 1, threads) * tile_words * kMergeWord, 0};
  if (tiles > 1) sum.total += static_cast<double>(triangles) * (kBin + kBinBound * (grid.columns() + grid.rows()));
  for (const Sample& s : samples) {
    // Cuts through a triangle that lies anywhere.
    const double row_cuts = std::min<double>(s.rows() / height, grid.rows() - 1);
    const double column_cuts = std::min<double>(s.columns() / width, grid.columns() - 1);
    const bool clipped = std::max(s.rows(), s.columns()) > kUnclipped;
    const double cuts = row_cuts * std::min(s.work, kCutRows) + column_cuts * s.work * (clipped ? kCutColumns : 1);
    const double copies = tiles > 1 ? (row_cuts + 1) * (column_cuts + 1) * kCopy : 0;
    sum.one_thread += s.count * (s.work + s.lines() * miss_target);
    sum.least += s.count * s.work;
    sum.total += s.count * (s.work + cuts + copies + s.lines() * miss_tile);
  }
  return sum;
}

/// The grid of the least estimate, and that.
std::pair<TileGrid, double> best_grid(std::span<const Sample> samples, std::size_t triangles, const Target& target,
                                      int threads) {
  constexpr int kMostTilesPerThread = 8;
  constexpr double kGoodEnough = 1.04;
  std::pair best(TileGrid(target, 1, 1), static_cast<double>(INFINITY));
  for (int rows = 1; rows <= TileGrid::kMostASide; rows *= 2) {
    for (int columns = 1; columns <= rows && rows * columns <= kMostTilesPerThread * threads; columns *= 2) {
      const TileGrid grid(target, columns, rows);
      const Estimate sum = estimate(samples, triangles, grid, threads);
      if (sum.total < best.second) best = {grid, sum.total};
      if (sum.total < kGoodEnough * sum.least) return best;
    }
  }
  return best;
}

int overlap(int a_begin, int a_end, int b_begin, int b_end) {
  return std::max(std::min(a_end, b_end) - std::max(a_begin, b_begin), 0);
}

std::vector<double> tile_work(std::span<const Sample> samples, const TileGrid& grid) {
  std::vector<double> work(static_cast<std::size_t>(grid.count()));
  const auto columns = static_cast<std::size_t>(grid.columns()), rows = static_cast<std::size_t>(grid.rows());
  for (const Sample& s : samples) {
    for (std::size_t row = 0; row < rows; ++row) {
      const int height = overlap(s.top, s.bottom, grid.rows_at()[row], grid.rows_at()[row + 1]);
      if (height == 0) continue;
      for (std::size_t column = 0; column < columns; ++column) {
        const int width = overlap(s.left, s.right, grid.columns_at()[column], grid.columns_at()[column + 1]);
        work[row * columns + column] += s.count * s.work * width * height / (s.columns() * s.rows());
      }
    }
  }
  return work;
}

Plan finish_plan(std::span<const Sample> samples, std::size_t triangles, const TileGrid& grid, int threads,
                 double total) {
  // The last of so many parts keeps the other threads waiting for 1/64 of the time on average. Chunks are parts if
  // there is one tile; else they are larger, so that a bin holds more than a few triangles.
  constexpr std::size_t kPartsPerThread = 32, kChunksPerThread = 8;
  constexpr std::size_t kMostInChunk = 4096;
  const auto tiles = static_cast<std::size_t>(grid.count()), all = static_cast<std::size_t>(threads);
  std::size_t chunk =
      std::clamp<std::size_t>(triangles / (all * (tiles == 1 ? kPartsPerThread : kChunksPerThread)), 1, kMostInChunk);
  // Whole vectors, or whole words of bits.
  const std::size_t unit = tiles == 1 ? kMaxLanes : kReachBlock;
  if (chunk > unit) chunk = chunk / unit * unit;
  const std::size_t chunks = std::max<std::size_t>((triangles + chunk - 1) / chunk, 1);
  const std::size_t parts = tiles == 1 ? chunks : std::clamp<std::size_t>(all * kPartsPerThread / tiles, 1, chunks);
  const Tile tile = grid.tile(0);
  const double tile_words = static_cast<double>(tile.height) * (tile.width + kStripWidth - 1) / kStripWidth;
  return {grid,
          threads,
          chunk,
          parts,
          tile_work(samples, grid),
          start_of_thread(threads - 1) + total / threads,
          2 * kMergeWord * tile_words};
}

}  // namespace

double start_of_thread(int thread) { return thread == 0 ? 0 : kStart + kStartThread * thread; }

Plan make_plan(std::span<const Triangle> triangles, const Target& target, int threads, int columns, int rows) {
  const std::vector<Sample> samples = sample(triangles, target);
  const TileGrid grid(target, columns, rows);
  return finish_plan(samples, triangles.size(), grid, threads,
                     estimate(samples, triangles.size(), grid, threads).total);
}

Plan make_plan(std::span<const Triangle> triangles, const Target& target, int threads) {
  const std::vector<Sample> samples = sample(triangles, target);
  const TileGrid whole(target, 1, 1);
  const double one_thread = estimate(samples, triangles.size(), whole, 1).one_thread;
  const Plan alone{whole, 1, std::max<std::size_t>(triangles.size(), 1), 1, {one_thread}, one_thread, 0};
  // A thread is worth it from this much work on: several times what it takes to start.
  constexpr double kLeastWork = 20'000;
  threads = static_cast<int>(std::min(static_cast<double>(threads), one_thread / kLeastWork));
  if (threads <= 1) return alone;
  const auto [grid, total] = best_grid(samples, triangles.size(), target, threads);
  Plan plan = finish_plan(samples, triangles.size(), grid, threads, total);
  // What is estimated to be saved must be more than what estimates are off by.
  constexpr double kMargin = 1.25;
  return plan.estimate * kMargin < one_thread ? plan : alone;
}

}  // namespace edgecase::rasterizer
