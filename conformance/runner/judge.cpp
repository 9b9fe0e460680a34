#include "conformance/runner/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <span>

#include "conformance/oracle/allowed.h"
#include "conformance/oracle/oracle.h"
#include "conformance/runner/mesh_choices.h"
#include "conformance/scene/grid.h"
#include "conformance/scene/window_position.h"

namespace edgecase::conformance {
namespace {

constexpr std::size_t kFindingsOfAKind = 3;

void copy_masks(const MaskLayout& layout, const MaskBatchView& from, std::size_t first, std::size_t count,
                MaskBatch& to) {
  to.reset(layout, count);
  std::ranges::copy(from.data(first, count), to.data().begin());
}

Comparison compare_one(const MaskLayout& layout, const Batch& batch, MaskView expected, MaskView observed,
                       std::size_t triangle) {
  Comparison comparison;
  const std::span<const std::uint64_t> may =
      batch.may.empty() ? std::span<const std::uint64_t>{}
                        : std::span(batch.may).subspan(triangle * expected.size(), expected.size());
  compare_masks(layout, expected, may, observed, triangle, comparison);
  return comparison;
}

}  // namespace

std::optional<std::string> Judge::refusal(const Scene& scene, const RuleSet& rule_set) const {
  if (auto refused = subject_.refusal(scene)) return refused;
  if (!rule_set.exact()) {
    if (exact_window_triangles(scene)) return std::nullopt;
    return fmt::format("{} does not say how clipping and the viewport transform are rounded", rule_set.name);
  }
  if (!reference_.judges(scene)) return reference_.unjudged();
  return std::nullopt;
}

tl::expected<void, Error> Judge::judge(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  const auto drawn = subject_.draw_in_place(batch.scene, scratch_);
  if (!drawn) return tl::unexpected(drawn.error());
  observed_ = *drawn;
  window_.reset();
  agreed_ = false;
  if (is_plain(batch)) {
    auto agreed = reference_.expects(batch.scene, first_triangle, observed_);
    if (!agreed) return tl::unexpected(agreed.error());
    agreed_ = *agreed;
  }
  if (!agreed_) {
    if (auto compared = compare(batch, first_triangle, outcome); !compared) return compared;
  } else {
    outcome.triangles.triangles += batch.scene.triangles.size();
    outcome.triangles.samples_compared += batch.scene.triangles.size() * MaskLayout(batch.scene.setting).sample_count();
    if (deviation_ != nullptr && deviation_->in_window.may_concern_any(batch.scene.setting, batch.scene.triangles)) {
      if (auto judged = judge_triangles(batch, true, outcome); !judged) return judged;
    }
  }
  judge_meshes(batch, first_triangle, outcome);
  return {};
}

// Nearly all batches, and nearly all of these are right: what is expected need not be kept then.
bool Judge::is_plain(const Batch& batch) const {
  return !batch.scene.clip && batch.may.empty() && batch.rule_set->exact() &&
         (deviation_ == nullptr || !deviation_->replaces_rules());
}

tl::expected<void, Error> Judge::compare(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  if (batch.scene.clip && !batch.rule_set->exact()) {
    window_ =
        Scene{batch.scene.setting, batch.scene.rules, exact_window_triangles(batch.scene).value(), batch.scene.meshes};
  }
  if (auto known = reference_.expect(judged_scene(batch), first_triangle, expected_); !known) return known;
  if (!batch.rule_set->exact()) {
    if (auto granted = grant_choices(batch, first_triangle, outcome); !granted) return granted;
  }

  // What nobody predicts is not compared, and not counted as compared.
  const MaskLayout layout(batch.scene.setting);
  const std::size_t unpredicted = reference_.unpredicted().size();
  for (const std::size_t i : reference_.unpredicted()) std::ranges::copy(observed_[i], expected_[i].begin());
  outcome.unpredicted += unpredicted;

  Comparison comparison;
  compare_masks(layout, expected_.data(), batch.may, observed_.data(), first_triangle, comparison);
  comparison.triangles -= unpredicted;
  comparison.samples_compared -= unpredicted * layout.sample_count();
  outcome.triangles.add(comparison);
  if (comparison.wrong_triangles != 0 || deviation_ != nullptr) {
    return judge_triangles(batch, comparison.wrong_triangles == 0, outcome);
  }
  return {};
}

// What Rules and the top-left rule cover is legal under every set. So only the samples that the subject covers
// otherwise are asked for, and where that is legal, too, it becomes what is expected.
tl::expected<void, Error> Judge::grant_choices(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  const Scene& scene = judged_scene(batch);
  const std::size_t words = MaskLayout(scene.setting).words();
  std::vector<std::uint64_t> asked(words), must(words), may(words);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (std::ranges::equal(expected_[i], observed_[i])) continue;
    std::ranges::transform(expected_[i], observed_[i], asked.begin(), std::bit_xor<>());
    oracle::allow_by_definition(scene.setting, scene.rules, *batch.rule_set, scene.triangles[i], asked, must, may);
    const bool legal = std::ranges::equal(may, asked);
    if (!legal || (first_triangle + i) % kOracleShare == 0) {
      if (auto confirmed = reference_.confirm(scene, i, expected_[i]); !confirmed) return confirmed;
      if (auto confirmed = confirm_choices(batch, i, asked, must, may); !confirmed) return confirmed;
    }
    for (std::size_t w = 0; w < words; ++w) {
      outcome.may += static_cast<std::uint64_t>(std::popcount(may[w]));
      expected_[i][w] = (expected_[i][w] & ~asked[w]) | must[w] | (observed_[i][w] & may[w]);
    }
  }
  return {};
}

