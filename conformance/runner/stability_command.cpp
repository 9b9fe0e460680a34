#include <fmt/format.h>

#include <cstdio>

#include "conformance/bench/plot.h"
#include "conformance/compare/atomic_file.h"
#include "conformance/runner/commands.h"
#include "conformance/runner/progress.h"
#include "conformance/runner/stability.h"

namespace edgecase::conformance {

int stability_command(const StabilityOptions& options) {
  const auto subjects = stability_subjects();
  tl::expected<Stability, Error> found;
  {
    Progress progress(subjects.size() * families().size() * options.count);
    found = measure_stability(subjects, options.seed, options.count, [&](std::uint64_t n) { progress.add(n); });
  }
  if (!found) return fail(found.error());
  if (!options.json.empty()) {
    const auto written = write_file_atomically(options.json, stability_json(*found, options.seed));
    if (!written) return fail(written.error());
  }
  if (!options.plot.empty()) {
    if (auto drawn = run_gnuplot(stability_plot(*found, options.plot), options.plot); !drawn)
      return fail(drawn.error());
  }
  fmt::print("{}", stability_text(*found));
  if (std::fflush(stdout) != 0) return fail({ErrorKind::bad_input, "standard output: no space left or closed"});
  return kAsExpected;
}

}  // namespace edgecase::conformance
