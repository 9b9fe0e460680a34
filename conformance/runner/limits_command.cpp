#include <fmt/format.h>

#include <cstdio>

#include "conformance/runner/commands.h"
#include "conformance/runner/extent_sweep.h"
#include "conformance/runner/run.h"

namespace edgecase::conformance {
namespace {

// At each of the some 25 extents that a bisection tries.
constexpr std::size_t kTriangles = 2000;

}  // namespace

int limits_command(const DataFiles& data, const LimitsOptions& options) {
  const auto known = load_known_deviations(data.known_deviations);
  if (!known) return fail(known.error());
  int status = kAsExpected;
  for (const std::string& name : options.subjects.empty() ? default_subjects() : options.subjects) {
    auto subject = make_subject(name);
    if (!subject) return fail(subject.error());
    const std::string device = (*subject)->info().device;
    auto reference = reference_for(name);
    if (!reference) return fail(reference.error());
    const auto limit = find_limit(**subject, (*subject)->info().rules, *reference,
                                  find_known_deviation(*known, name, device), options.seed, kTriangles);
    if (!limit) {
      status = fail(limit.error());
      continue;
    }
    fmt::print("{}: {}\n", name, describe_limit(*limit));
    if (std::fflush(stdout) != 0) return fail({ErrorKind::bad_input, "standard output: no space left or closed"});
  }
  return status;
}

}  // namespace edgecase::conformance
