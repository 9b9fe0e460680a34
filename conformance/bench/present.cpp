#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "conformance/bench/bench.h"

namespace edgecase::conformance {
namespace {

/// In the order in which they come.
std::vector<std::string> distinct(std::span<const BenchRow> rows, std::string BenchRow::*field) {
  std::vector<std::string> values;
  for (const BenchRow& row : rows) {
    if (std::ranges::find(values, row.*field) == values.end()) values.push_back(row.*field);
  }
  return values;
}

std::string_view name_of(Clock clock) {
  switch (clock) {
    case Clock::thread:
      return "thread";
    case Clock::wall:
      return "wall";
    case Clock::driver:
      return "driver";
  }
  return {};
}

/// Three significant digits, or a whole number.
std::string three_digits(double value) {
  if (value == 0) return "0";
  if (value >= 1e6) return fmt::format("{:.2e}", value);
  return value >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string section(std::span<const BenchRow> rows, const std::string& title, double BenchRow::*field) {
  const auto names = distinct(rows, &BenchRow::rasterizer);
  const auto columns = distinct(rows, &BenchRow::workload);
  std::size_t width = title.size();
  for (const std::string& name : names) width = std::max(width, name.size());
  std::string text = fmt::format("{:<{}}", title, width);
  for (const std::string& column : columns) text += fmt::format(" {:>10}", column);
  text += '\n';
  for (const std::string& name : names) {
    text += fmt::format("{:<{}}", name, width);
    for (const std::string& column : columns) {
      const auto row = std::ranges::find_if(rows, [&](const BenchRow& candidate) {
        return candidate.rasterizer == name && candidate.workload == column;
      });
      text += fmt::format(" {:>10}", row == rows.end() ? "-" : three_digits((*row).*field));
    }
    text += '\n';
  }
  return text;
}

}  // namespace

std::string bench_json(std::span<const BenchRow> rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const BenchRow& row : rows) {
    list.push_back({{"rasterizer", row.rasterizer},
                    {"isa", row.isa},
                    {"workload", row.workload},
                    {"triangles", row.triangles},
                    {"ns_per_triangle", row.ns_per_triangle},
                    {"spread", row.spread},
                    {"ratio_to_plain", row.ratio_to_plain},
                    {"wrong_per_million", row.wrong_per_million},
                    {"covered_px_per_second", row.covered_px_per_second},
                    {"clock", name_of(row.clock)},
                    {"target", {row.target.width, row.target.height}}});
  }
  return nlohmann::ordered_json{{"rows", list}}.dump(2) + "\n";
}

std::string bench_table(std::span<const BenchRow> rows) {
  return section(rows, "ns per triangle, median", &BenchRow::ns_per_triangle) + "\n" +
         section(rows, "spread: quartiles / median", &BenchRow::spread) + "\n" +
         section(rows, "times as fast as plain", &BenchRow::ratio_to_plain) + "\n" +
         section(rows, "wrong px per million", &BenchRow::wrong_per_million);
}

}  // namespace edgecase::conformance
