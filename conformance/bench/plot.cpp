#include "conformance/bench/plot.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <vector>

namespace edgecase::conformance {
namespace {

// An error of 0 has no place on a logarithmic axis: it is drawn on a line of its own below the smallest error that can
// be seen, and the axis is labelled so.
constexpr double kZeroLine = 0.01;
constexpr double kBottom = 0.004;
/// Least distance between neighbouring labels: of those set upright, as a share of the time axis; of the others, as a
/// factor in error.
constexpr double kUprightShare = 0.035;
constexpr double kLevelFactor = 1.8;

struct Kind {
  std::string_view prefix;
  std::string_view colour;
  int point;  ///< gnuplot's number of the symbol
  std::string_view title;
};
// Told apart by symbol as well as by colour; the colours are from Okabe and Ito's palette for colour-blind readers.
constexpr Kind kKinds[] = {
    {"plain", "#000000", 5, "the plain loop, the baseline"},
    {"edgecase", "#0072B2", 7, "Edgecase, exact by construction"},
    {"inexact", "#D55E00", 9, "inexact arithmetics"},
    {"", "#009E73", 13, "other subjects, with a mask per triangle"},
};

std::size_t kind_of(const BenchRow& row) {
  const auto found =
      std::ranges::find_if(kKinds, [&](const Kind& kind) { return row.rasterizer.starts_with(kind.prefix); });
  return static_cast<std::size_t>(found - std::begin(kKinds));
}

std::string_view short_name(const BenchRow& row) {
  const std::string_view name = row.rasterizer;
  const Kind& kind = kKinds[kind_of(row)];
  const bool prefixed = !kind.prefix.empty() && name.size() > kind.prefix.size() && name[kind.prefix.size()] == ':';
  return prefixed ? name.substr(kind.prefix.size() + 1) : name;
}

double height_of(const BenchRow& row) { return row.wrong_per_million > 0 ? row.wrong_per_million : kZeroLine; }

struct Range {
  double left;
  double right;
};

/// Labels of rasterizers without error stand upright on the zero line, moved apart where they would overlap; those of
/// the others lie to the right of their points, moved upwards. A thin line leads from each point to its label.
std::string labels(std::vector<const BenchRow*> rows, const Range& range) {
  const auto split =
      std::stable_partition(rows.begin(), rows.end(), [](const BenchRow* row) { return row->wrong_per_million == 0; });
  const std::vector<const BenchRow*> inexact(split, rows.end());
  rows.erase(split, rows.end());

  std::string text;
  const auto lead = [&](const BenchRow& row, double x, double y) {
    text += fmt::format("set arrow from {},{} to {},{} nohead lw 0.5 lc rgb '#999999'\n", row.ns_per_triangle,
                        height_of(row), x, y);
  };
  const auto label = [&](const BenchRow& row, double x, double y, std::string_view how) {
    text += fmt::format("set label {} at {},{} {} noenhanced font ',11' tc rgb '{}'\n", gnuplot_quoted(short_name(row)),
                        x, y, how, kKinds[kind_of(row)].colour);
  };

  std::ranges::sort(rows, {}, [](const BenchRow* row) { return row->ns_per_triangle; });
  const double share = std::min(kUprightShare, 1 / (static_cast<double>(rows.size()) + 1));
  const double factor = std::pow(range.right / range.left, share);
  std::vector<double> x;
  for (const BenchRow* row : rows) {
    x.push_back(x.empty() ? row->ns_per_triangle : std::max(row->ns_per_triangle, x.back() * factor));
  }
  // What this has moved beyond the right border moves back, and its neighbours with it.
  double limit = range.right / factor;
  for (std::size_t i = x.size(); i-- > 0; limit = x[i] / factor) x[i] = std::min(x[i], limit);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    lead(*rows[i], x[i], kZeroLine * 3.5);
    label(*rows[i], x[i], kZeroLine * 4, "rotate by 90 left");
  }

