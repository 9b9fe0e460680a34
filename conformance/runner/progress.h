// A progress bar on standard error, for a person; silent if standard error is no terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace edgecase::conformance {

class Progress {
 public:
  /// `total` triangles are to come.
  explicit Progress(std::uint64_t total);
  /// Wipes the bar away.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Not to be called from two threads at once.
  void add(std::uint64_t triangles);

 private:
  using Clock = std::chrono::steady_clock;
  const bool shown_;
  const std::uint64_t total_;
  std::uint64_t done_ = 0;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_ = start_;
};

/// The bar's text, without colours or line end: share done, rate, and time left, which is unknown at first.
std::string progress_line(std::uint64_t done, std::uint64_t total, double seconds);

}  // namespace edgecase::conformance
