// Waking: whether a draw that several threads save time on is worth waking them for.
#pragma once

#include <chrono>

#include "rasterizer/threads/plan.h"

namespace edgecase::rasterizer {

/// A draw that saves more than waking costs is worth it by itself. Of draws that follow each other so soon that
/// threads, once awake, stay so, the first ones are drawn by one thread; the one after which they would have saved
/// kPatience times the cost of waking wakes them. So a list is never drawn slower by much because of what was expected
/// to follow.
class Waking {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Whether a draw that begins at `now` is shared. Its plan is for several threads.
  bool shares(const Plan& plan, Time now) {
    const bool soon = now - last_end_ < kStillAwake;
    if (soon && shared_) return true;
    if (!soon) missed_ = 0;
    if (pays_to_wake(plan) || missed_ >= kPatience * delay_by_waking(plan.threads)) return true;
    missed_ += plan.alone - plan.estimate;
    return false;
  }

  /// The draw is done, and was shared or not.
  void end(bool shared, Time now) {
    if (shared) missed_ = 0;
    shared_ = shared;
    last_end_ = now;
  }

 private:
  static constexpr std::chrono::microseconds kStillAwake{100};
  static constexpr double kPatience = 4;

  Time last_end_{};
  bool shared_ = false;
  double missed_ = 0;  ///< ns that draws would have saved, one soon after the other, had threads been awake
};

}  // namespace edgecase::rasterizer
