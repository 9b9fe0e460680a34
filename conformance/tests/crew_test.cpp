#include "rasterizer/threads/crew.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

namespace edgecase::rasterizer {
namespace {

using namespace std::chrono_literals;

/// More threads than a small machine has processors: oneTBB would stop there.
const tbb::global_control kManyThreads(tbb::global_control::max_allowed_parallelism, 16);

constexpr auto kLong = 10s;

/// Whether `condition` comes true within kLong.
template <class Condition>
bool comes(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + kLong;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(Crew, EachThreadHasAPlaceOfItsOwn) {
  Crew crew(4, [](std::size_t) {});
  ASSERT_EQ(crew.threads(), 4);
  const auto caller = std::this_thread::get_id();
  std::array<std::atomic<int>, 4> at{};
  std::atomic<int> threads{0};
  crew.run(4, [&](std::size_t place) {
    ASSERT_LT(place, at.size());
    EXPECT_EQ(place == 0, std::this_thread::get_id() == caller);
    ++at[place];
    ++threads;
    EXPECT_TRUE(comes([&] { return threads == 4; }));
  });
  for (const auto& count : at) EXPECT_EQ(count, 1);
}

TEST(Crew, NoMoreThreadsComeThanAreAskedFor) {
  Crew crew(8, [](std::size_t) {});
  for (const int threads : {1, 2, 3}) {
    // Tasks that this leaves behind come for the next piece of work.
    crew.run(8, [](std::size_t) {});
    std::atomic<int> came{0};
    crew.run(threads, [&](std::size_t place) {
      ++came;
      // Long enough for others to come, too.
      if (place == 0) std::this_thread::sleep_for(5ms);
    });
    EXPECT_LE(came, threads);
  }
}

TEST(Crew, TheCallerWaitsForThoseWhoHaveBegun) {
  Crew crew(2, [](std::size_t) {});
  std::atomic<bool> begun{false}, done{false};
  crew.run(2, [&](std::size_t place) {
    if (place == 0) {
      EXPECT_TRUE(comes([&] { return begun.load(); }));
      return;
    }
    begun = true;
    std::this_thread::sleep_for(20ms);
    done = true;
  });
  EXPECT_TRUE(done);
}

/// What a helper sees is its caller's, however late it comes, and no helper is at work when the call has returned.
TEST(Crew, NobodyIsLateForTheNextPieceOfWork) {
  std::array<std::atomic<int>, 4> untidied{};
  std::atomic<int> tidied{0};
  int helped = 0;
  {
    Crew crew(4, [&](std::size_t place) {
      --untidied[place];
      ++tidied;
    });
    for (int i = 0; i < 20'000; ++i) {
      std::atomic<int> inside{0}, came{0};
      const int threads = i % 4 + 1;
      crew.run(threads, [&](std::size_t place) {
        ++inside;
        ++came;
        if (place > 0) {
          // It has tidied up after its last piece of work.
          EXPECT_EQ(untidied[place]++, 0);
        } else {
          for (int spin = 0; spin < i % 50; ++spin) std::this_thread::yield();
        }
        --inside;
      });
      ASSERT_EQ(inside, 0) << i;
      ASSERT_LE(came, threads) << i;
      helped += came - 1;
    }
  }
  EXPECT_EQ(tidied, helped);
  EXPECT_GT(helped, 0);
}

TEST(Crew, TidiesUpWhenTheWorkIsOverAndKeepsNoCallerWaiting) {
  std::atomic<bool> over{false}, tidy{false};
  std::atomic<bool> go_on{false};
  {
    Crew crew(2, [&](std::size_t) {
      EXPECT_TRUE(over);
      EXPECT_TRUE(comes([&] { return go_on.load(); }));
      tidy = true;
    });
    std::atomic<bool> came{false};
    crew.run(2, [&](std::size_t place) {
      if (place > 0) {
        came = true;
        return;
      }
      EXPECT_TRUE(comes([&] { return came.load(); }));
      std::this_thread::sleep_for(10ms);
      over = true;
    });
    EXPECT_FALSE(tidy);
    // The only helper has not done yet, so the caller is alone.
    std::atomic<int> alone{0};
    crew.run(2, [&](std::size_t) { ++alone; });
    EXPECT_EQ(alone, 1);
    EXPECT_FALSE(tidy);
    go_on = true;
  }
  EXPECT_TRUE(tidy);
}

}  // namespace
}  // namespace edgecase::rasterizer
