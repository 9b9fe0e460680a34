// Parts: how the chunks of a list are divided among threads that come for more whenever they are done.
//
// Every part costs its thread a cache line that others write to as well, as much as drawing a few triangles. Parts of
// the same size, small enough that waiting for the last one costs little, are many. So the sizes fall, by factoring
// (Hummel, Schonberg and Flynn, "Factoring: A Method for Scheduling Parallel Loops", 1992): a batch of one part for
// each thread takes half of what is left, until parts are single chunks.
//
// Sizes are of estimated work, not of chunks: lists sorted by size are common, and the first part of equal ones would
// be most of them.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace edgecase::rasterizer {

class Parts {
 public:
  /// `count` parts of as many chunks, as far as possible; at least one of each.
  static Parts even(std::size_t chunks, std::size_t count) { return Parts(chunks, 1, 0, count, {}); }

  /// Parts of falling work for so many threads. `work`: of as many equally long stretches of the list, in any unit,
  /// each at least 0 and not all 0.
  static Parts falling(std::size_t chunks, std::size_t threads, std::span<const double> work);

  std::size_t chunks() const { return chunks_; }
  /// Some may be without a chunk.
  std::size_t count() const { return batches_ * threads_ + last_; }

  /// Part `part` is chunks begin(part) to before begin(part + 1); part <= count().
  std::size_t begin(std::size_t part) const;

  /// How much of all work comes before that part.
  double work_before(std::size_t part) const {
    assert(part <= count());
    const std::size_t batch = part < batches_ * threads_ ? part / threads_ : batches_;
    const double left = 1 / static_cast<double>(std::size_t{1} << batch);
    const auto of_batch = static_cast<double>(part - batch * threads_);
    return 1 - left + left * of_batch / static_cast<double>(batch < batches_ ? 2 * threads_ : last_);
  }

 private:
  Parts(std::size_t chunks, std::size_t threads, std::size_t batches, std::size_t last, std::vector<double> work_until)
      : chunks_(chunks), threads_(threads), batches_(batches), last_(last), work_until_(std::move(work_until)) {
    assert(chunks >= 1 && threads >= 1 && last >= 1);
  }

  std::size_t chunks_;
  std::size_t threads_;
  std::size_t batches_;  ///< of threads_ parts, each half of what is left
  std::size_t last_;     ///< parts of equal work in the end
  /// The share of all work until each stretch's end; empty if it is everywhere the same.
  std::vector<double> work_until_;
};

}  // namespace edgecase::rasterizer
