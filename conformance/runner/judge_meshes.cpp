#include <algorithm>
#include <cmath>
#include <span>

#include "conformance/oracle/oracle.h"
#include "conformance/runner/judge.h"
#include "conformance/runner/mesh_choices.h"
#include "conformance/scene/grid.h"

namespace edgecase::conformance {

void Judge::judge_meshes(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  const Scene& scene = judged_scene(batch);
  if (scene.meshes.empty() || batch.rule_set->on_edge == OnEdge::undefined) return;
  if (scene.clip) return judge_clip_meshes(batch, first_triangle, outcome);
  const float scale = std::ldexp(1.0f, scene.rules.subpixel_bits);
  if (!checker_ || !checker_->is_for(scene.setting, scene.rules.subpixel_bits)) {
    checker_.emplace(scene.setting, scene.rules.subpixel_bits);
  }
  for (const Mesh& mesh : scene.meshes) {
    if (agreed_ && outcome.agreed_meshes++ % kMeshShare != 0) continue;
    snapped_.resize(std::max(snapped_.size(), mesh.count));
    const auto snap = [&](const auto& to_grid) {
      for (std::size_t i = 0; i < mesh.count; ++i) {
        const auto& [a, b, c] = scene.triangles[mesh.first + i];
        snapped_[i] = {to_grid(a), to_grid(b), to_grid(c)};
      }
    };
    if (all_on_grid(std::span(scene.triangles).subspan(mesh.first, mesh.count), scale)) {
      snap([scale](const Position& p) { return grid_point(p, scale); });
    } else {
      snap([&](const Position& p) { return oracle::snap(scene.rules, p); });
    }
    Watertightness found;
    if (const auto open = open_samples(scene, *batch.rule_set, mesh)) {
      checker_->check(std::span(snapped_).first(mesh.count), drawn_.whole(mesh.first, mesh.count, mesh_masks_).data(),
                      first_triangle + mesh.first, found, *open);
    } else {
      found.meshes = found.folded_meshes = 1;
    }
    outcome.meshes.add(found);
    for (const auto& torn : {found.first_missing, found.first_doubled}) {
      if (!torn) continue;
      observe();
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

// Cracks are no fault by themselves: masks that are as the model of the clipper predicts are judged already. Only where
// it predicts nothing does nothing explain them.
void Judge::judge_clip_meshes(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  const Setting& setting = batch.scene.setting;
  const ClipGeometry& geometry = *batch.scene.clip;
  observe();
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

}  // namespace edgecase::conformance
