// Waiting for what another thread is about to do.
#pragma once

#include <thread>

namespace edgecase::rasterizer {

/// Returns when `condition` is true. It is expected to come true within a us or so, but the other thread may have lost
/// its processor, perhaps to this one: so the processor is given away after about a us, and not at once, as that takes
/// a third of one.
template <class Condition>
void wait_until(const Condition& condition) {
  constexpr int kPatience = 1000;
  for (int i = 0; !condition(); ++i) {
    if (i >= kPatience) std::this_thread::yield();
  }
}

}  // namespace edgecase::rasterizer
