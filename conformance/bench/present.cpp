#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "conformance/bench/bench.h"
#include "conformance/bench/contender.h"

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

nlohmann::ordered_json or_null(const std::optional<double>& value) {
  if (value) return *value;
  return nullptr;
}

/// Three significant digits, or a whole number.
std::string three_digits(double value) {
  if (value == 0) return "0";
  if (value >= 1e6) return fmt::format("{:.2e}", value);
  return value >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

/// A line per rasterizer and a column per workload. Empty if none has a value. `field`: a member, or what a row is
/// asked.
template <class Field>
std::string section(std::span<const BenchRow> rows, const std::string& title, Field field) {
  const auto names = distinct(rows, &BenchRow::rasterizer);
  const auto columns = distinct(rows, &BenchRow::workload);
  std::size_t width = title.size();
  for (const std::string& name : names) width = std::max(width, name.size());
  std::string text = fmt::format("{:<{}}", title, width);
  for (const std::string& column : columns) text += fmt::format(" {:>10}", column);
  text += '\n';
  bool any = false;
  for (const std::string& name : names) {
    text += fmt::format("{:<{}}", name, width);
    for (const std::string& column : columns) {
      const auto row = std::ranges::find_if(rows, [&](const BenchRow& candidate) {
        return candidate.rasterizer == name && candidate.workload == column;
      });
      const std::optional<double> value =
          row == rows.end() ? std::nullopt : std::optional<double>(std::invoke(field, *row));
      any |= value.has_value();
      text += fmt::format(" {:>10}", value ? three_digits(*value) : "-");
    }
    text += '\n';
  }
  return any ? text + "\n" : "";
}

/// The subpixel bits of the vectorized plain loop's format, if that is what the row is of.
std::optional<int> bits_of_plain(const BenchRow& row) {
  for (const int bits : kSubpixelBits) {
    if (row.rasterizer == plain_name(bits)) return bits;
  }
  return std::nullopt;
}

/// What a narrower format saves and costs: a line per format and workload. Empty unless there is more than one format.
std::string formats_section(std::span<const BenchRow> rows) {
  std::string text = fmt::format("{:<8} {:>4} {:>10} {:>16} {:>16} {:>16}\n", "workload", "bits", "ns", "times as fast",
                                 "wrong, by rules", "wrong, really");
  bool any = false;
  for (const std::string& workload : distinct(rows, &BenchRow::workload)) {
    for (const int bits : kSubpixelBits) {
      for (const BenchRow& row : rows) {
        if (row.workload != workload || bits_of_plain(row) != bits) continue;
        any |= bits != 8;
        text +=
            fmt::format("{:<8} {:>4} {:>10} {:>16} {:>16} {:>16}\n", workload, bits, three_digits(row.ns_per_triangle),
                        three_digits(row.ratio_to_plain), three_digits(row.wrong_per_million),
                        row.wrong_per_million_real ? three_digits(*row.wrong_per_million_real) : "-");
      }
    }
  }
  return any ? "The vectorized plain loop in formats of fewer and of more subpixel bits than the rules' 8\n" + text
             : "";
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
                    {"wrong_per_million_real", or_null(row.wrong_per_million_real)},
                    {"instructions_per_triangle", or_null(row.instructions_per_triangle)},
                    {"covered_px_per_second", row.covered_px_per_second},
                    {"clock", name_of(row.clock)},
                    {"target", {row.target.width, row.target.height}}});
  }
  return nlohmann::ordered_json{{"rows", list}}.dump(2) + "\n";
}

std::string bench_table(std::span<const BenchRow> rows) {
  const auto ratio_to_vectorized = [&](const BenchRow& row) -> std::optional<double> {
    const auto vectorized = std::ranges::find_if(rows, [&](const BenchRow& candidate) {
      return candidate.rasterizer == kPlainVectorized && candidate.workload == row.workload;
    });
    if (vectorized == rows.end()) return std::nullopt;
    return vectorized->ns_per_triangle / row.ns_per_triangle;
  };
  return section(rows, "ns per triangle, median", &BenchRow::ns_per_triangle) +
         section(rows, "spread: quartiles / median", &BenchRow::spread) +
         section(rows, "times as fast as plain", &BenchRow::ratio_to_plain) +
         section(rows, "times as fast as plain:vectorized", ratio_to_vectorized) +
         section(rows, "instructions per triangle", &BenchRow::instructions_per_triangle) +
         section(rows, "wrong px per million, by the rules", &BenchRow::wrong_per_million) +
         section(rows, "wrong px per million, by the real geometry", &BenchRow::wrong_per_million_real) +
         formats_section(rows);
}

}  // namespace edgecase::conformance
