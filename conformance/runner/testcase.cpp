#include "conformance/runner/testcase.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "conformance/oracle/demands.h"
#include "conformance/runner/metamorphic_trial.h"
#include "conformance/scene/window_position.h"

namespace edgecase::conformance {
namespace {

// As much as stays in a second-level cache with expected and observed masks side by side, and few enough triangles that
// progress is seen.
constexpr std::size_t kBatchBytes = std::size_t{1} << 20;
constexpr std::size_t kBatchTriangles = 4096;

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

bool on_grid(const Scene& scene, int bits) {
  const auto whole = [&](float v) {
    const double scaled = std::ldexp(static_cast<double>(v), bits);
    return scaled == std::floor(scaled);
  };
  return std::ranges::all_of(scene.triangles, [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](const Position& p) { return whole(p.x) && whole(p.y); });
  });
}

// Nothing if the oracle counts as many triangles on every sample as the case expects, and leaves open what a case under
// another set than the exact one expects to be open. A case in clip space that expects something has exact window
// positions: the reader sees to it.
std::optional<Error> contradiction(const Case& file, const Scene& scene) {
  const Scene window{scene.setting, scene.rules, exact_window_triangles(scene).value_or(std::vector<Triangle>{}), {}};
  const auto demands = oracle::sample_demands(scene.setting, oracle::demands(window, *file.rule_set));
  for (std::size_t i = 0; i < demands.size(); ++i) {
    const auto& [triangles, open] = demands[i];
    const int expected = file.expect->counts[i];
    const bool right = expected == Expectation::kMay ? open || file.rule_set->exact() : !open && triangles == expected;
    if (right) continue;
    const auto said = [](bool is_open, int count) { return is_open ? "open" : fmt::format("{} triangles", count); };
    const auto samples = static_cast<std::size_t>(scene.setting.samples());
    const auto width = static_cast<std::size_t>(scene.setting.target.width);
    return Error{ErrorKind::bad_input,
                 fmt::format("{}: expect: pixel ({}, {}), sample {}: the case says {}, the rules say {}", file.path,
                             i / samples % width, i / samples / width, i % samples,
                             said(expected == Expectation::kMay, expected), said(open, triangles))};
  }
  return std::nullopt;
}

// The samples of '?', for every triangle.
std::vector<std::uint64_t> may_masks(const Case& file, const Scene& scene) {
  if (!file.expect || std::ranges::find(file.expect->counts, Expectation::kMay) == file.expect->counts.end()) return {};
  const MaskLayout layout(scene.setting);
  std::vector<std::uint64_t> all(layout.words() * scene.triangles.size());
  const auto samples = static_cast<std::size_t>(layout.samples);
  const auto width = static_cast<std::size_t>(layout.target.width);
  for (std::size_t i = 0; i < file.expect->counts.size(); ++i) {
    if (file.expect->counts[i] != Expectation::kMay) continue;
    const std::size_t bit = layout.bit(static_cast<int>(i / samples % width), static_cast<int>(i / samples / width),
                                       static_cast<int>(i % samples));
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
      cover(std::span(all).subspan(t * layout.words(), layout.words()), bit);
    }
  }
  return all;
}

}  // namespace

std::uint64_t Testcase::triangles(std::uint64_t count) const {
  if (file != nullptr) return triangle_count(file->scene);
  return generator != nullptr ? count : metamorphic_count(count);
}

std::string Testcase::name() const {
  if (file != nullptr) return file->name;
  return std::string(generator != nullptr ? generator->name : metamorphosis->name);
}

std::string Testcase::category() const {
  if (file != nullptr) return file->category;
  return generator != nullptr ? std::string(generator->category) : kMetamorphicCategory;
}

