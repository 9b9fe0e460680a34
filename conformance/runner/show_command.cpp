#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "conformance/compare/picture.h"
#include "conformance/compare/text_picture.h"
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

// What a subject covers of a case beside what it has to cover: as the rules say, or in clip space as the model of its
// clipper predicts.
tl::expected<Exhibit, Error> with_subject(const Case& file, const std::string& name) {
  auto subject = make_subject(name);
  if (!subject) return tl::unexpected(subject.error());
  const SubjectInfo& info = (*subject)->info();
  const auto model =
      SubjectModel::find(**subject, file.scene.clip.has_value()).value_or(SubjectModel::declared(**subject));
  const auto scene = scene_for(file, info, model.rules(file.scene.setting.samples()));
  auto reference = reference_for(name, &model);
  if (!reference) return tl::unexpected(reference.error());
  const auto refusal = scene ? Judge(**subject, *reference, nullptr).refusal(*scene) : scene.error();
  if (refusal) {
    return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{} cannot draw {}: {}", name, file.name, *refusal)});
  }
  MaskBatch must;
  if (auto expected = reference->expect(*scene, 0, must); !expected) return tl::unexpected(expected.error());
  MaskBatch observed;
  if (auto drawn = (*subject)->draw(*scene, observed); !drawn) return tl::unexpected(drawn.error());
  for (const std::size_t i : reference->unpredicted()) std::ranges::copy(observed[i], must[i].begin());

  Comparison comparison;
  compare_masks(MaskLayout(scene->setting), must.data(), {}, observed.data(), 0, comparison);
  Exhibit exhibit;
  if (scene->clip) {
    const ClippedView clipped = clipped_view(reference->window(), 0, triangle_count(*scene));
    exhibit = exhibit_of(clipped.scene);
    exhibit.must = clipped.masks(must);
    exhibit.observed = clipped.masks(observed);
    if (comparison.first) comparison.first->triangle = clipped.bearers[comparison.first->triangle];
  } else {
    exhibit = exhibit_of(*scene);
    exhibit.must = std::move(must);
    exhibit.observed = std::move(observed);
  }
  exhibit.subject = info.device.empty() ? name : fmt::format("{} ({})", name, info.device);
  exhibit.title = fmt::format("{}: {}", name, file.name.empty() ? file.path : file.name);
  if (const std::size_t unpredicted = reference->unpredicted().size(); unpredicted != 0) {
    exhibit.title += fmt::format(" ({} beyond the reach of its clipper's model, shown as drawn)", unpredicted);
  }
  exhibit.wrong = comparison.first;
  if (const auto& wrong = comparison.first; wrong && !scene->clip) {
    exhibit.explanation = oracle::explain(scene->setting, scene->rules, scene->triangles[wrong->triangle], wrong->x,
                                          wrong->y, wrong->sample);
  }
  return exhibit;
}

tl::expected<Exhibit, Error> by_rules_alone(const Case& file) {
  Scene scene = file.scene;
  auto triangles = exact_window_triangles(scene);
  if (!triangles) {
    return tl::unexpected(
        Error{ErrorKind::bad_input,
              fmt::format("{}: what it covers depends on the clipper; --subject names one", file.path)});
  }
  scene.triangles = std::move(*triangles);
  scene.clip.reset();
  Exhibit exhibit = exhibit_of(scene);
  exhibit.must = by_the_rules(scene);
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

  const auto exhibit = options.subject.empty() ? by_rules_alone(file) : with_subject(file, options.subject);
  if (!exhibit) return fail(exhibit.error());
  if (!options.png.empty()) {
    if (auto written = write_png(*exhibit, options.png); !written) return fail(written.error());
    return kAsExpected;
  }
  fmt::print("{}\n{}", file.about, text_picture(*exhibit));
  return kAsExpected;
}

}  // namespace edgecase::conformance
