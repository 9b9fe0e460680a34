#include "conformance/runner/findings.h"

#include <fmt/format.h>

#include <algorithm>

#include "conformance/compare/atomic_file.h"
#include "conformance/compare/picture.h"
#include "conformance/compare/text_picture.h"
#include "conformance/oracle/oracle.h"

namespace edgecase::conformance {
namespace {

namespace fs = std::filesystem;

// A larger target makes expect rows that nobody reads.
constexpr int kMostReadableExtent = 64;

std::string origin(const Finding& finding, const RunResult& run, const RunPlan& plan) {
  if (run.testcase.file != nullptr) return fmt::format("case {}", run.testcase.file->name);
  return fmt::format("generator {}, seed {}, scene {}", run.testcase.generator->name, plan.seed, finding.part_index);
}

// Letters, digits and dashes of a name, so that it can be part of a file name.
std::string plain(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '-');
  return name;
}

Exhibit exhibit(const Finding& finding, const RunResult& run, const RunPlan& plan, const std::string& command) {
  const Scene& scene = finding.window;
  const Triangle& wrong = scene.triangles[finding.wrong.triangle];
  Exhibit result = exhibit_of(scene);
  result.title = fmt::format("{}: {}", run.subject, origin(finding, run, plan));
  result.subject = run.device.empty() ? run.subject : fmt::format("{} ({})", run.subject, run.device);
  result.command = command;
  result.must = finding.expected;
  result.observed = finding.observed;
  result.wrong = finding.wrong;
  if (finding.crack) {
    result.meaning = finding.wrong.kind == WrongSample::Kind::missing
                         ? "well inside the mesh before clipping, and covered by none of what clipping left"
                         : "well inside the mesh before clipping, and covered by more than one part";
    return result;
  }
  result.explanation =
      oracle::explain(scene.setting, scene.rules, wrong, finding.wrong.x, finding.wrong.y, finding.wrong.sample);
  return result;
}

FirstWrong first_wrong(const Finding& finding, const RunResult& run, const RunPlan& plan) {
  const Triangle& triangle = finding.window.triangles[finding.wrong.triangle];
  FirstWrong first;
  first.kind = name_of(finding.wrong.kind);
  first.triangle = finding.wrong.triangle;
  first.x = finding.wrong.x;
  first.y = finding.wrong.y;
  first.sample = finding.wrong.sample;
  first.text = text_picture(exhibit(finding, run, plan, {}));
  for (std::size_t i = 0; i < 3; ++i) {
    first.vertices[i] = {fmt::format("{:a}", triangle[i].x), fmt::format("{:a}", triangle[i].y)};
  }
  return first;
}

// What a strip or a fan covers may hang on every vertex and restart before, so that it is shown whole, and behind the
// one before it, which a restart has to end.
std::optional<Scene> assembled_scene(const Finding& finding, const RunResult& run, const RunPlan& plan) {
  Scene scene;
  if (run.testcase.generator != nullptr) {
    scene.setting = finding.scene.setting;
    const std::uint64_t before = std::max<std::uint64_t>(finding.part_index, 1) - 1;
    for (std::uint64_t i = before; i <= finding.part_index; ++i) {
      append_scene(*run.testcase.generator, plan.seed, i, scene);
    }
  } else {
    scene = run.testcase.file->scene;
  }
  scene.rules = finding.scene.rules;
  return scene.assembly ? std::optional(std::move(scene)) : std::nullopt;
}

const Finding* first_to_show(const Outcome& outcome) {
  const auto unexplained = std::ranges::find(outcome.findings, false, &Finding::known);
  if (unexplained != outcome.findings.end()) return &*unexplained;
  const auto known = std::ranges::find(outcome.findings, false, &Finding::crack);
  return known == outcome.findings.end() ? nullptr : &*known;
}

std::string reason(const RunResult& run, const KnownDeviation* deviation) {
  const Trial& trial = run.trial;
  if (trial.failure) return trial.failure->message;
  if (trial.skipped) return *trial.skipped;
  const Outcome& outcome = trial.outcome;
  if (trial.changed) {
    return fmt::format("{} of {} triangles cover other samples ({}); the first: {}", outcome.unexplained,
                       outcome.triangles.triangles, run.testcase.metamorphosis->about, *trial.changed);
  }
  if (outcome.unexplained != 0 && deviation != nullptr) {
    return fmt::format("{} of {} triangles are not what the known deviation's model predicts", outcome.unexplained,
                       outcome.triangles.triangles);
  }
  if (outcome.unexplained != 0) {
    return fmt::format("{} of {} triangles are wrong", outcome.triangles.wrong_triangles, outcome.triangles.triangles);
  }
  if (outcome.known_triangles != 0) return deviation->cause;
  if (outcome.unpredicted != 0) {
    return fmt::format("{} further triangles lie beyond the reach of the model of its clipper", outcome.unpredicted);
  }
  return trial.own_snap.value_or(std::string());
}

Verdict verdict(const Trial& trial) {
  if (trial.failure || trial.outcome.unexplained != 0) return Verdict::fail;
  if (trial.skipped) return Verdict::skip;
  return trial.outcome.known_triangles != 0 || trial.own_snap ? Verdict::known : Verdict::pass;
}

}  // namespace

