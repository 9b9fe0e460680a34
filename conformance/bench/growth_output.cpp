#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "conformance/bench/growth.h"
#include "conformance/bench/plot.h"

namespace edgecase::conformance {
namespace {

/// What a picture shows of a point, in ns.
double shown(const GrowthAxis& axis, const GrowthPoint& point) {
  return point.ns_per_triangle * (axis.whole_draw ? static_cast<double>(point.triangles) : 1);
}

std::vector<std::string> rasterizers_of(const GrowthAxis& axis, std::span<const GrowthPoint> points) {
  std::vector<std::string> names;
  for (const GrowthPoint& point : points) {
    if (point.axis == axis.name && std::ranges::find(names, point.rasterizer) == names.end()) {
      names.push_back(point.rasterizer);
    }
  }
  return names;
}

std::vector<const GrowthPoint*> line_of(const GrowthAxis& axis, std::span<const GrowthPoint> points,
                                        std::string_view rasterizer) {
  std::vector<const GrowthPoint*> line;
  for (const GrowthPoint& point : points) {
    if (point.axis == axis.name && point.rasterizer == rasterizer) line.push_back(&point);
  }
  return line;
}

double fitted_slope(const GrowthAxis& axis, std::span<const GrowthPoint* const> line) {
  if (line.size() < 2) return 0;
  double x_mean = 0, y_mean = 0;
  for (const GrowthPoint* point : line) {
    x_mean += std::log(point->value) / static_cast<double>(line.size());
    y_mean += std::log(shown(axis, *point)) / static_cast<double>(line.size());
  }
  double products = 0, squares = 0;
  for (const GrowthPoint* point : line) {
    const double x = std::log(point->value) - x_mean;
    products += x * (std::log(shown(axis, *point)) - y_mean);
    squares += x * x;
  }
  return products / squares;
}

std::string title_of(const GrowthPoint& point) {
  return point.isa.empty() ? point.rasterizer : fmt::format("{} ({})", point.rasterizer, point.isa);
}

}  // namespace

double slope_of(const GrowthAxis& axis, std::span<const GrowthPoint> points, std::string_view rasterizer) {
  const auto line = line_of(axis, points, rasterizer);
  return fitted_slope(axis, line);
}

double last_slope_of(const GrowthAxis& axis, std::span<const GrowthPoint> points, std::string_view rasterizer) {
  const auto line = line_of(axis, points, rasterizer);
  return fitted_slope(axis, std::span(line).last(std::min<std::size_t>(line.size(), 2)));
}

std::string growth_json(std::span<const GrowthPoint> points) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const GrowthPoint& point : points) {
    list.push_back({{"axis", point.axis},
                    {"value", point.value},
                    {"rasterizer", point.rasterizer},
                    {"isa", point.isa},
                    {"triangles", point.triangles},
                    {"ns_per_triangle", point.ns_per_triangle},
                    {"spread", point.spread}});
  }
  return nlohmann::ordered_json{{"points", list}}.dump(2) + "\n";
}

std::string growth_table(std::span<const GrowthPoint> points) {
  std::string text;
  for (const GrowthAxis& axis : growth_axes()) {
    const auto names = rasterizers_of(axis, points);
    if (names.empty()) continue;
    text += fmt::format("{}: ns {}\n{:>28}", axis.title, axis.whole_draw ? "per draw" : "per triangle", axis.label);
    for (const std::string& name : names) text += fmt::format(" {:>18}", name);
    text += '\n';
    for (const GrowthPoint* point : line_of(axis, points, names.front())) {
      text += fmt::format("{:>28}", fmt::format("{:g}", point->value));
      for (const std::string& name : names) {
        for (const GrowthPoint* other : line_of(axis, points, name)) {
          if (other->value == point->value) text += fmt::format(" {:>18.4g}", shown(axis, *other));
        }
      }
      text += '\n';
    }
    text += fmt::format("{:>28}", "slope, fitted");
    for (const std::string& name : names) text += fmt::format(" {:>18.2f}", slope_of(axis, points, name));
    text += fmt::format("\n{:>28}", "of the last step");
    for (const std::string& name : names) text += fmt::format(" {:>18.2f}", last_slope_of(axis, points, name));
    text += '\n';
    for (std::string_view why = axis.slope; !why.empty();) {
      // Lines end as gnuplot wants it, in an escaped line break.
      const std::size_t end = std::min(why.find("\\n"), why.size());
      text += fmt::format("{}\n", why.substr(0, end));
      why.remove_prefix(std::min(end + 2, why.size()));
    }
    text += '\n';
  }
  return text;
}

std::string growth_plot_program(const GrowthAxis& axis, std::span<const GrowthPoint> points, const std::string& path) {
  // Okabe and Ito's palette; told apart by symbol as well.
  constexpr std::array kColours{"#000000", "#D55E00", "#009E73", "#E69F00", "#0072B2"};
  constexpr std::array kSymbols{5, 9, 11, 13, 7};
  const auto names = rasterizers_of(axis, points);
  double least = INFINITY, greatest = 0;
  for (const GrowthPoint& point : points) {
    if (point.axis != axis.name) continue;
    least = std::min(least, shown(axis, point));
    greatest = std::max(greatest, shown(axis, point));
  }
  std::string text = fmt::format(
      "set terminal pngcairo size 900,680 noenhanced font 'sans,12'\nset output {}\nset title {} font ',15'\n"
      "set logscale xy\nset grid xtics ytics lc rgb '#dddddd'\nset format xy '%g'\nset xrange [{}:{}]\n"
      "set yrange [{}:{}]\nset lmargin at screen 0.11\nset rmargin at screen 0.97\nset tmargin at screen 0.93\n"
      "set bmargin at screen 0.36\nset key at screen 0.02,0.19 left top reverse Left vertical maxrows 3\n"
      "set ylabel {}\nset xlabel {}\n",
      gnuplot_quoted(path), gnuplot_quoted(axis.title), axis.values.front() / 1.5, axis.values.back() * 1.5, least / 2,
      greatest * 2, gnuplot_quoted(axis.whole_draw ? "ns of the whole draw, median" : "ns per triangle, median"),
      gnuplot_quoted(axis.label));
  // In double quotes for the line break; the text has neither quotes nor backslashes of its own.
  text += fmt::format("set label \"{}\" at screen 0.02,0.25 left font ',11'\n", axis.slope);
  std::string tics;
  for (const double value : axis.values) tics += fmt::format("{}{:g}", tics.empty() ? "" : ",", value);
  text += fmt::format("set xtics ({})\nplot ", tics);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto line = line_of(axis, points, names[i]);
    text += fmt::format(
        "{}'-' using 1:2 with linespoints lw 1.5 pt {} ps 1.2 lc rgb '{}' title {}", i == 0 ? "" : ", ",
        kSymbols[i % kSymbols.size()], kColours[i % kColours.size()],
        gnuplot_quoted(fmt::format("{}, slope {:.2f}", title_of(*line.front()), slope_of(axis, points, names[i]))));
  }
  text += '\n';
  for (const std::string& name : names) {
    for (const GrowthPoint* point : line_of(axis, points, name)) {
      text += fmt::format("{} {}\n", point->value, shown(axis, *point));
    }
    text += "e\n";
  }
  return text + "set output\n";
}

}  // namespace edgecase::conformance
