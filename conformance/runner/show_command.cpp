#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "conformance/compare/picture.h"
#include "conformance/compare/text_picture.h"
#include "conformance/oracle/oracle.h"
#include "conformance/runner/case_library.h"
#include "conformance/runner/commands.h"
#include "conformance/runner/findings.h"
#include "conformance/runner/snap_probe.h"
#include "conformance/runner/testcase.h"
#include "conformance/scene/window_position.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

// What the rules say of the scene, one mask a triangle.
MaskBatch by_the_rules(const Scene& scene) {
  MaskBatch masks;
  masks.reset(MaskLayout(scene.setting), scene.triangles.size());
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], masks[i]);
  }
  return masks;
}

// Draws the case with the subject beside what the rules say.
tl::expected<void, Error> add_subject(const Case& file, const std::string& name, Exhibit& exhibit) {
  auto subject = make_subject(name);
  if (!subject) return tl::unexpected(subject.error());
  const bool probed = !(*subject)->info().device.empty();
  const auto rules = probed ? find_snap(**subject) : file.scene.rules;
  auto scene = scene_for(file, (*subject)->info(), rules.value_or((*subject)->info().rules));
  const auto refusal = scene ? (*subject)->refusal(*scene) : scene.error();
  if (refusal)
    return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{} cannot draw {}: {}", name, file.name, *refusal)});
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
