#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "conformance/compare/picture.h"
#include "conformance/compare/text_picture.h"
#include "conformance/oracle/demands.h"
#include "conformance/oracle/oracle.h"
#include "conformance/runner/case_library.h"
#include "conformance/runner/commands.h"
#include "conformance/runner/findings.h"
#include "conformance/runner/run.h"
#include "conformance/runner/subject_model.h"
#include "conformance/runner/testcase.h"
#include "conformance/scene/window_position.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

// What the set demands of each triangle of a scene in window positions, and what it leaves open.
Exhibit exhibit_of_demands(const Scene& scene, const RuleSet& rule_set) {
  Exhibit exhibit = exhibit_of(scene, rule_set);
  oracle::Demands demands = oracle::demands(scene, rule_set);
  exhibit.must = std::move(demands.must);
  exhibit.may = std::move(demands.may);
  return exhibit;
}

// Behind a viewport transform that rounds nothing, with nothing to clip; nothing if that is not so.
std::optional<Scene> in_window(const Scene& scene) {
  auto triangles = exact_window_triangles(scene);
  if (!triangles) return std::nullopt;
  return Scene{scene.setting, scene.rules, std::move(*triangles), scene.meshes};
}

Comparison compared(const Exhibit& exhibit) {
  Comparison comparison;
  compare_masks(MaskLayout(exhibit.scene.setting), exhibit.must.data(), exhibit.may.data(), exhibit.observed.data(), 0,
                comparison);
  return comparison;
}

// What a subject covers of a case beside what it has to cover: as the set says, or under the exact one in clip space as
// the model of its clipper predicts.
tl::expected<Exhibit, Error> with_subject(const Case& file, const RuleSet& rule_set, const std::string& name) {
  auto subject = make_subject(name);
  if (!subject) return tl::unexpected(subject.error());
  const SubjectInfo& info = (*subject)->info();
  const auto model =
      SubjectModel::find(**subject, file.scene.clip.has_value()).value_or(SubjectModel::declared(**subject));
  const auto scene = scene_for(file, info, model.rules(file.scene.setting.samples()), rule_set);
  auto reference = reference_for(name, &model);
  if (!reference) return tl::unexpected(reference.error());
  const auto refusal = scene ? Judge(**subject, *reference, nullptr).refusal(*scene, rule_set) : scene.error();
  if (refusal) {
    return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{} cannot draw {}: {}", name, file.name, *refusal)});
  }
  MaskBatch observed;
  if (auto drawn = (*subject)->draw(*scene, observed); !drawn) return tl::unexpected(drawn.error());

  Exhibit exhibit;
  std::size_t unpredicted = 0;
  if (!scene->clip || !rule_set.exact()) {
    exhibit = exhibit_of_demands(in_window(*scene).value(), rule_set);  // Judge::refusal has seen to it
    exhibit.observed = std::move(observed);
    exhibit.wrong = compared(exhibit).first;
  } else {
    MaskBatch must;
    if (auto expected = reference->expect(*scene, 0, must); !expected) return tl::unexpected(expected.error());
    unpredicted = reference->unpredicted().size();
    for (const std::size_t i : reference->unpredicted()) std::ranges::copy(observed[i], must[i].begin());
    const ClippedView clipped = clipped_view(reference->window(), 0, triangle_count(*scene));
    exhibit = exhibit_of(clipped.scene);
    exhibit.must = clipped.masks(must);
    exhibit.observed = clipped.masks(observed);
    exhibit.wrong = compared(exhibit).first;
  }
  exhibit.subject = info.device.empty() ? name : fmt::format("{} ({})", name, info.device);
  exhibit.title = fmt::format("{}: {}", name, file.name.empty() ? file.path : file.name);
  if (unpredicted != 0) {
    exhibit.title += fmt::format(" ({} beyond the reach of its clipper's model, shown as drawn)", unpredicted);
  }
  if (const auto& wrong = exhibit.wrong; wrong && !scene->clip) {
    exhibit.explanation = oracle::explain(scene->setting, scene->rules, scene->triangles[wrong->triangle], wrong->x,
                                          wrong->y, wrong->sample);
  }
  return exhibit;
}

tl::expected<Exhibit, Error> by_rules_alone(const Case& file, const RuleSet& rule_set) {
  auto scene = in_window(file.scene);
  if (!scene) {
    return tl::unexpected(
        Error{ErrorKind::bad_input,
              fmt::format("{}: what it covers depends on the clipper; --subject names one", file.path)});
  }
  if (!rule_set.exact()) scene->rules = Rules{rule_set.subpixel_bits(scene->rules.subpixel_bits)};
  Exhibit exhibit = exhibit_of_demands(*scene, rule_set);
  exhibit.title = file.name.empty() ? file.path : file.name;
  return exhibit;
}

}  // namespace

int show_command(const DataFiles& data, const ShowOptions& options) {
  const auto cases = load_cases(data.cases, {options.case_name});
  if (!cases) return fail(cases.error());
  if (cases->size() > 1) {
    return fail(
        {ErrorKind::bad_input, fmt::format("\"{}\" names {} cases; show takes one", options.case_name, cases->size())});
  }
  const Case& file = cases->front();

  const RuleSet& rule_set = options.rules.empty() ? *file.rule_set : *find_rule_set(options.rules);
  auto exhibit =
      options.subject.empty() ? by_rules_alone(file, rule_set) : with_subject(file, rule_set, options.subject);
  if (!exhibit) return fail(exhibit.error());
  if (!rule_set.exact()) exhibit->title += fmt::format(", by what {} demands", rule_set.name);
  if (!options.png.empty()) {
    if (auto written = write_png(*exhibit, options.png); !written) return fail(written.error());
    return kAsExpected;
  }
  fmt::print("{}\n{}", file.about, text_picture(*exhibit));
  return kAsExpected;
}

}  // namespace edgecase::conformance
