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

// Draws a case in clip space with the subject beside what the model of its clipper predicts. Mask i is that of the
// case's triangle i; the outlines are those of what clipping leaves, and may be more or fewer.
tl::expected<void, Error> add_clipped(const Case& file, const Scene& scene, Subject& subject, const SubjectModel& model,
                                      Exhibit& exhibit) {
  auto reference = reference_for(subject.info().name, &model);
  if (!reference) return tl::unexpected(reference.error());
  if (!reference->judges(scene)) {
    return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{} cannot show {}: {}", subject.info().name,
                                                                  file.name, reference->unjudged())});
  }
  MaskBatch must;
  if (auto expected = reference->expect(scene, 0, must); !expected) return expected;
  MaskBatch observed;
  if (auto drawn = subject.draw(scene, observed); !drawn) return drawn;

  Scene window = reference->window().scene;
  const MaskLayout layout(window.setting);
  window.triangles.resize(std::max(window.triangles.size(), must.size()));
  exhibit = exhibit_of(window);
  for (const auto& [from, to] : {std::pair(&must, &exhibit.must), std::pair(&observed, &exhibit.observed)}) {
    to->reset(layout, window.triangles.size());
    std::ranges::fill(to->data(), 0);
    std::ranges::copy(from->data(), to->data().begin());
  }
  return {};
}

// Draws the case with the subject beside what the rules say.
tl::expected<void, Error> add_subject(const Case& file, const std::string& name, Exhibit& exhibit) {
  auto subject = make_subject(name);
  if (!subject) return tl::unexpected(subject.error());
  const auto model =
      SubjectModel::find(**subject, file.scene.clip.has_value()).value_or(SubjectModel::declared(**subject));
  auto scene = scene_for(file, (*subject)->info(), model.rules(file.scene.setting.samples()));
  const auto refusal = scene ? (*subject)->refusal(*scene) : scene.error();
  if (refusal)
    return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{} cannot draw {}: {}", name, file.name, *refusal)});
  if (scene->clip) return add_clipped(file, *scene, **subject, model, exhibit);
  exhibit = exhibit_of(*scene);
  exhibit.subject = (*subject)->info().device.empty() ? name : fmt::format("{} ({})", name, (*subject)->info().device);
  exhibit.must = by_the_rules(*scene);
  if (auto drawn = (*subject)->draw(*scene, exhibit.observed); !drawn) return drawn;

  Comparison comparison;
  compare_masks(MaskLayout(scene->setting), exhibit.must.data(), {}, exhibit.observed.data(), 0, comparison);
  exhibit.wrong = comparison.first;
  if (const auto& wrong = comparison.first) {
    exhibit.explanation = oracle::explain(scene->setting, scene->rules, scene->triangles[wrong->triangle], wrong->x,
                                          wrong->y, wrong->sample);
  }
  return {};
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

  Exhibit exhibit;
  if (options.subject.empty()) {
    Scene scene = file.scene;
    auto triangles = exact_window_triangles(scene);
    if (!triangles) {
      return fail({ErrorKind::bad_input, fmt::format("{}: what it covers depends on the clipper", file.path)});
    }
    scene.triangles = std::move(*triangles);
    scene.clip.reset();
    exhibit = exhibit_of(scene);
    exhibit.must = by_the_rules(scene);
  } else if (auto drawn = add_subject(file, options.subject, exhibit); !drawn) {
    return fail(drawn.error());
  }
  exhibit.title = file.name.empty() ? file.path : file.name;
  if (!options.png.empty()) {
    if (auto written = write_png(exhibit, options.png); !written) return fail(written.error());
    return kAsExpected;
  }
  fmt::print("{}\n{}", file.about, text_picture(exhibit));
  return kAsExpected;
}

}  // namespace edgecase::conformance
