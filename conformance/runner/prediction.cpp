#include "conformance/runner/prediction.h"

#include <algorithm>

#include "conformance/oracle/oracle.h"

namespace edgecase::conformance {
namespace {

// Few enough that a wrong model costs next to nothing.
constexpr std::size_t kTrianglesAtOnce = 16;

Scene part_of(const Scene& scene, std::size_t first, std::size_t count) {
  const auto slice = [&](const auto& all) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  Scene part;
  part.setting = scene.setting;
  part.rules = scene.rules;
  if (scene.clip) {
    part.clip = ClipGeometry{scene.clip->viewport, slice(scene.clip->triangles)};
  } else {
    part.triangles = slice(scene.triangles);
  }
  return part;
}

}  // namespace

WindowScene predict(const TransformModel& model, const Scene& scene, MaskBatch& masks) {
  WindowScene window = window_scene(model, scene);
  MaskBatch parts;
  parts.reset(MaskLayout(window.scene.setting), window.scene.triangles.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    oracle::cover_by_definition(window.scene.setting, window.scene.rules, window.scene.triangles[i], parts[i]);
  }
  unite(window, parts, masks);
  return window;
}

Agreement compare_with_prediction(const TransformModel& model, const Scene& scene, const MaskBatch& observed) {
  Agreement agreement;
  MaskBatch predicted;
  const std::size_t triangles = triangle_count(scene);
  // A model that culls a triangle by what else is drawn needs the whole draw, or so many at once.
  const bool together = scene.clip && scene.setting.cull != CullMode::none && model.also_culls > kTrianglesAtOnce;
  const std::size_t at_once = together ? std::min(model.also_culls, triangles) : kTrianglesAtOnce;
  for (std::size_t first = 0; first < triangles && agreement.wrong == 0; first += at_once) {
    const std::size_t count = std::min(at_once, triangles - first);
    const WindowScene window = predict(model, part_of(scene, first, count), predicted);
    agreement.unpredicted += window.unpredicted.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (std::ranges::binary_search(window.unpredicted, i)) continue;
      if (!std::ranges::equal(predicted[i], observed[first + i])) ++agreement.wrong;
    }
  }
  return agreement;
}

}  // namespace edgecase::conformance
