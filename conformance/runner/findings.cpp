#include "conformance/runner/findings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "conformance/compare/atomic_file.h"
#include "conformance/compare/picture.h"
#include "conformance/compare/text_picture.h"
#include "conformance/oracle/demands.h"
#include "conformance/oracle/oracle.h"

namespace edgecase::conformance {
namespace {

namespace fs = std::filesystem;

// A larger target makes expect rows that nobody reads.
constexpr int kMostReadableExtent = 64;

Origin origin_of(const Finding& finding, const RunResult& run, const RunPlan& plan) {
  Origin origin{run.subject, run.device, {}};
  if (run.testcase.file != nullptr) {
    origin.where = fmt::format("case {}", run.testcase.file->name);
  } else if (run.testcase.metamorphosis != nullptr) {
    origin.where = fmt::format("check {}, seed {}, experiment {}", run.testcase.metamorphosis->name, plan.seed,
                               finding.part_index);
  } else {
    origin.where =
        fmt::format("generator {}, seed {}, scene {}", run.testcase.generator->name, plan.seed, finding.part_index);
  }
  return origin;
}

// Letters, digits and dashes of a name, so that it can be part of a file name.
std::string plain(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '-');
  return name;
}

std::string meaning_of(const Finding& finding) {
  const bool missing = finding.wrong.kind == WrongSample::Kind::missing;
  if (finding.crack) {
    return missing ? "well inside the mesh before clipping, and covered by nothing that clipping left"
                   : "well inside the mesh before clipping, and covered by more than one of its triangles";
  }
  if (!finding.change) return {};
  return missing                                            ? "covered before the change, and not after it"
         : finding.wrong.kind == WrongSample::Kind::doubled ? "covered by two parts after the change"
                                                            : "not covered before the change, but after it";
}

// "missing: pixel (12, 7), sample 0, triangle 5", or what else is the matter.
std::string caption(const Finding& finding) {
  const WrongSample& wrong = finding.wrong;
  const std::string at = fmt::format("pixel ({}, {}), sample {}", wrong.x, wrong.y, wrong.sample);
  if (finding.crack) return fmt::format("{}: {}", wrong.kind == WrongSample::Kind::missing ? "hole" : "doubled", at);
  if (finding.change) return fmt::format("{}: {}", at, meaning_of(finding));
  return describe(wrong);
}

Exhibit exhibit(const Finding& finding, const Origin& origin, const std::string& command) {
  const Scene& scene = finding.window;
  const Triangle& wrong = scene.triangles[finding.wrong.triangle];
  Exhibit result = exhibit_of(scene, *finding.rule_set);
  result.title = fmt::format("{}: {}", origin.subject, origin.where);
  result.subject = origin.device.empty() ? origin.subject : fmt::format("{} ({})", origin.subject, origin.device);
  result.command = command;
  result.must = finding.expected;
  result.observed = finding.observed;
  result.wrong = finding.wrong;
  result.meaning = meaning_of(finding);
  if (finding.change) result.meaning += fmt::format(" ({})", finding.change->about);
  if (finding.crack) return result;
  result.explanation =
      oracle::explain(scene.setting, scene.rules, wrong, finding.wrong.x, finding.wrong.y, finding.wrong.sample);
  if (const auto& change = finding.change) {
    Scene before = scene;
    before.triangles = {change->before};
    result.before = Before{"before the change", "after it", exhibit_of(before).snapped};
  }
  return result;
}

// What a strip or a fan covers may hang on every vertex and restart before, so that it is shown whole, and behind the
// one before it, which a restart has to end.
Scene scene_to_reproduce(const Finding& finding, const RunResult& run, const RunPlan& plan) {
  if (run.testcase.metamorphosis != nullptr) return finding.scene;
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
  return scene.assembly ? scene : finding.scene;
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
  if (outcome.unexplained != 0 && run.testcase.metamorphosis != nullptr) {
    return fmt::format("{} of {} triangles cover other samples ({})", outcome.unexplained, outcome.triangles.triangles,
                       run.testcase.metamorphosis->about);
  }
  if (outcome.obsolete != 0 && outcome.obsolete == outcome.unexplained) {
    return fmt::format("{} of {} triangles are right where the known deviation's model says that they are wrong: {}",
                       outcome.obsolete, outcome.triangles.triangles,
                       outcome.known_triangles == 0 ? "it is obsolete" : "it predicts too much");
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

std::optional<Error> unwritable(const std::string& folder) {
  if (folder.empty()) return std::nullopt;
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && !fs::is_directory(folder)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error && access(folder.c_str(), W_OK | X_OK) != 0) error = std::error_code(errno, std::generic_category());
  if (!error) return std::nullopt;
  return Error{ErrorKind::bad_input, fmt::format("report folder {}: {}", folder, error.message())};
}

Exhibit exhibit_of(const Scene& scene, const RuleSet& rule_set) {
  Exhibit result;
  result.rule_set = &rule_set;
  result.scene = scene;
  for (const Triangle& t : scene.triangles) {
    result.snapped.push_back(
        {oracle::snap(scene.rules, t[0]), oracle::snap(scene.rules, t[1]), oracle::snap(scene.rules, t[2])});
  }
  return result;
}

FirstWrong first_wrong(const Finding& finding, const Origin& origin) {
  const Triangle& triangle = finding.window.triangles[finding.wrong.triangle];
  FirstWrong first;
  first.kind = name_of(finding.wrong.kind);
  first.triangle = finding.wrong.triangle;
  first.x = finding.wrong.x;
  first.y = finding.wrong.y;
  first.sample = finding.wrong.sample;
  first.text = text_picture(exhibit(finding, origin, {}));
  for (std::size_t i = 0; i < 3; ++i) {
    first.vertices[i] = {fmt::format("{:a}", triangle[i].x), fmt::format("{:a}", triangle[i].y)};
  }
  return first;
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
  result.meshes_checked = outcome.meshes.meshes - outcome.meshes.folded_meshes;
  result.known_triangles = outcome.known_triangles;
  result.unpredicted = outcome.unpredicted;
  result.may = outcome.may;
  result.cracks = outcome.cracks;
  if (const Finding* first = first_to_show(outcome)) result.first = first_wrong(*first, origin_of(*first, run, plan));
  result.reason = reason(run, excuse(plan, run.subject, run.device));
  result.seconds = run.trial.seconds;
  result.subject_seconds = run.trial.subject_seconds;
  return result;
}

Case reproduction(const Finding& finding, const Origin& origin, const Scene& scene) {
  Case result;
  result.about = fmt::format("{} deviates: {}", origin.subject, caption(finding));
  result.source = origin.where;
  result.scene = scene;
  result.rule_set = finding.rule_set;
  // What was expected are the samples nearest to the observed ones among those that are legal: no demand.
  if (!finding.rule_set->exact()) return result;
  const MaskLayout layout(scene.setting);
  if (scene.clip || std::max(layout.target.width, layout.target.height) > kMostReadableExtent) return result;

  Expectation expect;
  for (const auto& demand : oracle::sample_demands(scene.setting, oracle::demands(scene, kExactRules))) {
    expect.counts.push_back(static_cast<std::int8_t>(std::min(demand.triangles, 9)));
  }
  result.expect = std::move(expect);
  return result;
}

tl::expected<Shown, Error> show_finding(const fs::path& folder, const std::string& stem, const Finding& finding,
                                        const Origin& origin, const Scene& scene) {
  Shown shown;
  shown.caption = caption(finding);
  shown.case_file = stem + ".json";
  shown.png = stem + ".png";
  shown.svg = stem + ".svg";
  shown.command =
      fmt::format("./edgecase run {} --subject {}", (folder / shown.case_file).generic_string(), origin.subject);
  shown.known = finding.known;
  shown.crack = finding.crack;
  const std::string text = write_case(reproduction(finding, origin, scene));
  if (auto written = write_file_atomically(folder / shown.case_file, text); !written) {
    return tl::unexpected(written.error());
  }
  const Exhibit picture = exhibit(finding, origin, shown.command);
  if (auto drawn = write_png(picture, folder / shown.png); !drawn) return tl::unexpected(drawn.error());
  if (auto drawn = write_svg(picture, folder / shown.svg); !drawn) return tl::unexpected(drawn.error());
  return shown;
}

tl::expected<void, Error> show_findings(const fs::path& folder, const std::vector<RunResult>& runs, const RunPlan& plan,
                                        std::vector<Result>& results) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Outcome& outcome = runs[i].trial.outcome;
    int number = 0;
    for (const Finding& finding : outcome.findings) {
      const std::string stem =
          fmt::format("{}-{}-{}", plain(runs[i].subject), plain(runs[i].testcase.name()), ++number);
      auto shown = show_finding(folder, stem, finding, origin_of(finding, runs[i], plan),
                                scene_to_reproduce(finding, runs[i], plan));
      if (!shown) return tl::unexpected(shown.error());
      if (results[i].first && &finding == first_to_show(outcome)) results[i].first->command = shown->command;
      results[i].shown.push_back(std::move(*shown));
    }
  }
  return {};
}

}  // namespace edgecase::conformance
