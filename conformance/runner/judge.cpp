#include "conformance/runner/judge.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "conformance/oracle/oracle.h"
#include "conformance/scene/grid.h"

namespace edgecase::conformance {
namespace {

constexpr std::size_t kFindingsOfAKind = 3;

std::span<const std::uint64_t> words_of(const MaskBatch& masks, std::size_t first, std::size_t count) {
  const std::size_t words = masks[0].size();
  return masks.data().subspan(first * words, count * words);
}

void copy_masks(const MaskLayout& layout, const MaskBatch& from, std::size_t first, std::size_t count, MaskBatch& to) {
  to.reset(layout, count);
  std::ranges::copy(words_of(from, first, count), to.data().begin());
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

std::optional<std::string> Judge::refusal(const Scene& scene) const {
  if (auto refused = subject_.refusal(scene)) return refused;
  if (!reference_.judges(scene)) return "no model of its clipper and transform is known";
  return std::nullopt;
}

tl::expected<void, Error> Judge::judge(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  if (auto drawn = subject_.draw(batch.scene, observed_); !drawn) return drawn;
  if (auto known = reference_.expect(batch.scene, first_triangle, expected_); !known) return known;

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
    if (auto judged = judge_triangles(batch, comparison.wrong_triangles == 0, outcome); !judged) return judged;
  }
  judge_meshes(batch, first_triangle, outcome);
  return {};
}

// Reached only where something is wrong or predicted to be: here every triangle is looked at on its own, and every
// wrong one goes to both oracles before anybody is blamed.
tl::expected<void, Error> Judge::judge_triangles(const Batch& batch, bool all_right, Outcome& outcome) {
  const MaskLayout layout(batch.scene.setting);
  for (std::size_t i = 0; i < triangle_count(batch.scene); ++i) {
    const bool concerned = deviation_ != nullptr && !batch.scene.clip &&
                           deviation_->may_concern(batch.scene.setting, batch.scene.triangles[i]);
    if (all_right && !concerned) continue;
    const Comparison comparison = compare_one(layout, batch, expected_[i], observed_[i], i);
    const bool wrong = !comparison.all_right();
    if (!wrong && !concerned) continue;
    if (wrong) {
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
      add_finding(batch, i, 1, *obsolete.first, false, outcome);
    }
  }
  return {};
}

void Judge::judge_meshes(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  if (batch.scene.meshes.empty()) return;
  if (batch.scene.clip) return judge_clip_meshes(batch, first_triangle, outcome);
  const double scale = std::ldexp(1.0, batch.scene.rules.subpixel_bits);
  WatertightChecker checker(batch.scene.setting, batch.scene.rules.subpixel_bits);
  for (const Mesh& mesh : batch.scene.meshes) {
    snapped_.clear();
    for (std::size_t i = mesh.first; i < mesh.first + mesh.count; ++i) {
      const Triangle& t = batch.scene.triangles[i];
      const auto grid_point = [&](const Position& p) {
        const auto point = on_grid(p, scale);
        return point ? *point : oracle::snap(batch.scene.rules, p);
      };
      snapped_.push_back({grid_point(t[0]), grid_point(t[1]), grid_point(t[2])});
    }
    Watertightness found;
    checker.check(snapped_, words_of(observed_, mesh.first, mesh.count), first_triangle + mesh.first, found);
    outcome.meshes.add(found);
    for (const auto& torn : {found.first_missing, found.first_doubled}) {
      if (!torn) continue;
      WrongSample wrong = *torn;
      wrong.triangle -= first_triangle;
      bool known = deviation_ != nullptr;
      for (std::size_t i = mesh.first; known && i < mesh.first + mesh.count; ++i) known = as_predicted(batch, i);
      if (!known) ++outcome.unexplained;
      add_finding(batch, mesh.first, mesh.count, wrong, known, outcome);
    }
  }
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
    count_cracks(setting, inside, words_of(observed_, mesh.first, mesh.count), first_triangle + mesh.first, found);
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
  deviation_->predict(batch.scene.setting, batch.scene.triangles[triangle], predicted_);
  return std::ranges::equal(predicted_, observed_[triangle]);
}

void Judge::show_clipped(std::size_t first, std::size_t count, Finding& finding) const {
  const ClippedView clipped = clipped_view(reference_.window(), first, count);
  finding.window = clipped.scene;
  finding.expected = clipped.masks(expected_);
  finding.observed = clipped.masks(observed_);
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
    show_clipped(first, count, finding);
  } else {
    finding.scene.triangles = slice(batch.scene.triangles);
    if (torn_mesh) finding.scene.meshes.push_back({0, count});
    finding.window = finding.scene;
    copy_masks(layout, expected_, first, count, finding.expected);
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
  finding.part_index = part_of(batch, first);
  outcome.findings.push_back(std::move(finding));
}

}  // namespace edgecase::conformance
