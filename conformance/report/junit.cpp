#include <fmt/format.h>

#include <iterator>

#include "conformance/report/escape.h"
#include "conformance/report/report.h"
#include "conformance/report/summary.h"

namespace edgecase::conformance {
namespace {

void append_property(const char* name, const std::string& value, std::string& out) {
  fmt::format_to(std::back_inserter(out), "      <property name=\"{}\" value=\"{}\"/>\n", name,
                 markup_attribute(value));
}

void append_case(const Result& result, std::string& out) {
  const std::string class_name =
      result.category.empty() ? result.subject : fmt::format("{}.{}", result.subject, result.category);
  fmt::format_to(std::back_inserter(out), "    <testcase classname=\"{}\" name=\"{}\" time=\"{:.6f}\"",
                 markup_attribute(class_name), markup_attribute(result.testcase), result.seconds);
  switch (result.verdict) {
    case Verdict::pass:
      out += "/>\n";
      return;
    case Verdict::fail:
      fmt::format_to(std::back_inserter(out), ">\n      <failure message=\"{}\" type=\"{}\">{}</failure>\n",
                     markup_attribute(result.reason), markup_attribute(result.first ? result.first->kind : "failure"),
                     markup(details(result)));
      break;
    case Verdict::known:
      fmt::format_to(std::back_inserter(out), ">\n      <system-out>known deviation: {}</system-out>\n",
                     markup(details(result)));
      break;
    case Verdict::skip:
      fmt::format_to(std::back_inserter(out), ">\n      <skipped message=\"{}\"/>\n", markup_attribute(result.reason));
      break;
  }
  out += "    </testcase>\n";
}

}  // namespace

std::string to_junit(const Report& report) {
  const Totals totals = totals_of(report);
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  fmt::format_to(
      std::back_inserter(out),
      "<testsuites name=\"edgecase\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\" time=\"{:.6f}\">\n",
      totals.cases(), totals.fail, totals.skip, report.seconds);
  for (const SubjectSummary& subject : by_subject(report)) {
    double seconds = 0;
    for (const std::size_t i : subject.results) seconds += report.results[i].seconds;
    fmt::format_to(
        std::back_inserter(out),
        "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\" time=\"{:.6f}\">\n"
        "    <properties>\n",
        markup_attribute(subject.name), subject.totals.cases(), subject.totals.fail, subject.totals.skip, seconds);
    append_property("edgecase", report.version, out);
    append_property("rules", report.rules, out);
    append_property("seed", fmt::format("{}", report.seed), out);
    if (!subject.device.empty()) append_property("device", subject.device, out);
    out += "    </properties>\n";
    for (const std::size_t i : subject.results) append_case(report.results[i], out);
    out += "  </testsuite>\n";
  }
  out += "</testsuites>\n";
  return out;
}

}  // namespace edgecase::conformance
