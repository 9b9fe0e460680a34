#include "rasterizer/threads/crew.h"

#include <cassert>
#include <utility>

#include "rasterizer/threads/wait.h"

namespace edgecase::rasterizer {

Crew::Crew(int threads, Work tidy) : shared_(std::make_shared<Shared>()), arena_(threads) {
  assert(threads >= 1);
  shared_->tidy = std::move(tidy);
}

void Crew::run(int threads, const Work& work) {
  assert(threads >= 1 && threads <= this->threads());
  Shared& shared = *shared_;
  shared.work = &work;
  ++shared.number;
  // Either a task that is about to begin finds this open, or it is seen here not to be waiting any more.
  shared.open.store(static_cast<std::uint64_t>(threads) - 1);
  for (int called = shared.called.load(); called < threads - 1; ++called) {
    shared.called.fetch_add(1);
    arena_.enqueue([shared = shared_] { help(*shared); });
  }
  work(0);
  // Closed: no place is free.
  shared.open.fetch_and(~(kInside - 1));
  wait_until([&] { return shared.open.load() == 0; });
  shared.ended.store(shared.number, std::memory_order_release);
}

void Crew::help(Shared& shared) {
  shared.called.fetch_sub(1);
  std::uint64_t open = shared.open.load();
  do {
    if (open % kInside == 0) return;
  } while (!shared.open.compare_exchange_weak(open, open - 1 + kInside));
  const std::uint64_t number = shared.number;
  const auto place = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
  (*shared.work)(place);
  shared.open.fetch_sub(kInside);
  wait_until([&] { return shared.ended.load(std::memory_order_acquire) >= number; });
  shared.tidy(place);
}

}  // namespace edgecase::rasterizer
