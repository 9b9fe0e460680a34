#include <algorithm>

#include "conformance/runner/judge.h"

namespace edgecase::conformance {
namespace {

void copy_masks(const MaskLayout& layout, const MaskBatchView& from, std::size_t first, std::size_t count,
                MaskBatch& to) {
  to.reset(layout, count);
  std::ranges::copy(from.data(first, count), to.data().begin());
}

// The generator's scene number of that triangle of the batch.
std::uint64_t part_of(const Batch& batch, std::size_t triangle) {
  std::uint64_t index = 0;
  for (const Batch::Part& part : batch.parts) {
    if (part.first <= triangle) index = part.index;
  }
  return index;
}

}  // namespace

void Judge::show_clipped(std::size_t first, std::size_t count, Finding& finding) const {
  const ClippedView clipped = clipped_view(reference_.window(), first, count);
  finding.window = clipped.scene;
  finding.expected = clipped.masks(expected());
  finding.observed = clipped.masks(observed_);
}

// What is expected of a torn mesh is what was observed, but with each sample inside covered once.
void Judge::add_crack(const Batch& batch, const Mesh& mesh, const WrongSample& wrong, MaskView inside, bool known,
                      Outcome& outcome) const {
  if (std::ranges::count(outcome.findings, true, &Finding::crack) >= most_findings(known)) return;
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

void Judge::add_finding(const Batch& batch, std::size_t first, std::size_t count, const WrongSample& wrong, bool known,
                        Outcome& outcome) const {
  const bool torn_mesh = count > 1;
  const auto alike = std::ranges::count_if(outcome.findings, [&](const Finding& f) {
    return !f.crack && f.known == known && (f.scene.triangles.size() > 1) == torn_mesh;
  });
  if (alike >= most_findings(known)) return;

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
