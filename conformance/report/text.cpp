#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include "conformance/report/escape.h"
#include "conformance/report/report.h"
#include "conformance/report/summary.h"

namespace edgecase::conformance {
namespace {

constexpr std::size_t kColumns = 8;
constexpr std::size_t kFirstNumber = 3;  // the columns before it are words, from it on numbers
constexpr std::size_t kVerdictColumn = 2;
using Row = std::array<std::string, kColumns>;

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

std::string label(const Report& report, const ResultGroup& group) {
  if (group.results.size() == 1) return visible_line(report.results[group.results.front()].testcase);
  const std::string category = group.category.empty() ? "cases" : visible_line(group.category);
  if (group.results.size() == group.category_size) return fmt::format("{} ({} cases)", category, group.category_size);
  return fmt::format("{} ({} of {} cases)", category, group.results.size(), group.category_size);
}

Row to_row(const Report& report, const SubjectSummary& subject, const ResultGroup& group) {
  Totals totals;
  for (const std::size_t i : group.results) totals.add(report.results[i]);
  Row row{visible_line(subject.name), label(report, group), name_of(group.verdict)};
  const std::array numbers{totals.triangles, totals.samples_compared, totals.missing, totals.unexpected,
                           totals.doubled};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    row[kFirstNumber + i] = group.verdict == Verdict::skip ? "-" : grouped(numbers[i]);
  }
  return row;
}

void append_table(const Report& report, const std::vector<SubjectSummary>& subjects, bool terminal, std::string& out) {
  std::vector<Row> rows{{"subject", "case", "verdict", "triangles", "samples", "missing", "unexpected", "doubled"}};
  std::vector<Verdict> verdicts{Verdict::pass};
  for (const SubjectSummary& subject : subjects) {
    for (const ResultGroup& group : by_category(report, subject)) {
      rows.push_back(to_row(report, subject, group));
      verdicts.push_back(group.verdict);
    }
  }
  std::array<std::size_t, kColumns> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < kColumns; ++i) widths[i] = std::max(widths[i], columns(row[i]));
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t i = 0; i < kColumns; ++i) {
      const std::string padding(widths[i] - columns(rows[r][i]), ' ');
      const bool is_verdict = r != 0 && i == kVerdictColumn;
      const std::string cell = is_verdict ? coloured(rows[r][i], verdicts[r], terminal) : rows[r][i];
      out += i == 0 ? "" : "  ";
      out += i < kFirstNumber ? cell + padding : padding + cell;
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

/// The results of a verdict that needs no action, those of one subject with the same reason together.
void append_reasons(const Report& report, const std::vector<SubjectSummary>& subjects, Verdict verdict, bool terminal,
                    std::string& out) {
  for (const SubjectSummary& subject : subjects) {
    std::vector<std::pair<std::string, std::vector<std::size_t>>> reasons;
    for (const std::size_t i : subject.results) {
      const Result& result = report.results[i];
      if (result.verdict != verdict) continue;
      auto found = std::ranges::find(reasons, result.reason, &decltype(reasons)::value_type::first);
      if (found == reasons.end()) found = reasons.insert(found, {result.reason, {}});
      found->second.push_back(i);
    }
    for (const auto& [reason, results] : reasons) {
      const std::string cases = results.size() == 1 ? visible_line(report.results[results.front()].testcase)
                                                    : counted(results.size(), "case");
      out += fmt::format("\n{} {}: {}\n", coloured(name_of(verdict), verdict, terminal), visible_line(subject.name),
                         cases);
      append_indented(reason, out);
    }
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
  append_reasons(report, subjects, Verdict::known, terminal, out);
  append_reasons(report, subjects, Verdict::skip, terminal, out);
  out += '\n';
  for (const SubjectSummary& subject : subjects) out += sentence(subject) + ".\n";
  const Totals totals = totals_of(report);
  out += fmt::format("{} passed, {} failed, {} known to deviate, {} skipped, in {:.1f} s (rules {}, seed {}).\n",
                     grouped(totals.pass), grouped(totals.fail), grouped(totals.known), grouped(totals.skip),
                     report.seconds, report.rules, report.seed);
  return out;
}

}  // namespace edgecase::conformance
