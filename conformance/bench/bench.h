// The bench command: every rasterizer on every workload, speed beside error.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/bench/measure.h"
#include "conformance/scene/error.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

struct BenchOptions {
  /// Names of workloads; empty for all.
  std::vector<std::string> workloads;
  /// Names of contenders; empty for all that are built in. The plain loop always runs as well.
  std::vector<std::string> subjects;
  /// Fewer triangles and repetitions: all built-in contenders and workloads in less than a minute.
  bool quick = false;
  /// Counts instructions one by one where the machine has no counter for them: seconds for each row.
  bool instructions = false;
  /// Where to write the rows as JSON, and the plot as PNG; empty for not at all. "-" is standard output.
  std::string json;
  std::string plot;
  /// Measures growth instead, into this folder: growth.json and a picture for each axis, see growth.h. Workloads,
  /// subjects, json and plot are then not looked at.
  std::string growth;
  /// Measures and models the threads instead, into this folder: scaling.json and scaling.png, see scaling.h.
  std::string scaling;
  std::uint64_t seed = 1;
  /// Finds a subject whose name is no built-in contender's.
  std::function<tl::expected<std::unique_ptr<Subject>, Error>(const std::string&)> make_subject;
};

/// Measures as `options` say, prints a table on standard output, and writes what was asked for. Returns the exit
/// status: 0; 1 if a subject failed; 2 for bad input, with a line on standard error; 3 for a subject that is not there.
int bench_command(const BenchOptions& options);

/// The rows of every workload, in the order of the workloads and then of the contenders.
tl::expected<std::vector<BenchRow>, Error> bench(const BenchOptions& options);

/// {"rows": [...]}, an object per row with the fields' names as keys, indented.
std::string bench_json(std::span<const BenchRow> rows);

/// A line per rasterizer and a column per workload: nanoseconds a triangle, the ratio to plain, instructions where they
/// were counted, and the error by the rules and by the real geometry. Then what a format of fewer bits saves and costs.
std::string bench_table(std::span<const BenchRow> rows);

}  // namespace edgecase::conformance
