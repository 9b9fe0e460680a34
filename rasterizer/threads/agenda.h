// Agenda: which part of which tile a thread draws next. The one policy that the threads follow and that its model,
// conformance/bench/scaling.h, plays through.
//
// A tile's parts are what ranges of the list put into it (parts.h), in order. A thread keeps its tile until its parts
// are taken; then it takes the tile with the most work that nobody has begun; and when all are begun it helps with the
// one of which the most work is left, in a mask of its own. So a tile is never shared while there is another, and
// nobody is idle as long as there is work left that is worth adding another mask to the tile: whatever the tiles' work,
// and even if there is but one.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "rasterizer/threads/parts.h"

namespace edgecase::rasterizer {

struct Part {
  int tile;
  std::size_t number;  ///< among those of the tile
  friend bool operator==(const Part&, const Part&) = default;
};

class Agenda {
 public:
  /// `work`: of each tile, in ns; `parts`: of each tile, outlive this; `least_help`: what must be left of it for
  /// another thread to join.
  Agenda(std::span<const double> work, const Parts& parts, double least_help)
      : work_(work.begin(), work.end()),
        parts_(parts),
        least_help_(least_help),
        order_(work.size()),
        taken_(work.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::ranges::stable_sort(order_, std::ranges::greater(), [&](int tile) { return work_[index(tile)]; });
  }

  /// Begins the tile with the most work, for a thread that will ask with it as its current one: whoever else wants it
  /// helps. Before any thread asks.
  int begin() { return order_[begun_.fetch_add(1, std::memory_order_relaxed)]; }

  /// The next part for a thread whose last part was of tile `current`, -1 for none. Any number of threads may ask, each
  /// until there is nothing left for it: who begins a tile answers for all of its parts being taken.
  std::optional<Part> next(int current) {
    if (current >= 0) {
      if (const auto part = take(current)) return part;
    }
    for (std::size_t i = begun_.fetch_add(1, std::memory_order_relaxed); i < order_.size();
         i = begun_.fetch_add(1, std::memory_order_relaxed)) {
      if (const auto part = take(order_[i])) return part;
    }
    while (const auto tile = most_left()) {
      if (const auto part = take(*tile)) return part;
    }
    return std::nullopt;
  }

 private:
  struct alignas(64) Taken {
    std::atomic<std::size_t> parts{0};
  };
  static std::size_t index(int tile) { return static_cast<std::size_t>(tile); }

  std::optional<Part> take(int tile) {
    // Without a look at whether there is one: that would fetch the cache line twice.
    const std::size_t number = taken_[index(tile)].parts.fetch_add(1, std::memory_order_relaxed);
    if (number >= parts_.count()) return std::nullopt;
    return Part{tile, number};
  }

  std::optional<int> most_left() const {
    std::optional<int> best;
    double most = least_help_;
    for (const int tile : order_) {
      const std::size_t taken = taken_[index(tile)].parts.load(std::memory_order_relaxed);
      if (taken >= parts_.count()) continue;
      const double left = work_[index(tile)] * (1 - parts_.work_before(taken));
      if (left > most) most = left, best = tile;
    }
    return best;
  }

  std::vector<double> work_;
  const Parts& parts_;
  double least_help_;
  std::vector<int> order_;
  std::vector<Taken> taken_;
  alignas(64) std::atomic<std::size_t> begun_{0};
};

}  // namespace edgecase::rasterizer
