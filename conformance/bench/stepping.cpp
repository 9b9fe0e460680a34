#include <algorithm>

#include "conformance/bench/instructions.h"

#if defined(__x86_64__) && defined(__linux__)

#include <signal.h>
#include <ucontext.h>
#include <x86intrin.h>

namespace edgecase::conformance {
namespace {

constexpr unsigned long long kTrapFlag = 1 << 8;

volatile std::uint64_t steps;
volatile std::uint64_t most_steps;

void on_step(int, siginfo_t*, void* context) {
  const std::uint64_t so_far = steps + 1;
  steps = so_far;
  if (so_far >= most_steps) {
    static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_EFL] &= ~static_cast<greg_t>(kTrapFlag);
  }
}

std::uint64_t steps_of(const std::function<void()>& work, std::uint64_t most) {
  steps = 0;
  most_steps = most;
  // Not by hand: what is pushed must not lie in the part of the stack below its end that a function may use.
  __writeeflags(__readeflags() | kTrapFlag);
  work();
  __writeeflags(__readeflags() & ~kTrapFlag);
  return steps;
}

}  // namespace

std::optional<std::uint64_t> step_through(const std::function<void()>& work, std::uint64_t most) {
  struct sigaction action {
  }, before{};
  action.sa_sigaction = on_step;
  action.sa_flags = SA_SIGINFO;
  if (sigaction(SIGTRAP, &action, &before) != 0) {
    work();
    return std::nullopt;
  }
  // A call of nothing is some dozen instructions.
  constexpr std::uint64_t kMostOfACall = 1000;
  const std::uint64_t call = steps_of([] {}, kMostOfACall);
  const std::uint64_t all = steps_of(work, most + call + 1);
  sigaction(SIGTRAP, &before, nullptr);
  // None at all: something between the processor and this program has no trap flag, as valgrind.
  if (call == 0 || all > most + call) return std::nullopt;
  return all - std::min(call, all);
}

}  // namespace edgecase::conformance

#else

namespace edgecase::conformance {

std::optional<std::uint64_t> step_through(const std::function<void()>& work, std::uint64_t) {
  work();
  return std::nullopt;
}

}  // namespace edgecase::conformance

#endif
