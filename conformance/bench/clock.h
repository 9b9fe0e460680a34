// ns of a clock, and of what is done between two of its readings.
#pragma once

#include <time.h>

namespace edgecase::conformance {

inline double now(clockid_t clock = CLOCK_MONOTONIC) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) * 1e9 + static_cast<double>(time.tv_nsec);
}

template <class Act>
double time_of(const Act& act, clockid_t clock = CLOCK_MONOTONIC) {
  const double begin = now(clock);
  act();
  return now(clock) - begin;
}

}  // namespace edgecase::conformance
