#include "rasterizer/threads/crew.h"

#include <cassert>
#include <utility>

#include "rasterizer/threads/wait.h"

namespace edgecase::rasterizer {

Crew::Crew(int threads, Work tidy) : arena_(threads), tidy_(std::move(tidy)) { assert(threads >= 1); }

Crew::~Crew() {
  arena_.execute([&] { tasks_.wait(); });
}

void Crew::run(int threads, const Work& work) noexcept {
  assert(threads >= 1 && threads <= this->threads());
  work_ = &work;
  ++number_;
  // Either a task that is about to begin finds this open, or it is seen here not to be waiting any more.
  open_.store(static_cast<std::uint64_t>(threads) - 1);
  for (int called = called_.load(); called < threads - 1; ++called) {
    called_.fetch_add(1);
    arena_.enqueue(tasks_.defer([this] { help(); }));
  }
  work(0);
  // Closed: no place is free.
  open_.fetch_and(~(kInside - 1));
  wait_until([&] { return open_.load() == 0; });
  ended_.store(number_, std::memory_order_release);
}

void Crew::help() noexcept {
  called_.fetch_sub(1);
  std::uint64_t open = open_.load();
  do {
    if (open % kInside == 0) return;
  } while (!open_.compare_exchange_weak(open, open - 1 + kInside));
  const std::uint64_t number = number_;
  const auto place = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
  (*work_)(place);
  open_.fetch_sub(kInside);
  wait_until([&] { return ended_.load(std::memory_order_acquire) >= number; });
  tidy_(place);
}

}  // namespace edgecase::rasterizer
