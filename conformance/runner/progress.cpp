#include "conformance/runner/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace edgecase::conformance {

Progress::Progress(std::uint64_t total) : shown_(isatty(STDERR_FILENO) == 1), total_(total) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::add(std::uint64_t triangles) {
  done_ += triangles;
  const auto now = Clock::now();
  if (!shown_ || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  fmt::print(stderr, "\r\x1b[K{}", progress_line(done_, total_, std::chrono::duration<double>(now - start_).count()));
  std::fflush(stderr);
}

std::string progress_line(std::uint64_t done, std::uint64_t total, double seconds) {
  constexpr int width = 30;
  const double share = total == 0 ? 1 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const int filled = static_cast<int>(share * width);
  const double rate = seconds > 0 ? static_cast<double>(done) / seconds : 0;
  std::string line = fmt::format("[{:#<{}}{:.<{}}] {:3.0f} %", "", filled, "", width - filled, share * 100);
  if (rate > 0) {
    const double left = static_cast<double>(total - std::min(done, total)) / rate;
    line += fmt::format("  {:.0f} triangles/s  {:.0f} s left", rate, left);
  }
  return line;
}

}  // namespace edgecase::conformance
