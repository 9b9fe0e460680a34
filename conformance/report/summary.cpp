#include "conformance/report/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "conformance/report/escape.h"

namespace edgecase::conformance {

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::known:
      return "known";
    case Verdict::skip:
      return "skip";
  }
  return "";
}

void Totals::add(const Result& result) {
  switch (result.verdict) {
    case Verdict::pass:
      ++pass;
      break;
    case Verdict::fail:
      ++fail;
      break;
    case Verdict::known:
      ++known;
      break;
    case Verdict::skip:
      ++skip;
      break;
  }
  triangles += result.triangles;
  samples_compared += result.samples_compared;
  missing += result.missing;
  unexpected += result.unexpected;
  doubled += result.doubled;
  may += result.may;
}

Totals totals_of(const Report& report) {
  Totals totals;
  for (const Result& result : report.results) totals.add(result);
  return totals;
}

std::vector<SubjectSummary> by_subject(const Report& report) {
  std::vector<SubjectSummary> subjects;
  std::unordered_map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < report.results.size(); ++i) {
    const Result& result = report.results[i];
    const auto [entry, added] = index.try_emplace(result.subject, subjects.size());
    if (added) subjects.emplace_back().name = result.subject;
    SubjectSummary& subject = subjects[entry->second];
    if (subject.device.empty()) subject.device = result.device;
    subject.totals.add(result);
    if (result.verdict == Verdict::fail) subject.failed.add(result);
    if (result.verdict == Verdict::known) subject.known.add(result);
    subject.results.push_back(i);
  }
  return subjects;
}

std::vector<ResultGroup> by_category(const Report& report, const SubjectSummary& subject) {
  std::vector<std::vector<ResultGroup>> categories;
  std::unordered_map<std::string, std::size_t> index;
  for (const std::size_t i : subject.results) {
    const Result& result = report.results[i];
    const auto [entry, added] = index.try_emplace(result.category, categories.size());
    if (added) categories.emplace_back();
    std::vector<ResultGroup>& groups = categories[entry->second];
    auto group = std::ranges::find(groups, result.verdict, &ResultGroup::verdict);
    if (group == groups.end()) group = groups.insert(group, {result.category, result.verdict, 0, {}});
    group->results.push_back(i);
  }
  std::vector<ResultGroup> all;
  for (std::vector<ResultGroup>& groups : categories) {
    std::uint64_t size = 0;
    for (const ResultGroup& group : groups) size += group.results.size();
    for (ResultGroup& group : groups) {
      group.category_size = size;
      all.push_back(std::move(group));
    }
  }
  return all;
}

std::string sentence(const SubjectSummary& subject) {
  const Totals& totals = subject.totals;
  const std::uint64_t ran = totals.cases() - totals.skip;
  std::string who = visible_line(subject.name);
  if (!subject.device.empty()) who += fmt::format(" ({})", visible_line(subject.device));
  const std::string skipped = totals.skip == 0 ? "" : fmt::format("; {} skipped", counted(totals.skip, "case"));
  const std::string compared =
      fmt::format("{} of {}", counted(totals.samples_compared, "sample"), counted(totals.triangles, "triangle"));
  if (ran == 0) return fmt::format("{} was not compared{}", who, skipped);
  if (totals.fail != 0) {
    const std::string wrong = wrong_samples(subject.failed.missing, subject.failed.unexpected, subject.failed.doubled);
    return fmt::format("{} failed {} of {}{}{}", who, grouped(totals.fail), counted(ran, "case"),
                       wrong.empty() ? "" : fmt::format(": {} among {}", wrong, compared), skipped);
  }
  if (totals.known != 0) {
    const std::string wrong = wrong_samples(subject.known.missing, subject.known.unexpected, subject.known.doubled);
    return fmt::format("{} differs in {} of {}, and only as its list of known deviations says{}{}", who,
                       grouped(totals.known), counted(ran, "case"),
                       wrong.empty() ? "" : fmt::format(": {} among {}", wrong, compared), skipped);
  }
  if (totals.samples_compared == 0) {
    return fmt::format("{} passed {}, which compared no sample{}", who, counted(ran, "case"), skipped);
  }
  const std::string open =
      totals.may == 0 ? "" : fmt::format(", {} of them open and covered otherwise than top-left", grouped(totals.may));
  return fmt::format("{} agrees on every one of {}{}{}", who, compared, open, skipped);
}

std::string wrong_samples(std::uint64_t missing, std::uint64_t unexpected, std::uint64_t doubled) {
  std::string out;
  const auto append = [&](std::uint64_t count, const char* kind) {
    if (count != 0) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", grouped(count), kind);
  };
  append(missing, "missing");
  append(unexpected, "unexpected");
  append(doubled, "doubled");
  return out;
}

std::string details(const Result& result) {
  std::string out;
  const auto append_line = [&](std::string_view line) {
    if (!line.empty()) out.append(line).append(line.ends_with('\n') ? "" : "\n");
  };
  append_line(result.reason);
  const std::string wrong = wrong_samples(result.missing, result.unexpected, result.doubled);
  if (!wrong.empty()) {
    append_line(fmt::format("{} among {} of {}", wrong, counted(result.samples_compared, "sample"),
                            counted(result.triangles, "triangle")));
  }
  if (!result.first) return out;
  const FirstWrong& first = *result.first;
  append_line(fmt::format("first: {}: {}", place(first), vertices(first)));
  append_line(first.text);
  if (!first.command.empty()) append_line(fmt::format("to see it again: {}", visible_line(first.command)));
  return out;
}

std::string place(const FirstWrong& first) {
  return fmt::format("{} at pixel ({}, {}), sample {}, triangle {}", visible_line(first.kind), first.x, first.y,
                     first.sample, first.triangle);
}

std::string vertices(const FirstWrong& first) {
  std::string out;
  for (const auto& [x, y] : first.vertices) {
    out += fmt::format("{}({}, {})", out.empty() ? "" : " ", visible_line(x), visible_line(y));
  }
  return out;
}

std::string grouped(std::uint64_t number) {
  std::string digits = fmt::format("{}", number);
  for (std::size_t i = digits.size(); i > 3;) {
    i -= 3;
    digits.insert(i, 1, ',');
  }
  return digits;
}

std::string counted(std::uint64_t number, const char* noun) {
  return fmt::format("{} {}{}", grouped(number), noun, number == 1 ? "" : "s");
}

}  // namespace edgecase::conformance
