#include "conformance/bench/instructions.h"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace edgecase::conformance {
namespace {

/// A file descriptor, or negative.
int open_counter() {
  perf_event_attr attributes{};
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.size = sizeof(attributes);
  attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
  attributes.disabled = 1;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  constexpr int kThisThread = 0, kAnyProcessor = -1, kNoGroup = -1;
  return static_cast<int>(
      syscall(SYS_perf_event_open, &attributes, kThisThread, kAnyProcessor, kNoGroup, PERF_FLAG_FD_CLOEXEC));
}

}  // namespace

std::optional<std::uint64_t> count_instructions(const std::function<void()>& work) {
  const int counter = open_counter();
  if (counter < 0) {
    work();
    return std::nullopt;
  }
  ioctl(counter, PERF_EVENT_IOC_ENABLE, 0);
  work();
  ioctl(counter, PERF_EVENT_IOC_DISABLE, 0);
  std::uint64_t count = 0;
  const bool complete = read(counter, &count, sizeof(count)) == static_cast<ssize_t>(sizeof(count));
  close(counter);
  // A counter that never got onto the processor reads 0.
  if (!complete || count == 0) return std::nullopt;
  return count;
}

bool has_instruction_counter() {
  static const bool has = count_instructions([] {}).has_value();
  return has;
}

}  // namespace edgecase::conformance
