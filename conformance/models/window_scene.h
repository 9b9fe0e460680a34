// A scene as one driver's transform leaves it: what an exact rasterizer has to cover to predict that driver.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "conformance/models/drawn_region.h"
#include "conformance/models/transform_model.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

struct WindowScene {
  /// Triangles on the grid of the model's rules, which are its rules. The setting is that of the scene, but for a
  /// scissor that a driver moves.
  Scene scene;
  /// Triangle i of the scene became triangles first[i] .. first[i + 1] - 1 of this one: none to seven of them.
  std::vector<std::size_t> first{0};
  /// The triangles of which the model predicts nothing, in ascending order.
  std::vector<std::size_t> unpredicted;
  /// Whether triangle i of `scene` takes samples away from the triangle that it is a part of, rather than adding them.
  std::vector<bool> takes_away;
  DrawnRegion region;

  std::size_t size() const { return first.size() - 1; }
  std::size_t parts_of(std::size_t triangle) const { return first[triangle + 1] - first[triangle]; }
};

/// Clips and projects `scene.clip`, drawn at once, or else snaps `scene.triangles` (which reach the driver unchanged,
/// as through an enclosing viewport).
WindowScene window_scene(const TransformModel& model, const Scene& scene);

/// Some triangles of a scene for a person to see: each as the parts that clipping left of it, or, if it left none, as
/// one without area. The first part of each bears the mask of the whole.
struct ClippedView {
  Scene scene;
  std::size_t first = 0;             ///< the scene's triangle that `bearers` begins with
  std::vector<std::size_t> bearers;  ///< of each triangle, in `scene`

  /// Mask i of `whole`, a MaskBatch or a view of one, is that of the scene's triangle i.
  template <class Masks>
  MaskBatch masks(const Masks& whole) const {
    MaskBatch result;
    result.reset(MaskLayout(scene.setting), scene.triangles.size());
    std::ranges::fill(result.data(), 0);
    for (std::size_t i = 0; i < bearers.size(); ++i) std::ranges::copy(whole[first + i], result[bearers[i]].begin());
    return result;
  }
};
ClippedView clipped_view(const WindowScene& window, std::size_t first, std::size_t count);

/// `parts` are the masks of `window.scene`; mask i of `whole` becomes what the driver covers of triangle i.
void unite(const WindowScene& window, const MaskBatch& parts, MaskBatch& whole);

/// The same for triangle i alone: its parts are the masks of `parts` from `from` on. Writes every word of `whole`.
void unite_parts(const WindowScene& window, std::size_t i, const MaskBatch& parts, std::size_t from,
                 MutableMaskView whole);

}  // namespace edgecase::conformance
