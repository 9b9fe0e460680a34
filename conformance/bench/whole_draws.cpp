#include "conformance/bench/whole_draws.h"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <chrono>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "conformance/bench/clock.h"
#include "conformance/bench/contenders.h"
#include "conformance/bench/timing.h"
#include "rasterizer/threads/threads.h"

namespace edgecase::conformance {
namespace {

using Triangles = std::span<const rasterizer::FixedTriangle<rasterizer::Format16_8>>;

/// Longer than threads wait for work.
constexpr std::chrono::duration<double, std::nano> kUntilAsleep{500'000};

double median(std::vector<double> values) { return statistics(std::move(values)).median; }

void wait_awake(double ns) {
  for (const double end = now() + ns; now() < end;) {
  }
}

/// ns that a thread takes for `draws` draws if `together` of them do the same: the mean of them.
double time_together(int together, const rasterizer::FastRasterizer& fast, Triangles triangles,
                     const rasterizer::Target& target, std::size_t draws) {
  std::vector<double> ns(static_cast<std::size_t>(together));
  std::barrier ready(together);
  {
    std::vector<std::jthread> threads;
    for (double& own_ns : ns) {
      threads.emplace_back([&] {
        const std::vector own(triangles.begin(), triangles.end());
        rasterizer::StripMask mask(target);
        const auto draw = [&] {
          for (std::size_t i = 0; i < draws; ++i) fast.cover_union(own, mask);
        };
        draw();
        ready.arrive_and_wait();
        own_ns = time_of(draw);
      });
    }
  }
  double sum = 0;
  for (const double own_ns : ns) sum += own_ns;
  return sum / together;
}

/// Half of what two threads take to answer each other.
double time_line() {
  constexpr int kBatches = 40, kRounds = 50, kPatience = 10'000;
  constexpr double kSpread = 10e6;  // until each has a processor to itself
  struct alignas(64) Line {
    std::atomic<int> said{0};
  } line;
  const auto wait_for = [&](int number) {
    // Where another program has the processor, the other thread gets to answer only if this one gives way.
    for (int i = 0; line.said.load(std::memory_order_acquire) != number; ++i) {
      if (i > kPatience) std::this_thread::yield();
    }
  };
  std::jthread other([&] {
    wait_awake(kSpread);
    for (int i = 0; i < kBatches * kRounds; ++i) {
      wait_for(2 * i + 1);
      line.said.store(2 * i + 2, std::memory_order_release);
    }
  });
  wait_awake(kSpread);
  std::vector<double> ns;
  for (int round = 0; round < kBatches * kRounds;) {
    ns.push_back(time_of([&] {
      for (const int end = round + kRounds; round < end; ++round) {
        line.said.store(2 * round + 1, std::memory_order_release);
        wait_for(2 * round + 2);
      }
    }));
  }
  return median(ns) / (2 * kRounds);
}

}  // namespace

WholeDraws time_whole_draws(int threads, const rasterizer::FastRasterizer& fast, Triangles triangles,
                            const rasterizer::Target& target, std::size_t repetitions) {
  rasterizer::ThreadedRasterizer threaded(fast, threads);
  rasterizer::StripMask mask(target);
  std::vector list(triangles.begin(), triangles.end());
  std::mt19937_64 random;
  const auto prepare = [&] {
    mask.clear();
    shuffle_if_short(list, random);
  };
  const auto time_draw = [&](std::vector<double>& times, const auto& draw) {
    prepare();
    times.push_back(time_of(draw));
  };
  // What follows is one of a stream of such draws: caches and clocks have settled after another kind, or a pause.
  const auto follow = [&](const auto& draw) {
    for (int i = 0; i < 2; ++i) prepare(), draw();
  };
  const auto draw_alone = [&] { fast.cover_union(list, mask); };
  const auto draw_threaded = [&] { threaded.cover_union(list, mask); };
  draw_alone();
  const double about = time_of(draw_alone);
  const auto more = static_cast<std::size_t>(std::clamp(5e6 / about, 1.0, 20.0));
  std::vector<double> one, awake, asleep, apart, line;
  for (std::size_t i = 0; i < repetitions * more; ++i) {
    // This one's processor stays awake.
    wait_awake(kUntilAsleep.count());
    time_draw(asleep, draw_threaded);
    follow(draw_threaded);
    time_draw(awake, draw_threaded);
    follow(draw_alone);
    time_draw(one, draw_alone);
  }
  // A thread's time is known to some ms while it works: so of many draws, before and after which helpers sleep.
  const auto cpu_of = [&](const auto& draw) {
    const auto count = static_cast<std::size_t>(5e6 / about + 1) * repetitions;
    std::this_thread::sleep_for(kUntilAsleep);
    return time_of(
        [&] {
          for (std::size_t i = 0; i < count; ++i) mask.clear(), draw();
          std::this_thread::sleep_for(kUntilAsleep);
        },
        CLOCK_PROCESS_CPUTIME_ID);
  };
  for (std::size_t i = 0; i < std::min<std::size_t>(repetitions, 5); ++i) {
    const double alone = time_together(1, fast, triangles, target, 2 * more);
    apart.push_back(threads * alone / time_together(threads, fast, triangles, target, 2 * more));
    line.push_back(time_line());
  }
  const double wall = median(one);
  // Of the line the least: what else runs can only delay it.
  return {wall / median(awake), wall / median(asleep), cpu_of(draw_threaded) / cpu_of(draw_alone), median(apart),
          *std::ranges::min_element(line)};
}

}  // namespace edgecase::conformance
