#include "conformance/bench/instructions.h"

#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <memory>
#include <utility>
#include <vector>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

#include "conformance/bench/contenders.h"
#include "conformance/bench/measure.h"
#include "conformance/bench/workloads.h"

namespace edgecase::conformance {
namespace {

TEST(Instructions, AreCountedWhereTheMachineDoes) {
  volatile int sum = 0;
  const auto loop = [&](int times) {
    return [&sum, times] {
      for (int i = 0; i < times; ++i) sum = sum + 1;
    };
  };
  const auto few = count_instructions(loop(1'000)), many = count_instructions(loop(1'000'000));
  EXPECT_EQ(sum, 1'001'000);
  ASSERT_EQ(few.has_value(), many.has_value());
  if (few) {
    EXPECT_GT(*many, 100 * *few);
  }
}

#if defined(__x86_64__) && defined(__linux__)
volatile std::sig_atomic_t trapped;

/// Whether the processor and the system trap a single instruction: no emulator is between.
bool can_step() {
  constexpr unsigned long long kTrapFlag = 1 << 8;
  const auto before = std::signal(SIGTRAP, [](int) { trapped = 1; });
  trapped = 0;
  __writeeflags(__readeflags() | kTrapFlag);
  __writeeflags(__readeflags() & ~kTrapFlag);
  std::signal(SIGTRAP, before);
  return trapped != 0;
}
#else
bool can_step() { return false; }
#endif

/// Two instructions `times` times.
void countdown(std::uint64_t times) {
#if defined(__x86_64__)
  asm volatile("1: dec %0\n jnz 1b" : "+r"(times)::"cc");
#endif
}

TEST(Instructions, AreCountedToTheLastOneByOne) {
  const auto steps_of = [](std::uint64_t times, std::uint64_t most) {
    bool ran = false;
    const auto steps = step_through(
        [&] {
          countdown(times);
          ran = true;
        },
        most);
    EXPECT_TRUE(ran);
    return steps;
  };
  const auto few = steps_of(100, 10'000), many = steps_of(2'100, 10'000);
  ASSERT_EQ(few.has_value(), can_step());
  ASSERT_EQ(many.has_value(), few.has_value());
  if (!few) GTEST_SKIP() << "not on this processor, not on this system, or under an emulator";
  EXPECT_EQ(*many - *few, 2 * 2'000u);
  EXPECT_GE(*few, 200u);
  EXPECT_LE(*few, 300u);
  EXPECT_EQ(steps_of(2'100, 10'000), many);
  // As many as allowed, and one more.
  EXPECT_EQ(steps_of(2'100, *many), many);
  EXPECT_FALSE(steps_of(2'100, *many - 1));
  EXPECT_EQ(steps_of(2'100, 10'000), many);
}

TEST(Instructions, OfADrawAreTheSameWhenAskedForTwice) {
  std::vector<std::unique_ptr<Contender>> contenders;
  for (auto& contender : built_in_contenders()) {
    if (contender->name() == "plain" || contender->name() == "edgecase") contenders.push_back(std::move(contender));
  }
  Effort effort = kQuick;
  effort.steps = 30'000;  // enough for one triangle of a sanitizer's plain loop
  const auto count = [&](const char* workload) {
    const auto rows = measure(*find_workload(workload), contenders, effort, 1);
    EXPECT_TRUE(rows);
    EXPECT_EQ(rows->back().wrong_per_million, 0);
    return std::array{rows->front().instructions_per_triangle, rows->back().instructions_per_triangle};
  };
  const auto [plain, fast] = count("med200");
  if (!fast) GTEST_SKIP() << "neither counted by the machine nor one by one";
  ASSERT_TRUE(plain);
  EXPECT_GT(*plain, 2 * *fast);
  EXPECT_GT(*fast, 40);
  if (has_instruction_counter()) return;
  EXPECT_EQ(count("med200")[1], fast);
  // A million pixels, one after the other.
  EXPECT_FALSE(count("full")[0]);
  effort.steps = 0;
  EXPECT_FALSE(count("med200")[1]);
}

}  // namespace
}  // namespace edgecase::conformance