MaskBatch by_the_rules(const Scene& scene) {
  MaskBatch masks;
  masks.reset(MaskLayout(scene.setting), scene.triangles.size());
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], masks[i]);
  }
  return masks;
}

Exhibit exhibit_of(const Scene& scene) {
  Exhibit result;
  result.scene = scene;
  for (const Triangle& t : scene.triangles) {
    result.snapped.push_back(
        {oracle::snap(scene.rules, t[0]), oracle::snap(scene.rules, t[1]), oracle::snap(scene.rules, t[2])});
  }
  return result;
}

Result describe_result(const RunResult& run, const RunPlan& plan) {
  const Outcome& outcome = run.trial.outcome;
  Result result;
  result.subject = run.subject;
  result.device = run.device;
  result.snap = run.snap;
  result.testcase = run.testcase.name();
  result.category = run.testcase.category();
  result.verdict = verdict(run.trial);
  result.triangles = outcome.triangles.triangles;
  result.samples_compared = outcome.triangles.samples_compared;
  result.missing = outcome.triangles.missing;
  result.unexpected = outcome.triangles.unexpected;
  result.doubled = outcome.meshes.doubled;
  result.known_triangles = outcome.known_triangles;
  result.unpredicted = outcome.unpredicted;
  result.cracks = outcome.cracks;
  if (const Finding* first = first_to_show(outcome)) result.first = first_wrong(*first, run, plan);
  result.reason = reason(run, find_known_deviation(plan.known_deviations, run.subject, run.device));
  result.seconds = run.trial.seconds;
  result.subject_seconds = run.trial.subject_seconds;
  return result;
}

Case reproduction(const Finding& finding, const RunResult& run, const RunPlan& plan) {
  Case result;
  result.about = fmt::format("{} deviates: {}", run.subject, describe(finding.wrong));
  result.source = origin(finding, run, plan);
  result.scene = finding.scene;
  MaskBatch expected = finding.expected;
  if (auto whole = assembled_scene(finding, run, plan)) {
    result.scene = std::move(*whole);
    expected = by_the_rules(result.scene);
  }
  const MaskLayout layout(finding.scene.setting);
  if (finding.scene.clip || std::max(layout.target.width, layout.target.height) > kMostReadableExtent) return result;

  Expectation expect;
  for (int y = 0; y < layout.target.height; ++y) {
    for (int x = 0; x < layout.target.width; ++x) {
      for (int s = 0; s < layout.samples; ++s) {
        int count = 0;
        for (std::size_t t = 0; t < expected.size(); ++t) {
          count += covered(expected[t], layout.bit(x, y, s)) ? 1 : 0;
        }
        expect.counts.push_back(static_cast<std::int8_t>(std::min(count, 9)));
      }
    }
  }
  result.expect = std::move(expect);
  return result;
}

tl::expected<void, Error> show_findings(const fs::path& folder, const std::vector<RunResult>& runs, const RunPlan& plan,
                                        std::vector<Result>& results) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    int number = 0;
    for (const Finding& finding : runs[i].trial.outcome.findings) {
      const std::string stem =
          fmt::format("{}-{}-{}", plain(runs[i].subject), plain(runs[i].testcase.name()), ++number);
      Shown shown;
      shown.caption = describe(finding.wrong);
      shown.case_file = stem + ".json";
      shown.png = stem + ".png";
      shown.svg = stem + ".svg";
      shown.command =
          fmt::format("./edgecase run {} --subject {}", (folder / shown.case_file).generic_string(), runs[i].subject);
      shown.known = finding.known;
      shown.crack = finding.crack;
      const Case repro = reproduction(finding, runs[i], plan);
      if (auto written = write_file_atomically(folder / shown.case_file, write_case(repro)); !written) return written;
      const Exhibit picture = exhibit(finding, runs[i], plan, shown.command);
      if (auto drawn = write_png(picture, folder / shown.png); !drawn) return drawn;
      if (auto drawn = write_svg(picture, folder / shown.svg); !drawn) return drawn;
      if (results[i].first && number == 1) results[i].first->command = shown.command;
      results[i].shown.push_back(std::move(shown));
    }
  }
  return {};
}

}  // namespace edgecase::conformance
