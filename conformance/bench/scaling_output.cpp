#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "conformance/bench/plot.h"
#include "conformance/bench/scaling.h"

namespace edgecase::conformance {
namespace {

std::vector<std::string> workloads_of(std::span<const ScalingPoint> points) {
  std::vector<std::string> names;
  for (const ScalingPoint& point : points) {
    if (std::ranges::find(names, point.workload) == names.end()) names.push_back(point.workload);
  }
  return names;
}

constexpr std::string_view kAbout =
    "Tasks timed one by one on one thread, played through the threads' own agenda; rings are measured.\\n"
    "A line bends where starting other threads (0.5 us each) and adding up their masks weigh as much as\\n"
    "a thread's share of the draw, and ends flat where the plan takes no more of them. Above the ideal: a target\\n"
    "beyond the caches, whose tiles fit. Not in the model: cache lines and bandwidth that threads share.";

}  // namespace

std::string scaling_json(std::span<const ScalingPoint> points) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const auto measured = [](const ScalingPoint& point, double WholeDraws::*field) {
    return point.measured ? nlohmann::ordered_json(*point.measured.*field) : nlohmann::ordered_json();
  };
  for (const ScalingPoint& point : points) {
    list.push_back({{"workload", point.workload},
                    {"triangles", point.triangles},
                    {"threads", point.threads},
                    {"used", point.used},
                    {"tile_columns", point.tile_columns},
                    {"tile_rows", point.tile_rows},
                    {"chunks", point.chunks},
                    {"one_thread_ns", point.one_thread_ns},
                    {"tasks_ns", point.tasks_ns},
                    {"predicted_ns", point.predicted_ns},
                    {"predicted_speedup", point.predicted_speedup},
                    {"predicted_asleep", point.predicted_asleep},
                    {"measured_speedup", measured(point, &WholeDraws::awake)},
                    {"measured_asleep", measured(point, &WholeDraws::asleep)},
                    {"measured_apart", measured(point, &WholeDraws::apart)},
                    {"measured_cpu", measured(point, &WholeDraws::cpu)},
                    {"line_ns", measured(point, &WholeDraws::line_ns)}});
  }
  return nlohmann::ordered_json{{"points", list}}.dump(2) + "\n";
}

std::string scaling_table(std::span<const ScalingPoint> points) {
  constexpr auto kLine = "{:>9} {:>7} {:>4} {:>5} {:>6} {:>9} {:>9} {:>8} {:>8} {:>9} {:>8} {:>8} {:>7} {:>8} {:>7}\n";
  std::string text =
      fmt::format(kLine, "workload", "threads", "used", "tiles", "chunks", "tasks", "predicted", "speed-up", "measured",
                  "deviation", "asleep", "measured", "apart", "CPU time", "line");
  for (const ScalingPoint& point : points) {
    const auto measured = [&](double WholeDraws::*field) {
      return point.measured ? fmt::format("{:.2f}x", *point.measured.*field) : std::string();
    };
    const std::string deviation =
        point.measured ? fmt::format("{:+.0f} %", (point.measured->awake / point.predicted_speedup - 1) * 100) : "";
    text += fmt::format(
        kLine, point.workload, point.threads, point.used, fmt::format("{}x{}", point.tile_columns, point.tile_rows),
        point.chunks, fmt::format("{:.0f} us", point.tasks_ns / 1e3),
        fmt::format("{:.0f} us", point.predicted_ns / 1e3), fmt::format("{:.2f}x", point.predicted_speedup),
        measured(&WholeDraws::awake), deviation, fmt::format("{:.2f}x", point.predicted_asleep),
        measured(&WholeDraws::asleep), measured(&WholeDraws::apart), measured(&WholeDraws::cpu),
        point.measured ? fmt::format("{:.0f} ns", point.measured->line_ns) : std::string());
  }
  return text +
         "Speed-up: modelled, and measured on draws that follow each other; asleep: the same if threads must be "
         "woken.\nApart: what threads reach that draw the same into masks of their own. Line: how long a cache line "
         "takes "
         "from one processor to another.\n";
}

std::string scaling_plot_program(std::span<const ScalingPoint> points, const std::string& path) {
  // Okabe and Ito's palette; told apart by symbol as well.
  constexpr std::array kColours{"#000000", "#D55E00", "#009E73", "#E69F00", "#0072B2", "#CC79A7", "#56B4E9", "#999999"};
  constexpr std::array kSymbols{5, 9, 11, 13, 7, 2, 3, 1};
  const auto names = workloads_of(points);
  double most = 64;
  for (const ScalingPoint& point : points) {
    most = std::max({most, point.predicted_speedup, point.measured ? point.measured->awake : 0});
  }
  std::string text = fmt::format(
      "set terminal pngcairo size 900,760 noenhanced font 'sans,12'\nset output {}\nset title {} font ',15'\n"
      "set logscale xy 2\nset grid xtics ytics lc rgb '#dddddd'\nset xrange [0.9:71]\nset yrange [0.9:{:.3g}]\n"
      "set xtics (1,2,4,8,16,32,64)\nset ytics (1,2,4,8,16,32,64,128,256)\n"
      "set lmargin at screen 0.09\nset rmargin at screen 0.97\nset tmargin at screen 0.94\n"
      "set bmargin at screen 0.33\nset key at screen 0.02,0.14 left top reverse Left vertical maxrows 3\n"
      "set xlabel 'threads'\nset ylabel 'times as fast as one thread'\n"
      "set label \"{}\" at screen 0.02,0.235 left font ',11'\nplot x with lines lw 1 dt 3 lc rgb '#666666' title "
      "'ideal'",
      gnuplot_quoted(path), gnuplot_quoted("Speed over threads, 1920x1080 (wide200: 16384x16384)"), 1.1 * most, kAbout);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const char* const colour = kColours[i % kColours.size()];
    text += fmt::format(", '-' using 1:2 with linespoints lw 1.5 pt {} ps 1.2 lc rgb '{}' title {}",
                        kSymbols[i % kSymbols.size()], colour, gnuplot_quoted(names[i]));
    text += fmt::format(", '-' using 1:2 with points pt 6 ps 2.4 lw 1.5 lc rgb '{}' notitle", colour);
  }
  text += '\n';
  for (const std::string& name : names) {
    std::string predicted, measured = "NaN NaN\n";
    for (const ScalingPoint& point : points) {
      if (point.workload != name) continue;
      predicted += fmt::format("{} {}\n", point.threads, point.predicted_speedup);
      if (point.measured) measured += fmt::format("{} {}\n", point.threads, point.measured->awake);
    }
    text += predicted + "e\n" + measured + "e\n";
  }
  return text + "set output\n";
}

}  // namespace edgecase::conformance
