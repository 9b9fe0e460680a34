// A progress bar with the time left.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>

namespace edgecase::conformance {

/// On standard error, if a person is watching it. `noun` is what the steps are.
class Progress {
 public:
  Progress(std::size_t steps, std::string_view noun) : steps_(steps), noun_(noun), shown_(isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Before step number `done`, counted from 0.
  void show(std::size_t done, std::string_view what) const {
    if (!shown_) return;
    constexpr std::size_t kWidth = 30;
    const std::size_t filled = kWidth * done / steps_;
    std::string left;
    if (done > 0) {
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
      const double rest = passed.count() / static_cast<double>(done) * static_cast<double>(steps_ - done);
      left = fmt::format(", {:.0f} s left", rest);
    }
    fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {} of {} {}{}: {}", "", filled, "", kWidth - filled, done, steps_,
               noun_, left, what);
    std::fflush(stderr);
  }

 private:
  std::size_t steps_;
  std::string_view noun_;
  bool shown_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace edgecase::conformance
