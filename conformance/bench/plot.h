// The plot of error over time: a panel per workload, both axes logarithmic, drawn by gnuplot.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "conformance/bench/measure.h"
#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// Writes a PNG to `path`. An error if gnuplot is not installed (ErrorKind::absent) or cannot write there.
tl::expected<void, Error> plot_bench(std::span<const BenchRow> rows, const std::string& path);

/// Has gnuplot run the program that writes `path`; errors as above.
tl::expected<void, Error> run_gnuplot(const std::string& program, const std::string& path);

/// `text` in gnuplot's single quotes.
std::string gnuplot_quoted(std::string_view text);

/// The gnuplot program of plot_bench.
std::string plot_program(std::span<const BenchRow> rows, const std::string& path);

}  // namespace edgecase::conformance