// Of what is wrong the first sample is enough: a faulty subject may have millions, and each choice is a triangle.
tl::expected<void, Error> Judge::confirm_choices(const Batch& batch, std::size_t triangle, MaskView asked,
                                                 MaskView must, MaskView may) const {
  const Scene& scene = judged_scene(batch);
  std::vector<std::uint64_t> one(asked.size()), must_again(asked.size()), may_again(asked.size());
  std::size_t w = 0;
  while (w + 1 < asked.size() && (asked[w] & ~may[w]) == 0) ++w;
  const std::uint64_t wrong = asked[w] & ~may[w];
  if (wrong != 0) one[w] = wrong & -wrong;
  if (wrong == 0) std::ranges::copy(asked, one.begin());
  oracle::allow_by_shift(scene.setting, scene.rules, *batch.rule_set, scene.triangles[triangle], one, must_again,
                         may_again);
  for (w = 0; w < asked.size(); ++w) {
    if (must_again[w] == (must[w] & one[w]) && may_again[w] == (may[w] & one[w])) continue;
    return tl::unexpected(
        Error{ErrorKind::subject, fmt::format("the oracles differ on what {} allows of {}", batch.rule_set->name,
                                              coordinates(scene.triangles[triangle]))});
  }
  return {};
}

// Reached only where something is wrong or predicted to be: here every triangle is looked at on its own, and every
// wrong one goes to both oracles before anybody is blamed.
tl::expected<void, Error> Judge::judge_triangles(const Batch& batch, bool all_right, Outcome& outcome) {
  const MaskLayout layout(batch.scene.setting);
  for (std::size_t i = 0; i < triangle_count(batch.scene); ++i) {
    const bool concerned = may_deviate(judged_scene(batch), i);
    if (all_right && !concerned) continue;
    const Comparison comparison = compare_one(layout, batch, expected()[i], observed_[i], i);
    const bool wrong = !comparison.all_right();
    if (!wrong && !concerned) continue;
    if (wrong && batch.rule_set->exact()) {  // else grant_choices has seen to it
      if (auto confirmed = reference_.confirm(batch.scene, i, expected_[i]); !confirmed) return confirmed;
    }
    const bool known = concerned && as_predicted(batch, i);
    if (wrong && known) {
      ++outcome.known_triangles;
      add_finding(batch, i, 1, *comparison.first, true, outcome);
    } else if (wrong) {
      ++outcome.unexplained;
      add_finding(batch, i, 1, *comparison.first, false, outcome);
    } else if (!known) {
      // Right where it is predicted to be wrong: the prediction, or the subject, is no longer what it was.
      const Comparison obsolete = compare_one(layout, batch, predicted_, observed_[i], i);
      if (!obsolete.first) continue;
      ++outcome.unexplained;
      ++outcome.obsolete;
      add_finding(batch, i, 1, *obsolete.first, false, outcome);
    }
  }
  return {};
}

