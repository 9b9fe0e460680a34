#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "conformance/runner/stability.h"

namespace edgecase::conformance {
namespace {

using Json = nlohmann::ordered_json;

// An error of 0 has no place on a logarithmic axis: it is drawn on a line of its own, and the axis labelled so.
constexpr double kZeroLine = 0.1;

std::string per_million(const StabilityRow& row) {
  if (row.refused) return "refused";
  const double error = row.wrong_per_million();
  return row.wrong == 0 ? "0" : error < 10 ? fmt::format("{:.2f}", error) : fmt::format("{:.0f}", error);
}

std::vector<std::string> names_of(const Stability& stability, std::string StabilityRow::*field) {
  std::vector<std::string> names;
  for (const StabilityRow& row : stability.rows) {
    if (std::ranges::find(names, row.*field) == names.end()) names.push_back(row.*field);
  }
  return names;
}

std::string torn(const StabilityRow& row) { return row.meshes == 0 ? "" : fmt::format("{}+{}", row.gaps, row.doubles); }

// A line per family in which some cell says something, a column per subject.
std::string table(const Stability& stability, std::string (*cell)(const StabilityRow&)) {
  std::map<std::string, std::string> lines;
  for (const StabilityRow& row : stability.rows) {
    if (!cell(row).empty()) lines.emplace(row.family, fmt::format("{:<20}", row.family));
  }
  std::string heading(20, ' ');
  for (const std::string& subject : names_of(stability, &StabilityRow::subject)) {
    const std::string name = subject.substr(subject.find(':') + 1);
    std::size_t width = name.size();
    for (const StabilityRow& row : stability.rows) {
      if (row.subject == subject) width = std::max(width, cell(row).size());
    }
    heading += fmt::format("{:>{}}", name, width + 2);
    for (const StabilityRow& row : stability.rows) {
      if (row.subject == subject && lines.contains(row.family)) {
        lines[row.family] += fmt::format("{:>{}}", cell(row), width + 2);
      }
    }
  }
  std::string text = heading + "\n";
  for (const std::string& family : names_of(stability, &StabilityRow::family)) {
    if (lines.contains(family)) text += lines[family] + "\n";
  }
  return text;
}

std::string limits(const Stability& stability) {
  std::string text;
  for (const auto& [subject, limit] : stability.limits) {
    text += fmt::format("{:<26} {}\n", subject, describe_limit(limit));
  }
  return text;
}

double plotted(const StabilityRow& row) { return row.wrong == 0 ? kZeroLine : row.wrong_per_million(); }

// A data block of gnuplot for each subject: value and error of the rows that `value` gives one.
template <class Value>
std::string blocks(const Stability& stability, const char* prefix, const Value& value) {
  std::string text;
  const auto subjects = names_of(stability, &StabilityRow::subject);
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    text += fmt::format("${}{} << END\n", prefix, i);
    for (const StabilityRow& row : stability.rows) {
      if (row.subject != subjects[i] || row.refused) continue;
      if (const auto at = value(row)) text += fmt::format("{} {}\n", *at, plotted(row));
    }
    text += "END\n";
  }
  return text;
}

// gnuplot's default colours and symbols differ from subject to subject; shown in both panels alike.
std::string curves(const Stability& stability, const char* prefix, const char* style) {
  std::string text = "plot ";
  const auto subjects = names_of(stability, &StabilityRow::subject);
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    text += fmt::format("{}${}{} with {} lt {} pt {} ps 1.2 title '{}'", i == 0 ? "" : ", ", prefix, i, style, i + 1,
                        i + 1, subjects[i]);
  }
  return text + "\n";
}

}  // namespace

std::string stability_text(const Stability& stability) {
  return fmt::format("Wrong samples per million to be covered:\n{}\n", table(stability, per_million)) +
         fmt::format("Gaps + doubles inside meshes:\n{}\n", table(stability, torn)) +
         fmt::format("The coordinate at which each first fails:\n{}", limits(stability));
}

std::string stability_json(const Stability& stability, std::uint64_t seed) {
  Json rows = Json::array();
  for (const StabilityRow& row : stability.rows) {
    rows.push_back({{"subject", row.subject},
                    {"family", row.family},
                    {"extent", row.extent ? Json(*row.extent) : Json(nullptr)},
                    {"triangles", row.triangles},
                    {"samples_to_cover", row.to_cover},
                    {"wrong", row.wrong},
                    {"wrong_per_million", row.wrong_per_million()},
                    {"meshes", row.meshes},
                    {"samples_inside", row.inside},
                    {"gaps", row.gaps},
                    {"doubles", row.doubles},
                    {"reason", row.refused ? Json(*row.refused) : Json(nullptr)}});
  }
  Json limits = Json::array();
  for (const auto& [subject, limit] : stability.limits) {
    limits.push_back({{"subject", subject},
                      {"exact_to_px", limit.pixels()},
                      {"beyond", limit.refused ? "not accepted" : "wrong"},
                      {"reason", limit.refused ? Json(*limit.refused) : Json(nullptr)}});
  }
  const Json json{{"edgecase", EDGECASE_VERSION}, {"seed", seed}, {"rows", rows}, {"limits", limits}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string stability_plot(const Stability& stability, const std::string& path) {
  const auto all_families = names_of(stability, &StabilityRow::family);
  std::string tics;
  int columns = 0;
  for (const StabilityRow& row : stability.rows) {
    if (row.subject != stability.rows.front().subject || row.extent) continue;
    tics += fmt::format("{}'{}' {}", columns == 0 ? "" : ", ", row.family, columns);
    ++columns;
  }
  const auto column = [&](const StabilityRow& row) -> std::optional<double> {
    if (row.extent) return std::nullopt;
    const auto subjects = names_of(stability, &StabilityRow::subject);
    const auto family = std::ranges::find(all_families, row.family) - all_families.begin();
    const auto subject = std::ranges::find(subjects, row.subject) - subjects.begin();
    return static_cast<double>(family) +
           0.06 * (static_cast<double>(subject) - static_cast<double>(subjects.size()) / 2);
  };
  std::string quoted;
  for (const char c : path) quoted += c == '\'' ? std::string(2, c) : std::string(1, c);
  std::string text = fmt::format(
      "set terminal pngcairo size 1800,800 noenhanced font 'sans,12'\nset output '{}'\n"
      "set multiplot layout 1,2 title 'What inexact arithmetics cost' font ',18'\n"
      "set logscale y\nset ylabel 'wrong samples per million to be covered'\nset yrange [{}:1e7]\n"
      "set format y '%g'\nset ytics add ('none' {})\nset grid xtics ytics lc rgb '#dddddd'\nset key outside below\n",
      quoted, kZeroLine / 2, kZeroLine);
  text += blocks(stability, "extent", [](const StabilityRow& row) { return row.extent; });
  text += blocks(stability, "family", column);
  text += "set logscale x 2\nset xlabel 'extent of the vertices, px'\n";
  text += curves(stability, "extent", "linespoints");
  text += fmt::format("unset logscale x\nset xlabel ''\nset xrange [-0.6:{}.6]\nset xtics ({}) rotate by -30\n",
                      columns - 1, tics);
  text += curves(stability, "family", "points");
  return text + "unset multiplot\nset output\n";
}

}  // namespace edgecase::conformance
