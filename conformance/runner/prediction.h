// A model's prediction of a scene, against what a subject drew.
#pragma once

#include <cstddef>

#include "conformance/models/transform_model.h"
#include "conformance/models/window_scene.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// What an exact rasterizer, ours, covers behind that transform: mask i is that of the scene's triangle i, and
/// means nothing for the triangles listed in `unpredicted` of the result.
WindowScene predict(const TransformModel& model, const Scene& scene, MaskBatch& masks);

struct Agreement {
  std::size_t wrong = 0;        ///< triangles of which a sample is predicted wrongly
  std::size_t unpredicted = 0;  ///< triangles of which the model says nothing
};

/// Compares triangle by triangle, and ends at the first few dozen with a wrong one among them.
Agreement compare_with_prediction(const TransformModel& model, const Scene& scene, const MaskBatch& observed);

}  // namespace edgecase::conformance