void Judge::judge_meshes(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  const Scene& scene = judged_scene(batch);
  if (scene.meshes.empty() || batch.rule_set->on_edge == OnEdge::undefined) return;
  if (scene.clip) return judge_clip_meshes(batch, first_triangle, outcome);
  const float scale = std::ldexp(1.0f, scene.rules.subpixel_bits);
  WatertightChecker checker(scene.setting, scene.rules.subpixel_bits);
  const bool snapped_already = all_on_grid(scene.triangles, scale);
  for (const Mesh& mesh : scene.meshes) {
    snapped_.resize(std::max(snapped_.size(), mesh.count));
    const auto snap = [&](const auto& to_grid) {
      for (std::size_t i = 0; i < mesh.count; ++i) {
        const auto& [a, b, c] = scene.triangles[mesh.first + i];
        snapped_[i] = {to_grid(a), to_grid(b), to_grid(c)};
      }
    };
    if (snapped_already) {
      snap([scale](const Position& p) { return grid_point(p, scale); });
    } else {
      snap([&](const Position& p) { return oracle::snap(scene.rules, p); });
    }
    Watertightness found;
    if (const auto open = open_samples(scene, *batch.rule_set, mesh)) {
      checker.check(std::span(snapped_).first(mesh.count), observed_.data(mesh.first, mesh.count),
                    first_triangle + mesh.first, found, *open);
    } else {
      found.meshes = found.folded_meshes = 1;
    }
    outcome.meshes.add(found);
    for (const auto& torn : {found.first_missing, found.first_doubled}) {
      if (!torn) continue;
      WrongSample wrong = *torn;
      wrong.triangle -= first_triangle;
      bool known = deviation_ != nullptr;
      for (std::size_t i = mesh.first; known && i < mesh.first + mesh.count; ++i) {
        known = may_deviate(scene, i) ? as_predicted(batch, i) : std::ranges::equal(expected()[i], observed_[i]);
      }
      if (!known) ++outcome.unexplained;
      add_finding(batch, mesh.first, mesh.count, wrong, known, outcome);
    }
  }
}

bool Judge::may_deviate(const Scene& scene, std::size_t triangle) const {
  if (deviation_ == nullptr) return false;
  if (!scene.clip) return deviation_->in_window.may_concern(scene.setting, scene.triangles[triangle]);
  const WindowScene& window = reference_.window();
  const auto parts = std::span(window.scene.triangles).subspan(window.first[triangle], window.parts_of(triangle));
  return std::ranges::any_of(
      parts, [&](const Triangle& part) { return deviation_->of_part.may_concern(window.scene.setting, part); });
}

// Cracks are no fault by themselves: masks that are as the model of the clipper predicts are judged already. Only where
// it predicts nothing does nothing explain them.
void Judge::judge_clip_meshes(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  const Setting& setting = batch.scene.setting;
  const ClipGeometry& geometry = *batch.scene.clip;
  std::vector<std::uint64_t> inside(MaskLayout(setting).words());
  for (const Mesh& mesh : batch.scene.meshes) {
    const auto triangles = std::span(geometry.triangles).subspan(mesh.first, mesh.count);
    const bool bounded = certainly_inside(setting, batch.scene.rules.subpixel_bits, geometry.viewport,
                                          reference_.near_plane(), triangles, inside);
    if (!bounded) continue;
    Cracks found;
    count_cracks(setting, inside, observed_.data(mesh.first, mesh.count), first_triangle + mesh.first, found);
    outcome.cracks.add(found);
    if (!found.first) continue;
    const bool predicted = std::ranges::none_of(
        reference_.unpredicted(), [&](std::size_t i) { return i >= mesh.first && i < mesh.first + mesh.count; });
    if (!predicted) ++outcome.unexplained;
    add_crack(batch, mesh, *found.first, inside, predicted, outcome);
  }
}

bool Judge::as_predicted(const Batch& batch, std::size_t triangle) {
  predicted_.resize(observed_[triangle].size());
  const Scene& scene = judged_scene(batch);
  if (scene.clip) {
    predict_clipped(triangle);
  } else {
    deviation_->in_window.predict(scene.setting, scene.triangles[triangle], predicted_);
  }
  return std::ranges::equal(predicted_, observed_[triangle]);
}

void Judge::show_clipped(std::size_t first, std::size_t count, Finding& finding) const {
  const ClippedView clipped = clipped_view(reference_.window(), first, count);
  finding.window = clipped.scene;
  finding.expected = clipped.masks(expected_);
  finding.observed = clipped.masks(observed_);
}

