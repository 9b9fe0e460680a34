// Crew: threads of oneTBB's that a piece of work calls for help, does without if they do not come, and lets tidy up by
// themselves when it is done.
//
// A parallel loop ends when the last of its threads has returned. What a helper could do for the next piece of work,
// like clearing the memory that it alone draws into, would make the caller wait; and if the caller did it, each of
// those cache lines would have to find its way back. So helpers are tasks that nobody waits for, and the caller waits
// only for those that have begun, until they have done their part.
#pragma once

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace edgecase::rasterizer {

class Crew {
 public:
  using Work = std::function<void(std::size_t place)>;

  /// Up to `threads` threads, the caller's included, at least one. `tidy`: done by each helper after each piece of work
  /// that it had a part in, after that has ended and before it begins another one.
  Crew(int threads, Work tidy);
  /// Waits until all is tidy.
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  int threads() const { return arena_.max_concurrency(); }

  /// Has `work` done by the caller at place 0, and meanwhile by up to `threads` - 1 helpers, each at a place of its own
  /// from 1 to before threads(). A thread keeps its place, as a rule, from one call to the next. Returns when all that
  /// have begun have done. One call at a time. An exception ends the program: the others would wait for what it left
  /// undone.
  void run(int threads, const Work& work) noexcept;

 private:
  static constexpr std::uint64_t kInside = std::uint64_t{1} << 32;

  void help() noexcept;

  tbb::task_arena arena_;
  tbb::task_group tasks_;
  Work tidy_;
  // Of the open piece of work: written before it is opened, read by those who have joined it.
  const Work* work_ = nullptr;
  std::uint64_t number_ = 0;
  /// Places that are free, and above them, in kInside, how many helpers have joined and not left.
  alignas(64) std::atomic<std::uint64_t> open_{0};
  /// The last piece of work that has ended.
  alignas(64) std::atomic<std::uint64_t> ended_{0};
  /// Tasks that have been called and have not begun. They help with whatever is open then.
  alignas(64) std::atomic<int> called_{0};
};

}  // namespace edgecase::rasterizer
