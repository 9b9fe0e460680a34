#include "rasterizer/threads/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "rasterizer/fast/strip_mask.h"

namespace edgecase::rasterizer {
namespace {

using Triangle = FixedTriangle<Format16_8>;

// Costs in ns, as measured on a Zen 4 core with AVX-512. Only their ratios decide, and a factor of two in one of them
// changes little: between the right plan and the next one the difference is small.
constexpr double kSetup = 6, kRow = 0.6, kPixel = 0.001;  // of drawing a triangle
constexpr double kRowOfMedium = 0.25;                     // where it has at most kUnclipped rows and columns
constexpr double kBin = 2.6, kBinBound = 0.22;            // of binning one, and for each column and row of tiles
constexpr double kCopy = 1.5;                             // of a triangle in a bin
constexpr double kCutRows = 60;                           // of a cut between rows of a triangle, at most
constexpr double kCutColumns = 2;  // of one between its columns, in the work on the whole: it is then drawn clipped,
constexpr double kUnclipped = 64;  // unless it is medium: has no more rows and columns than this

// Threads that have slept: how long the call that wakes them takes, and when they are there. oneTBB's sleep if there
// was nothing to do for 0.1 to 0.2 ms. Before that, they begin within kStartThread.
constexpr double kWake = 8'000, kAsleep = 40'000, kStartThread = 500;

/// A thread is worth it from this much work on.
constexpr double kLeastWork = 25'000, kLeastToShare = 2 * kLeastWork;

/// What a cache line of a mask costs if the mask, of so many bytes, is drawn into anywhere.
double miss(double bytes) { return bytes <= (1 << 20) ? 0 : bytes <= (16 << 20) ? 4 : 20; }
/// Of adding a word of a mask to a target, in the time of all threads: half of the mask's cache lines and half of the
/// target's come from another processor, or from memory. 0.14 between processors that share a cache, more between
/// others.
constexpr double kMoveWord = 0.35;

/// A triangle's pixels on the target.
struct Sample {
  std::size_t number;  ///< among those looked at
  int left, top, right, bottom;
  double work;
  double columns() const { return right - left; }
  double rows() const { return bottom - top; }
  bool medium() const { return std::max(rows(), columns()) <= kUnclipped; }
  double lines() const { return (rows() / TileGrid::kRowUnit + 1) * (columns() / kStripWidth + 1); }
};

/// Some triangles of a list, equally far apart, and of how many each is one. Those that miss the target are left out.
struct Samples {
  static constexpr std::size_t kMost = 32;
  std::array<Sample, kMost> samples;
  std::size_t size = 0;
  std::size_t looked_at = 0;
  double each = 0;
  const Sample* begin() const { return samples.data(); }
  const Sample* end() const { return samples.data() + size; }
};

/// All of this is done before any thread starts, and for lists that one thread draws in less than a us: it neither
/// allocates nor uses the types that carry widths, which cost ten times the time without optimization across calls.
Samples sample(std::span<const Triangle> triangles, const Target& target, std::size_t most) {
  const std::size_t count = std::min(most, triangles.size());
  const int width = target.width().value(), height = target.height().value();
  // The first pixel whose centre is at or right of v, for vertices in units of 2^-8 px.
  const auto pixel = [](int v, int extent) { return std::clamp((v + 127) >> 8, 0, extent); };
  Samples list;
  list.looked_at = std::max<std::size_t>(count, 1);
  list.each = static_cast<double>(triangles.size()) / static_cast<double>(std::max<std::size_t>(count, 1));
  // Sample i is triangle triangles.size() * i / count, found without a division each.
  const std::size_t step = triangles.size() / list.looked_at, rest = triangles.size() % list.looked_at;
  std::size_t at = 0, over = 0;
  const auto move = [&] {
    over += rest;
    const bool carries = over >= count;
    over -= carries ? count : 0;
    at += step + (carries ? 1 : 0);
  };
  for (std::size_t i = 0; i < count; ++i, move()) {
    const auto& [a, b, c] = triangles[at];
    const int ax = a.x.value(), ay = a.y.value(), bx = b.x.value(), by = b.y.value(), cx = c.x.value(),
              cy = c.y.value();
    Sample s{i,
             pixel(std::min({ax, bx, cx}), width),
             pixel(std::min({ay, by, cy}), height),
             pixel(std::max({ax, bx, cx}), width),
             pixel(std::max({ay, by, cy}), height),
             0};
    if (s.left >= s.right || s.top >= s.bottom) continue;
    const double doubled_area =
        static_cast<double>(bx - ax) * static_cast<double>(cy - ay) - static_cast<double>(cx - ax) * (by - ay);
    const double area = std::abs(doubled_area) / (2 * 256 * 256);
    s.work = kSetup + (s.medium() ? kRowOfMedium : kRow) * s.rows() + kPixel * std::min(area, s.rows() * s.columns());
    list.samples[list.size++] = s;
  }
  return list;
}

double bytes_of(const Target& target) { return static_cast<double>(StripLayout(target).words()) * 4; }

double one_thread_time(const Samples& samples, const Target& target) {
  const double miss_target = miss(bytes_of(target));
  double sum = 0;
  for (const Sample& s : samples) sum += s.work + s.lines() * miss_target;
  return sum * samples.each;
}

/// Of a triangle.
double most_work(const Target& target) {
  const double width = target.width().value(), height = target.height().value();
  const Sample whole{0, 0, 0, target.width().value(), target.height().value(), 0};
  return kSetup + kRow * height + kPixel * width * height + whole.lines() * miss(bytes_of(target));
}

struct Estimate {
  double total;    ///< of the tasks of all threads
  double drawing;  ///< of the triangles, were none cut
  double least;    ///< which no grid can make less: drawing, and every pixel's word moved
};

double words_of(const Tile& tile) {
  return static_cast<double>(tile.height) * ((tile.width + kStripWidth - 1) / kStripWidth);
}

Estimate estimate(const Samples& samples, std::size_t triangles, const TileGrid& grid, int threads) {
  const Tile tile = grid.tile(0);
  const double tiles = grid.count(), tile_words = words_of(tile);
  const double miss_tile = miss(tile_words * 4);
  // One thread draws into the target if that is one tile; else every tile has a mask. The others have one more each.
  const double moved = (tiles > 1 ? tiles + threads - 1 : threads - 1) * tile_words;
  Estimate sum{moved * kMoveWord, 0, tiles * tile_words * kMoveWord};
  if (tiles > 1) sum.total += static_cast<double>(triangles) * (kBin + kBinBound * (grid.columns() + grid.rows()));
  const double per_height = 1.0 / tile.height, per_width = 1.0 / tile.width;
  double drawing = 0, rest = 0;
  for (const Sample& s : samples) {
    // Cuts through a triangle that lies anywhere.
    const double row_cuts = std::min<double>(s.rows() * per_height, grid.rows() - 1);
    const double column_cuts = std::min<double>(s.columns() * per_width, grid.columns() - 1);
    const bool clipped = !s.medium();
    const double cuts = row_cuts * std::min(s.work, kCutRows) + column_cuts * s.work * (clipped ? kCutColumns : 1);
    const double copies = tiles > 1 ? (row_cuts + 1) * (column_cuts + 1) * kCopy : 0;
    drawing += s.work;
    rest += cuts + copies + s.lines() * miss_tile;
  }
  sum.drawing = samples.each * drawing;
  sum.total += sum.drawing + samples.each * rest;
  sum.least += sum.drawing;
  return sum;
}

/// The grid of the least estimate, and that.
std::pair<TileGrid, Estimate> best_grid(const Samples& samples, std::size_t triangles, const Target& target,
                                        int threads) {
  constexpr int kMostTilesPerThread = 8;
  constexpr double kGoodEnough = 1.04;
  const TileGrid whole(target, 1, 1);
  std::pair best(whole, estimate(samples, triangles, whole, threads));
  for (int rows = 1; rows <= TileGrid::kMostASide; rows *= 2) {
    for (int columns = 1; columns <= rows && rows * columns <= kMostTilesPerThread * threads; columns *= 2) {
      if (best.second.total < kGoodEnough * best.second.least) return best;
      if (rows * columns == 1) continue;
      const TileGrid grid(target, columns, rows);
      const Estimate sum = estimate(samples, triangles, grid, threads);
      if (sum.total < best.second.total) best = {grid, sum};
    }
  }
  return best;
}

int overlap(int a_begin, int a_end, int b_begin, int b_end) {
  return std::max(std::min(a_end, b_end) - std::max(a_begin, b_begin), 0);
}

std::vector<double> tile_work(const Samples& samples, const TileGrid& grid) {
  std::vector<double> work(static_cast<std::size_t>(grid.count()));
  const auto columns = static_cast<std::size_t>(grid.columns()), rows = static_cast<std::size_t>(grid.rows());
  for (const Sample& s : samples) {
    for (std::size_t row = 0; row < rows; ++row) {
      const int height = overlap(s.top, s.bottom, grid.rows_at()[row], grid.rows_at()[row + 1]);
      if (height == 0) continue;
      for (std::size_t column = 0; column < columns; ++column) {
        const int width = overlap(s.left, s.right, grid.columns_at()[column], grid.columns_at()[column + 1]);
        work[row * columns + column] += samples.each * s.work * width * height / (s.columns() * s.rows());
      }
    }
  }
  return work;
}

/// When `threads` threads are done that wait for work, if `total` is shared out evenly.
double finish_time(double total, int threads) {
  for (int thread = 0; thread < threads; ++thread) total += start_awake(thread);
  return total / threads;
}

/// What is estimated to be saved must be more than what estimates are off by.
constexpr double kMargin = 1.15;
bool is_less(double estimate, double than) { return estimate * kMargin < than; }

/// What one thread must take at least for several to save time, each of the target's words being moved at least once:
/// (work + moved) / threads is less than the work.
double least_to_share(const Target& target, int threads) {
  const double moved = kMoveWord * bytes_of(target) / 4;
  return std::max(kLeastToShare, kMargin * moved / (threads - kMargin));
}

/// Triangles of a single tile's chunk, the least part of it: the last ones that two threads draw keep one of them
/// waiting for 1/256 of its time on average. Full vectors, if it is many.
std::size_t chunk_of_whole(std::size_t triangles, std::size_t threads) {
  constexpr std::size_t kChunksPerThread = 128;
  const std::size_t chunk = std::max<std::size_t>(triangles / (threads * kChunksPerThread), 1);
  return chunk < kMaxLanes ? chunk : chunk / kMaxLanes * kMaxLanes;
}

/// Of a single tile. Samples are evenly spread over the list, but for those that are nowhere on the target.
Parts parts_of_whole(const Samples& samples, std::size_t chunks, std::size_t threads) {
  // One triangle says little about those around it, and several tell a list sorted by size.
  const std::size_t samples_of_stretch = samples.each > 1 ? 4 : 1;
  std::array<double, Samples::kMost> work;
  const auto stretches = std::span(work).first((samples.looked_at + samples_of_stretch - 1) / samples_of_stretch);
  std::ranges::fill(stretches, kSetup);
  for (const Sample& s : samples) stretches[s.number / samples_of_stretch] += s.work;
  return Parts::falling(chunks, threads, stretches);
}

Plan finish_plan(const Samples& samples, std::size_t triangles, const TileGrid& grid, int threads,
                 const Estimate& estimate, double alone) {
  // In bins, so many chunks that a bin holds more than a few triangles, and parts so small that a thread that helps
  // with the last tile is kept waiting for 1/64 of its time on average.
  constexpr std::size_t kPartsPerThread = 32, kChunksPerThread = 8;
  constexpr std::size_t kMostInChunk = 4096;
  const auto tiles = static_cast<std::size_t>(grid.count()), all = static_cast<std::size_t>(threads);
  std::size_t chunk = std::max<std::size_t>(triangles / (all * kChunksPerThread), 1);
  if (tiles == 1) {
    chunk = chunk_of_whole(triangles, all);
  } else if (chunk > kReachBlock) {
    chunk = chunk / kReachBlock * kReachBlock;
  }
  chunk = std::min(chunk, kMostInChunk);
  const std::size_t chunks = std::max<std::size_t>((triangles + chunk - 1) / chunk, 1);
  const double tile_words = words_of(grid.tile(0));
  return {grid,
          threads,
          chunk,
          tiles == 1 ? parts_of_whole(samples, chunks, all)
                     : Parts::even(chunks, std::clamp<std::size_t>(all * kPartsPerThread / tiles, 1, chunks)),
          tiles == 1 ? std::vector{estimate.drawing} : tile_work(samples, grid),
          finish_time(estimate.total, threads),
          alone,
          2 * kMoveWord * tile_words};
}

}  // namespace

double start_awake(int thread) { return kStartThread * thread; }
double start_asleep(int thread) { return thread == 0 ? kWake : kAsleep + kStartThread * (thread - 1); }

double delay_by_waking(int threads) {
  double sum = 0;
  for (int thread = 0; thread < threads; ++thread) sum += start_asleep(thread) - start_awake(thread);
  return sum / threads;
}

bool pays_to_wake(const Plan& plan) { return is_less(plan.estimate + delay_by_waking(plan.threads), plan.alone); }

Plan make_plan(std::span<const Triangle> triangles, const Target& target, int threads, int columns, int rows) {
  const Samples samples = sample(triangles, target, Samples::kMost);
  const TileGrid grid(target, columns, rows);
  return finish_plan(samples, triangles.size(), grid, threads, estimate(samples, triangles.size(), grid, threads),
                     one_thread_time(samples, target));
}

bool may_pay(std::span<const Triangle> triangles, const Target& target, int threads) {
  // What is drawn in a us must not be planned for another one: only as many triangles are looked at as it takes.
  if (threads <= 1) return false;
  const double count = static_cast<double>(triangles.size()), least = least_to_share(target, threads);
  if (count * most_work(target) < least) return false;
  // Those looked at may be the smallest ones, the sooner the fewer they are.
  const std::size_t few = std::clamp<std::size_t>(triangles.size() / 32, 1, 4);
  return 4 * one_thread_time(sample(triangles, target, few), target) >= least &&
         2 * one_thread_time(sample(triangles, target, 16), target) >= least;
}

Plan make_plan(std::span<const Triangle> triangles, const Target& target, int threads) {
  const Samples samples = sample(triangles, target, Samples::kMost);
  const double one_thread = one_thread_time(samples, target);
  const TileGrid whole(target, 1, 1);
  const auto alone = [&] {
    return Plan{whole,      1, std::max<std::size_t>(triangles.size(), 1), Parts::even(1, 1), {one_thread}, one_thread,
                one_thread, 0};
  };
  threads = static_cast<int>(std::min(static_cast<double>(threads), one_thread / kLeastWork));
  if (threads <= 1 || one_thread < least_to_share(target, threads)) return alone();
  const auto [grid, sum] = best_grid(samples, triangles.size(), target, threads);
  Plan plan = finish_plan(samples, triangles.size(), grid, threads, sum, one_thread);
  return is_less(plan.estimate, one_thread) ? plan : alone();
}

}  // namespace edgecase::rasterizer