// Each of the triangles that clipping left as the deviation has it, within the scissor that the driver itself is given,
// where it concerns them, and as the rules have it where it does not. What a triangle gains by deviating may lie beyond
// the scissor: only the others are filtered. Of drivers that deviate so, none fills the outline as a whole.
void Judge::predict_clipped(std::size_t triangle) {
  const WindowScene& window = reference_.window();
  Setting setting = window.scene.setting;
  setting.scissor = window.region.scissor();
  std::ranges::fill(predicted_, 0);
  for (std::size_t i = window.first[triangle]; i < window.first[triangle + 1]; ++i) {
    part_.assign(reference_.part(i).begin(), reference_.part(i).end());
    if (deviation_->of_part.may_concern(setting, window.scene.triangles[i])) {
      deviation_->of_part.predict(setting, window.scene.triangles[i], part_);
    } else {
      window.region.filter(part_);
    }
    std::ranges::transform(predicted_, part_, predicted_.begin(), std::bit_or<>());
  }
}

// What is expected of a torn mesh is what was observed, but with each sample inside covered once.
void Judge::add_crack(const Batch& batch, const Mesh& mesh, const WrongSample& wrong, MaskView inside, bool known,
                      Outcome& outcome) const {
  if (std::ranges::count(outcome.findings, true, &Finding::crack) >= static_cast<std::ptrdiff_t>(kFindingsOfAKind)) {
    return;
  }
  const auto& all = batch.scene.clip->triangles;
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(mesh.first);
  Finding finding;
  finding.crack = true;
  finding.known = known;
  finding.wrong = wrong;
  finding.wrong.triangle = 0;
  finding.scene.setting = batch.scene.setting;
  finding.scene.rules = batch.scene.rules;
  finding.scene.clip =
      ClipGeometry{batch.scene.clip->viewport, std::vector(begin, begin + static_cast<std::ptrdiff_t>(mesh.count))};
  finding.scene.meshes = {{0, mesh.count}};
  show_clipped(mesh.first, mesh.count, finding);
  finding.expected = finding.observed;
  for (std::size_t word = 0; word < inside.size(); ++word) {
    std::uint64_t open = inside[word];
    for (std::size_t i = 0; i < finding.expected.size(); ++i) {
      std::uint64_t& bits = finding.expected[i][word];
      const std::uint64_t again = bits & inside[word] & ~open;
      bits &= ~again;
      open &= ~bits;
    }
    finding.expected[0][word] |= open;
  }
  finding.part_index = part_of(batch, mesh.first);
  outcome.findings.push_back(std::move(finding));
}

std::uint64_t Judge::part_of(const Batch& batch, std::size_t triangle) {
  std::uint64_t index = 0;
  for (const Batch::Part& part : batch.parts) {
    if (part.first <= triangle) index = part.index;
  }
  return index;
}

void Judge::add_finding(const Batch& batch, std::size_t first, std::size_t count, const WrongSample& wrong, bool known,
                        Outcome& outcome) const {
  const bool torn_mesh = count > 1;
  const auto alike = std::ranges::count_if(outcome.findings, [&](const Finding& f) {
    return !f.crack && f.known == known && (f.scene.triangles.size() > 1) == torn_mesh;
  });
  if (static_cast<std::size_t>(alike) >= kFindingsOfAKind) return;

  Finding finding;
  finding.scene.setting = batch.scene.setting;
  finding.scene.rules = batch.scene.rules;
  const MaskLayout layout(batch.scene.setting);
  const auto slice = [&](const auto& all) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  if (batch.scene.clip) {
    finding.scene.clip = ClipGeometry{batch.scene.clip->viewport, slice(batch.scene.clip->triangles)};
  } else {
    finding.scene.triangles = slice(batch.scene.triangles);
    if (torn_mesh) finding.scene.meshes.push_back({0, count});
  }
  if (batch.scene.clip && !window_) {
    show_clipped(first, count, finding);
  } else {
    finding.window = finding.scene;
    finding.window.clip.reset();
    finding.window.triangles = slice(judged_scene(batch).triangles);
    copy_masks(layout, expected(), first, count, finding.expected);
    copy_masks(layout, observed_, first, count, finding.observed);
  }
  finding.wrong = wrong;
  finding.wrong.triangle -= first;
  // A hole belongs to whichever triangle should have filled it: that one's edges explain it.
  for (std::size_t i = 0; torn_mesh && wrong.kind == WrongSample::Kind::missing && i < count; ++i) {
    if (covered(finding.expected[i], layout.bit(wrong.x, wrong.y, wrong.sample))) finding.wrong.triangle = i;
  }
  if (batch.scene.clip) finding.wrong.triangle = 0;
  finding.known = known;
  finding.rule_set = batch.rule_set;
  finding.part_index = part_of(batch, first);
  outcome.findings.push_back(std::move(finding));
}

}  // namespace edgecase::conformance