  std::vector<const BenchRow*> upwards = inexact;
  std::ranges::sort(upwards, {}, [](const BenchRow* row) { return row->wrong_per_million; });
  double lowest = 0;
  for (const BenchRow* row : upwards) {
    const double y = std::max(row->wrong_per_million, lowest);
    lead(*row, row->ns_per_triangle * factor, y);
    label(*row, row->ns_per_triangle * std::pow(factor, 1.2), y, "left");
    lowest = y * kLevelFactor;
  }
  return text;
}

/// Powers of ten, and between them 2 and 5 where there are few.
std::string x_tics(const Range& range) {
  std::string tics;
  const bool few = range.right / range.left < 1'000;
  for (double decade = std::pow(10, std::floor(std::log10(range.left))); decade < range.right; decade *= 10) {
    for (const int digit : few ? std::vector{1, 2, 5} : std::vector{1}) {
      const double tic = decade * digit;
      if (tic < range.left || tic > range.right) continue;
      const std::string text = tic < 10'000 ? fmt::format("{:.0f}", tic)
                               : tic < 1e6  ? fmt::format("{:.0f}k", tic / 1e3)
                                            : fmt::format("{:.0f}M", tic / 1e6);
      tics += fmt::format("{}'{}' {}", tics.empty() ? "" : ", ", text, tic);
    }
  }
  return fmt::format("set xtics ({})\n", tics);
}

std::string panel(std::span<const BenchRow> rows, const std::string& workload) {
  std::vector<const BenchRow*> here;
  for (const BenchRow& row : rows) {
    // Other formats of the plain loop have a table of their own; here they would hide the rest.
    if (row.workload == workload && !row.rasterizer.starts_with(fmt::format("{}:bits", kPlain))) here.push_back(&row);
  }
  if (here.empty()) return "";
  const auto [fastest, slowest] =
      std::ranges::minmax(here, {}, [](const BenchRow* row) { return row->ns_per_triangle; });
  // Room for the labels: a sixth of the axis on the left of the points, a third on their right.
  const double decades = std::max(std::log10(slowest->ns_per_triangle / fastest->ns_per_triangle), 0.5);
  const Range range{fastest->ns_per_triangle * std::pow(10, -decades / 6),
                    slowest->ns_per_triangle * std::pow(10, decades / 2)};
  double top = 3e6;
  for (const BenchRow* row : here) top = std::max(top, row->wrong_per_million * 5);
  std::string text = fmt::format(
      "unset label\nunset arrow\nset title {} noenhanced font ',15'\nset xrange [{}:{}]\nset yrange [{}:{}]\n",
      gnuplot_quoted(workload), range.left, range.right, kBottom, top);
  text += fmt::format("set arrow from graph 0,first {0} to graph 1,first {0} nohead lw 1 dt 3 lc rgb '#666666'\n",
                      kZeroLine);
  text += x_tics(range);
  text += labels(here, range);
  text += "plot ";
  for (const Kind& kind : kKinds) {
    text += fmt::format("{}'-' using 1:2 with points pt {} ps 1.4 lc rgb '{}' notitle", &kind == kKinds ? "" : ", ",
                        kind.point, kind.colour);
  }
  text += "\n";
  for (std::size_t kind = 0; kind < std::size(kKinds); ++kind) {
    // gnuplot wants at least one line of data for each; one that is no number draws nothing.
    text += "NaN NaN\n";
    for (const BenchRow* row : here) {
      if (kind_of(*row) == kind) text += fmt::format("{} {}\n", row->ns_per_triangle, height_of(*row));
    }
    text += "e\n";
  }
  return text;
}

/// The symbols and what the axes mean.
std::string key() {
  std::string text =
      "unset label\nunset arrow\nunset title\nunset border\nunset tics\nunset xlabel\nunset ylabel\n"
      "unset logscale\nset xrange [0:1]\nset yrange [0:1]\n";
  const auto line = [&](double y, std::string_view words) {
    text += fmt::format("set label {} at 0.08,{} left font ',13'\n", gnuplot_quoted(words), y);
  };
  double y = 0.92;
  for (const Kind& kind : kKinds) {
    text += fmt::format("set label '' at 0.03,{} point pt {} ps 1.6 lc rgb '{}'\n", y, kind.point, kind.colour);
    line(y, kind.title);
    y -= 0.08;
  }
  for (const std::string_view words :
       {"Left is faster, down is more exact.", "Time: median of interleaved repetitions,",
        "coverage only, 1920x1080 pixels,", "one sample a pixel.", "Error: pixels missing or unexpected, of a",
        "million to be covered, by the D3D11 rules", "with 8 subpixel bits; each triangle is", "judged on its own."}) {
    y -= 0.07;
    line(y, words);
  }
  return text + "plot NaN notitle\n";
}

}  // namespace

std::string gnuplot_quoted(std::string_view text) {
  // Only a quote has to be doubled.
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c;
  }
  return result + "'";
}

std::string plot_program(std::span<const BenchRow> rows, const std::string& path) {
  std::vector<std::string> workloads;
  for (const BenchRow& row : rows) {
    if (std::ranges::find(workloads, row.workload) == workloads.end()) workloads.push_back(row.workload);
  }
  const std::size_t panels = workloads.size() + 1;
  const std::size_t columns = panels <= 2 ? panels : (panels + 1) / 2;
  const std::size_t lines = (panels + columns - 1) / columns;
  std::string text = fmt::format(
      "set terminal pngcairo size {},{} enhanced font 'sans,12'\nset output {}\n"
      "set multiplot layout {},{} title {} font ',18'\n",
      600 * columns, 560 * lines + 60, gnuplot_quoted(path), lines, columns,
      gnuplot_quoted("Triangle coverage: wrong pixels over time"));
  text += fmt::format(
      "set logscale xy\nset xlabel 'ns per triangle'\nset ylabel 'wrong pixels per million'\n"
      "set grid xtics ytics lc rgb '#dddddd'\nset format y '10^{{%L}}'\nset ytics add ('none' {})\n",
      kZeroLine);
  for (const std::string& workload : workloads) text += panel(rows, workload);
  return text + key() + "unset multiplot\nset output\n";
}

tl::expected<void, Error> plot_bench(std::span<const BenchRow> rows, const std::string& path) {
  return run_gnuplot(plot_program(rows, path), path);
}

tl::expected<void, Error> run_gnuplot(const std::string& program, const std::string& path) {
  // Without gnuplot, writing to the pipe must fail and not end this program.
  auto* const previous = std::signal(SIGPIPE, SIG_IGN);
  std::FILE* const gnuplot = popen("gnuplot >/dev/null 2>&1", "w");
  int status = -1;
  if (gnuplot != nullptr) {
    std::fwrite(program.data(), 1, program.size(), gnuplot);
    status = pclose(gnuplot);
  }
  std::signal(SIGPIPE, previous);
  constexpr int kNotFound = 127;  // what the shell says
  if (status != -1 && WIFEXITED(status) && WEXITSTATUS(status) == kNotFound) {
    return tl::unexpected(Error{ErrorKind::absent, "gnuplot, which draws the plot, is not installed"});
  }
  if (status != 0) return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("gnuplot cannot draw {}", path)});
  return {};
}

}  // namespace edgecase::conformance
