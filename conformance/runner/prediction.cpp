#include "conformance/runner/prediction.h"

#include <algorithm>
#include <memory>

#include "conformance/oracle/oracle.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

// Few enough that a wrong model costs next to nothing.
constexpr std::size_t kTrianglesAtOnce = 16;

// Our own rasterizer draws faster than the oracle; a fault of it would leave no model that explains a driver.
void draw_exactly(const Scene& window, MaskBatch& masks) {
  thread_local const std::unique_ptr<Subject> rasterizer = make_subject("edgecase").value();
  if (!rasterizer->refusal(window) && rasterizer->draw(window, masks)) return;
  masks.reset(MaskLayout(window.setting), window.triangles.size());
  for (std::size_t i = 0; i < masks.size(); ++i) {
    oracle::cover_by_definition(window.setting, window.rules, window.triangles[i], masks[i]);
  }
}

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
  draw_exactly(window.scene, parts);
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
