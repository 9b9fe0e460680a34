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
  meshes_checked += result.meshes_checked;
  known_triangles += result.known_triangles;
  unpredicted += result.unpredicted;
  cracks.add(result.cracks);
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

std::vector<CategorySummary> by_category(const Report& report, const SubjectSummary& subject) {
  std::vector<CategorySummary> categories;
  for (const std::size_t i : subject.results) {
    const Result& result = report.results[i];
    auto found = std::ranges::find(categories, result.category, &CategorySummary::category);
    if (found == categories.end()) found = categories.insert(found, {result.category, {}, {}});
    found->totals.add(result);
    found->results.push_back(i);
  }
  return categories;
}

std::vector<Cause> causes(const Report& report, const std::vector<std::size_t>& results) {
  std::vector<Cause> all;
  for (const std::size_t i : results) {
    const Result& result = report.results[i];
    if (result.verdict != Verdict::known && result.verdict != Verdict::skip) continue;
    auto found = std::ranges::find_if(
        all, [&](const Cause& c) { return c.verdict == result.verdict && c.reason == result.reason; });
    if (found == all.end()) found = all.insert(found, {result.verdict, result.reason, {}});
    found->results.push_back(i);
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

std::string torn(const Cracks& cracks) {
  const std::string doubled = cracks.doubled == 0 ? "" : grouped(cracks.doubled) + " doubled";
  std::string wrong = cracks.holes == 0 ? doubled : counted(cracks.holes, "hole");
  if (wrong.empty()) return wrong;
  if (cracks.holes != 0 && cracks.doubled != 0) wrong += ", " + doubled;
  return fmt::format("{} among {} inside; {} of {} torn", wrong, counted(cracks.samples_inside, "sample"),
                     grouped(cracks.torn_meshes), counted(cracks.meshes, "clipped mesh", "clipped meshes"));
}

std::string place(const Cracks& cracks) {
  const WrongSample& first = *cracks.first;
  return fmt::format("{} at pixel ({}, {}), sample {}, mesh from triangle {}",
                     first.kind == WrongSample::Kind::missing ? "hole" : "doubled", first.x, first.y, first.sample,
                     first.triangle);
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

std::string counted(std::uint64_t number, const char* noun, const char* plural) {
  if (number != 1 && plural != nullptr) return fmt::format("{} {}", grouped(number), plural);
  return fmt::format("{} {}{}", grouped(number), noun, number == 1 ? "" : "s");
}

}  // namespace edgecase::conformance
