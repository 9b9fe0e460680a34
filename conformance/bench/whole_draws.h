// Whole draws by several threads, timed where there are as many processors.
#pragma once

#include <cstddef>
#include <span>

#include "rasterizer/fast/fast.h"

namespace edgecase::conformance {

/// Speed-ups, each as a ratio of medians, and what they depend on.
struct WholeDraws {
  double awake;   ///< one of a stream of such draws, when threads still wait for work
  double asleep;  ///< half a ms later, when they sleep
  double cpu;     ///< CPU time of all threads, in that of one thread's draw
  /// How many times as much is drawn if every thread draws the whole list, into a mask of its own: what threads that
  /// share nothing but the machine can reach.
  double apart;
  /// ns, not a ratio: a cache line's way from one processor to another. Some 50 within a group of processors that share
  /// a cache, some 200 or more between two; a host may move a virtual machine's processors from one to the other.
  double line_ns;
};

/// `threads`: at least two. Of more than `repetitions` draws, where a draw takes less than some ms.
WholeDraws time_whole_draws(int threads, const rasterizer::FastRasterizer& fast,
                            std::span<const rasterizer::FixedTriangle<rasterizer::Format16_8>> triangles,
                            const rasterizer::Target& target, std::size_t repetitions);

}  // namespace edgecase::conformance
