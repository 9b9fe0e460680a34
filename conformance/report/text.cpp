#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "conformance/report/escape.h"
#include "conformance/report/report.h"
#include "conformance/report/summary.h"

namespace edgecase::conformance {
namespace {

const char* colour_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "32";  // green
    case Verdict::fail:
      return "1;31";  // bold red
    case Verdict::known:
      return "33";  // yellow
    case Verdict::skip:
      return "2";  // dim
  }
  return "0";
}

std::string coloured(std::string text, Verdict verdict, bool terminal) {
  return terminal ? fmt::format("\x1b[{}m{}\x1b[0m", colour_of(verdict), text) : text;
}

struct Cell {
  std::string text;
  Verdict verdict = Verdict::pass;  ///< its colour, if it is another
};

struct Column {
  const char* name;
  bool words = false;
  bool always = true;  ///< else only where it is not 0 everywhere
  Cell (*cell)(const SubjectSummary& subject, const CategorySummary& category);
};

template <std::uint64_t Totals::*number, Verdict verdict = Verdict::pass>
Cell total(const SubjectSummary&, const CategorySummary& category) {
  const std::uint64_t value = category.totals.*number;
  return {grouped(value), value == 0 ? Verdict::pass : verdict};
}

// Of what was compared; a dash if nothing was.
template <std::uint64_t Totals::*number>
Cell compared(const SubjectSummary& subject, const CategorySummary& category) {
  const bool nothing = category.totals.skip == category.totals.cases();
  return nothing ? Cell{"-"} : total<number>(subject, category);
}

constexpr Column kTable[] = {
    {"subject", true, true,
     [](const SubjectSummary& s, const CategorySummary&) -> Cell { return {visible_line(s.name)}; }},
    {"category", true, true,
     [](const SubjectSummary&, const CategorySummary& c) -> Cell {
       return {c.category.empty() ? "other" : visible_line(c.category)};
     }},
    {"cases", false, true,
     [](const SubjectSummary&, const CategorySummary& c) -> Cell { return {grouped(c.totals.cases())}; }},
    {"triangles", false, true, compared<&Totals::triangles>},
    {"samples", false, true, compared<&Totals::samples_compared>},
    {"missing", false, true, compared<&Totals::missing>},
    {"unexpected", false, true, compared<&Totals::unexpected>},
    {"doubled", false, true, compared<&Totals::doubled>},
    {"failed", false, true, total<&Totals::fail, Verdict::fail>},
    {"known", false, true, total<&Totals::known, Verdict::known>},
    {"skipped", false, true, total<&Totals::skip, Verdict::skip>},
    {"unpredicted", false, false, total<&Totals::unpredicted>},
    {"cracks", false, false,
     [](const SubjectSummary&, const CategorySummary& c) -> Cell {
       return {grouped(c.totals.cracks.holes + c.totals.cracks.doubled)};
     }},
};

// A line for each subject and category.
void append_table(const Report& report, const std::vector<SubjectSummary>& subjects, bool terminal, std::string& out) {
  struct Line {
    const Column* column;
    std::vector<Cell> cells;
    std::size_t width;
  };
  std::vector<Line> table;
  std::size_t rows = 1;
  for (const Column& column : kTable) {
    std::vector<Cell> cells{{column.name}};
    bool all_zero = true;
    for (const SubjectSummary& subject : subjects) {
      for (const CategorySummary& category : by_category(report, subject)) {
        cells.push_back(column.cell(subject, category));
        all_zero = all_zero && cells.back().text == "0";
      }
    }
    if (!column.always && all_zero) continue;
    std::size_t width = 0;
    for (const Cell& cell : cells) width = std::max(width, columns(cell.text));
    rows = cells.size();
    table.push_back({&column, std::move(cells), width});
  }
  for (std::size_t row = 0; row < rows; ++row) {
    for (const auto& [column, cells, width] : table) {
      const auto& [text, verdict] = cells[row];
      const std::string padding(width - columns(text), ' ');
      const std::string cell = verdict == Verdict::pass ? text : coloured(text, verdict, terminal);
      out += column == table.front().column ? "" : "  ";
      out += column->words ? cell + padding : padding + cell;
    }
    out += '\n';
  }
}

void append_indented(std::string_view text, std::string& out) {
  const std::string shown = visible(text);
  for (std::string_view rest = shown; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    out.append("  ").append(rest.substr(0, end)).append("\n");
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

void append_failure(const Result& result, bool terminal, std::string& out) {
  out += fmt::format("\n{} {}: {}\n", coloured("FAIL", Verdict::fail, terminal), visible_line(result.subject),
                     visible_line(result.testcase));
  append_indented(details(result), out);
}

// " (cull, topology)"
std::string categories_of(const Report& report, const Cause& cause) {
  std::vector<std::string> names;
  for (const std::size_t i : cause.results) {
    const std::string name = visible_line(report.results[i].category);
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names.empty() ? "" : fmt::format(" ({})", fmt::join(names, ", "));
}

/// The results of a verdict that needs no action, those of one subject with the same reason together.
void append_causes(const Report& report, const std::vector<SubjectSummary>& subjects, Verdict verdict, bool terminal,
                   std::string& out) {
  for (const SubjectSummary& subject : subjects) {
    for (const Cause& cause : causes(report, subject.results)) {
      if (cause.verdict != verdict) continue;
      const std::string cases = cause.results.size() == 1
                                    ? visible_line(report.results[cause.results.front()].testcase)
                                    : counted(cause.results.size(), "case") + categories_of(report, cause);
      out += fmt::format("\n{} {}: {}\n", coloured(name_of(verdict), verdict, terminal), visible_line(subject.name),
                         cases);
      append_indented(cause.reason, out);
    }
  }
}

void append_cracks(const Report& report, std::string& out) {
  for (const Result& result : report.results) {
    if (!result.cracks.first) continue;
    out += fmt::format("\ncracks {}: {}\n", visible_line(result.subject), visible_line(result.testcase));
    append_indented(torn(result.cracks) + "\nfirst: " + place(result.cracks), out);
  }
}

}  // namespace

std::string to_text(const Report& report, bool terminal) {
  if (report.results.empty()) return "Nothing was compared.\n";
  const std::vector<SubjectSummary> subjects = by_subject(report);
  std::string out;
  append_table(report, subjects, terminal, out);
  for (const Result& result : report.results) {
    if (result.verdict == Verdict::fail) append_failure(result, terminal, out);
  }
  append_causes(report, subjects, Verdict::known, terminal, out);
  append_causes(report, subjects, Verdict::skip, terminal, out);
  append_cracks(report, out);
  out += '\n';
  for (const SubjectSummary& subject : subjects) out += sentence(subject) + ".\n";
  const Totals totals = totals_of(report);
  out += fmt::format("{} passed, {} failed, {} known to deviate, {} skipped, in {:.1f} s (rules {}, seed {}).\n",
                     grouped(totals.pass), grouped(totals.fail), grouped(totals.known), grouped(totals.skip),
                     report.seconds, report.rules, report.seed);
  return out;
}

}  // namespace edgecase::conformance
