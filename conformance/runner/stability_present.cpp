#include <fmt/format.h>

#include <algorithm>
#include <array>
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

// A colour and a symbol for each subject, the same in every panel: Okabe and Ito's colours, dark before light, and once
// more with other symbols.
std::string styles(const std::vector<std::string>& subjects) {
  constexpr std::array kColours{"000000", "d55e00", "0072b2", "009e73", "cc79a7", "56b4e9", "e69f00"};
  constexpr std::array kSymbols{7, 4, 8, 6, 10, 12, 5, 9, 2, 11, 13, 3};
  std::string text;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    text += fmt::format("set linetype {} lc rgb '#{}' pt {} ps 1.4 lw 1.6\n", i + 1, kColours[i % kColours.size()],
                        kSymbols[i % kSymbols.size()]);
  }
  return text;
}

std::string title_of(const std::string& subject) {
  const std::size_t colon = subject.find(':');
  return colon == std::string::npos ? subject + " (exact)" : subject.substr(colon + 1);
}

struct Point {
  double x;
  double y;
};

// One panel: the points that `points` makes of each row, a curve for each subject. An error of 0 lies on its own line.
template <class Points>
std::string panel(const Stability& stability, const std::string& name, const char* style, const Points& points) {
  std::string data;
  std::string plot;
  const auto subjects = names_of(stability, &StabilityRow::subject);
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    data += fmt::format("${}{} << END\n", name, i);
    for (const StabilityRow& row : stability.rows) {
      if (row.subject != subjects[i] || row.refused) continue;
      for (const Point& point : points(row, i)) data += fmt::format("{} {}\n", point.x, std::max(point.y, kZeroLine));
    }
    data += "END\n";
    plot += fmt::format("{}${}{} with {} lt {} title '{}'", i == 0 ? "plot " : ", ", name, i, style, i + 1,
                        title_of(subjects[i]));
  }
  return data + plot + "\n";
}

// Columns side by side, in each of which the subjects stand beside each other.
class Columns {
 public:
  explicit Columns(std::size_t subjects) : subjects_(subjects) {}
  double place(const std::string& label, std::size_t subject) {
    const auto found = std::ranges::find(labels_, label);
    const auto column = static_cast<double>(found - labels_.begin());
    if (found == labels_.end()) labels_.push_back(label);
    return column + 0.8 * ((static_cast<double>(subject) + 0.5) / static_cast<double>(subjects_) - 0.5);
  }
  std::string axis() const {
    std::string tics;
    std::string between;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      tics += fmt::format("{}'{}' {}", i == 0 ? "" : ", ", labels_[i], i);
      if (i > 0)
        between += fmt::format("set arrow from {0}-0.5,graph 0 to {0}-0.5,graph 1 nohead lc rgb '#dddddd'\n", i);
    }
    return fmt::format("unset logscale x\nset xrange [-0.5:{}.5]\nset xtics ({}) rotate by -20\nset grid noxtics\n{}",
                       labels_.size() - 1, tics, between);
  }

 private:
  std::size_t subjects_;
  std::vector<std::string> labels_;
};

// How far each stays exact: a bar from 1 px, with what is beyond its end in words.
std::string limits_panel(const Stability& stability) {
  std::string data = "$limits << END\n";
  std::string tics;
  std::size_t i = 0;
  for (const auto& [subject, limit] : stability.limits) {
    const auto row = static_cast<double>(stability.limits.size() - i);
    tics += fmt::format("{}'{}' {}", i == 0 ? "" : ", ", title_of(subject), row);
    data += fmt::format("{} {} {} \"{}\"\n", std::max(limit.pixels(), 1.0), row, i + 1, describe_limit(limit));
    ++i;
  }
  return data + "END\n" +
         fmt::format(
             "unset logscale y\nset logscale x 2\nset xrange [1:137438953472]\nset yrange [0.3:{}.7]\n"
             "set xtics (1, 16, 256, 4096, 32768) norotate\nset ytics ({})\nset grid xtics "
             "noytics\n"
             "set xlabel 'extent of the vertices, px'\nset ylabel ''\nunset key\n"
             "set title 'The coordinate at which each first fails'\n"
             "plot $limits using (1):2:($1-1):(0):3 with vectors nohead lw 9 lc variable, "
             "$limits using 1:2:4 with labels left offset 1,0\n",
             stability.limits.size(), tics);
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
  std::string quoted;
  for (const char c : path) quoted += c == '\'' ? std::string(2, c) : std::string(1, c);
  const auto subjects = names_of(stability, &StabilityRow::subject);
  std::string text = fmt::format(
      "set terminal pngcairo size 1900,1350 noenhanced font 'sans,12'\nset output '{}'\n{}"
      "set multiplot layout 2,2 columnsfirst title 'What inexact arithmetics cost on hard cases' font ',20'\n"
      "set logscale y\nset yrange [{}:1e7]\nset format y '%.0f'\nset ytics add ('none' {})\n"
      "set ytics add ('1 million' 1e6, '10 million' 1e7)\nset grid xtics ytics lc rgb '#dddddd'\n",
      quoted, styles(subjects), kZeroLine / 2, kZeroLine);

  text +=
      "set logscale x 2\nset xrange [14:18000]\nset xlabel 'extent of the vertices, px'\nset key outside right\n"
      "set ylabel 'wrong samples per million to be covered'\nset title 'By extent'\n";
  text += panel(stability, "extent", "linespoints", [](const StabilityRow& row, std::size_t) -> std::vector<Point> {
    if (!row.extent) return {};
    return {{static_cast<double>(*row.extent), row.wrong_per_million()}};
  });

  Columns families(subjects.size());
  const std::string by_family =
      panel(stability, "family", "points", [&](const StabilityRow& row, std::size_t i) -> std::vector<Point> {
        if (row.extent) return {};
        return {{families.place(row.family, i), row.wrong_per_million()}};
      });
  text += families.axis() + "set xlabel ''\nset title 'By family'\n" + by_family + "unset arrow\n";

  Columns meshes(subjects.size());
  const std::string torn_meshes =
      panel(stability, "mesh", "points", [&](const StabilityRow& row, std::size_t i) -> std::vector<Point> {
        if (row.meshes == 0 || row.inside == 0) return {};
        const double inside = static_cast<double>(row.inside) / 1e6;
        const double gaps = meshes.place(row.family + ": gaps", i);
        return {{gaps, static_cast<double>(row.gaps) / inside},
                {meshes.place(row.family + ": doubles", i), static_cast<double>(row.doubles) / inside}};
      });
  text += meshes.axis() + "set ylabel 'per million samples inside meshes'\nset title 'Gaps and doubles in meshes'\n" +
          torn_meshes + "unset arrow\n";
  return text + limits_panel(stability) + "unset multiplot\nset output\n";
}

}  // namespace edgecase::conformance
