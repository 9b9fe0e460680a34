#include "conformance/runner/exhaust_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "conformance/compare/atomic_file.h"
#include "conformance/oracle/demands.h"
#include "conformance/report/report.h"
#include "conformance/runner/findings.h"

namespace edgecase::conformance {
namespace {

// The first wrong triangle as `subject` draws it now.
tl::expected<Finding, Error> first_finding(const ExhaustPlan& plan, const Exhaustion::Wrong& first) {
  auto subject = make_subject(plan.subject);
  if (!subject) return tl::unexpected(subject.error());
  Finding finding;
  finding.scene.setting.target = plan.target;
  finding.scene.rules = (*subject)->info().rules;
  finding.scene.triangles = {exhaust_triangle(plan, first.triangle)};
  finding.window = finding.scene;
  finding.expected = oracle::demands(finding.scene, kExactRules).must;
  finding.wrong.kind = first.missing ? WrongSample::Kind::missing : WrongSample::Kind::unexpected;
  finding.wrong.x = first.x;
  finding.wrong.y = first.y;
  if (auto drawn = (*subject)->draw(finding.scene, finding.observed); !drawn) return tl::unexpected(drawn.error());
  if (plan.deviation != nullptr) {
    std::vector<std::uint64_t> predicted(finding.expected[0].begin(), finding.expected[0].end());
    plan.deviation->in_window.predict(finding.scene.setting, finding.scene.triangles[0], predicted);
    finding.known = std::ranges::equal(predicted, finding.observed[0]);
  }
  return finding;
}

}  // namespace

tl::expected<void, Error> write_exhaust_report(const std::filesystem::path& folder, const ExhaustPlan& plan,
                                               const std::string& device, const Exhaustion& found) {
  Result result;
  result.subject = plan.subject;
  result.device = device;
  result.testcase = fmt::format("every triangle on {} bits over {}x{} pixels", plan.lattice_bits, plan.target.width,
                                plan.target.height);
  result.category = "exhaustion";
  result.verdict = found.unexplained != 0 ? Verdict::fail : found.wrong != 0 ? Verdict::known : Verdict::pass;
  result.triangles = found.triangles;
  result.samples_compared = found.samples_compared;
  result.missing = found.missing;
  result.unexpected = found.wrong - found.missing;
  result.seconds = found.seconds;
  if (found.unexplained != 0) {
    result.reason = fmt::format("{} triangles are {}", found.unexplained,
                                plan.deviation != nullptr && plan.deviation->replaces_rules()
                                    ? "not what the known deviation's model predicts"
                                    : "wrong");
  } else if (found.wrong != 0) {
    result.reason = plan.deviation->cause;
  }
  if (found.first) {
    auto finding = first_finding(plan, *found.first);
    if (!finding) return tl::unexpected(finding.error());
    const Origin origin{plan.subject, device, fmt::format("exhaustion, triangle {}", found.first->triangle)};
    auto shown = show_finding(folder, "exhaustion", *finding, origin, finding->scene);
    if (!shown) return tl::unexpected(shown.error());
    result.first = first_wrong(*finding, origin);
    result.first->triangle = found.first->triangle;
    result.first->command = shown->command;
    result.shown.push_back(std::move(*shown));
  }
  Report report;
  report.version = EDGECASE_VERSION;
  report.seconds = found.seconds;
  report.results.push_back(std::move(result));
  return write_file_atomically(folder / "index.html", to_html(report));
}

}  // namespace edgecase::conformance