tl::expected<Scene, std::string> scene_for(const Case& file, const SubjectInfo& subject, const Rules& own,
                                           const RuleSet& rule_set) {
  Scene scene = file.scene;
  const bool follows = subject.follows_scene_rules;
  if (follows && rule_set.exact()) return scene;
  const Rules rules{follows ? rule_set.subpixel_bits(scene.rules.subpixel_bits) : own.subpixel_bits,
                    rule_set.exact() ? own.rounding : SnapRounding::nearest_even,
                    rule_set.exact() && own.half_pixel_first};
  if (scene.rules == rules) return scene;
  if (scene.rules.subpixel_bits == rules.subpixel_bits) {
    scene.rules = rules;
    return scene;
  }
  if (!on_grid(scene, scene.rules.subpixel_bits) || !on_grid(scene, rules.subpixel_bits)) {
    return tl::unexpected(fmt::format("the case needs {} subpixel bits, {} has {}", scene.rules.subpixel_bits,
                                      follows ? rule_set.name : "the subject", rules.subpixel_bits));
  }
  scene.rules = rules;
  return scene;
}

Trial try_case(const Case& file, Subject& subject, const Rules& rules, const RuleSet& of_run, Judge& judge) {
  const RuleSet& rule_set = of_run.exact() ? *file.rule_set : of_run;
  const Stopwatch watch;
  const double subject_seconds = subject.driver_seconds();
  Trial trial;
  auto scene = scene_for(file, subject.info(), rules, rule_set);
  if (!scene) {
    trial.skipped = scene.error();
    return trial;
  }
  trial.skipped = judge.refusal(*scene, rule_set);
  if (trial.skipped) return trial;
  if (file.expect) trial.failure = contradiction(file, file.scene);
  if (trial.failure) return trial;
  if (file.expect && rule_set.exact() && scene->rules != file.scene.rules && contradiction(file, *scene)) {
    trial.own_snap = "covered as its own way of snapping says, which is not the one that the case expects";
  }

  Batch batch{std::move(*scene), {{0, 0}}, {}, &rule_set};
  batch.may = may_masks(file, batch.scene);
  if (auto judged = judge.judge(batch, 0, trial.outcome); !judged) trial.failure = judged.error();
  trial.seconds = watch.seconds();
  trial.subject_seconds = subject.driver_seconds() - subject_seconds;
  return trial;
}

Trial try_generator(const Generator& generator, Subject& subject, const Rules& rules, const RuleSet& rule_set,
                    Judge& judge, const TrialOptions& options) {
  const Stopwatch watch;
  const double subject_seconds = subject.driver_seconds();
  Trial trial;
  Batch batch;
  batch.rule_set = &rule_set;
  batch.scene.setting = generator.setting;
  batch.scene.rules = rules;
  const std::size_t mask_bytes = MaskLayout(generator.setting).words() * sizeof(std::uint64_t);
  const std::size_t full = std::clamp<std::size_t>(kBatchBytes / mask_bytes, 1, kBatchTriangles);

  const SceneStream scenes(generator, options.seed);
  std::uint64_t index = 0;
  for (std::uint64_t done = 0; done < options.count;) {
    batch.scene.triangles.clear();
    batch.scene.meshes.clear();
    batch.scene.clip.reset();
    batch.scene.assembly.reset();
    batch.parts.clear();
    const std::uint64_t wanted = std::min<std::uint64_t>(full, options.count - done);
    index = scenes.fill(index, wanted, batch.scene, [&](std::uint64_t number, std::size_t first) {
      batch.parts.push_back({number, first});
    });
    trial.skipped = judge.refusal(batch.scene, rule_set);
    if (trial.skipped) break;
    if (auto judged = judge.judge(batch, done, trial.outcome); !judged) {
      trial.failure = judged.error();
      break;
    }
    done += triangle_count(batch.scene);
    options.on_progress(triangle_count(batch.scene));
  }
  trial.seconds = watch.seconds();
  trial.subject_seconds = subject.driver_seconds() - subject_seconds;
  return trial;
}

}  // namespace edgecase::conformance
