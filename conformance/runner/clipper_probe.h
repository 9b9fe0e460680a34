// Triangles across the view volume's planes, and the search for those that tell two clippers apart.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "conformance/generators/random.h"
#include "conformance/models/transform_model.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// A setting and a viewport, and the triangles drawn so.
using ClipScenes = std::vector<Scene>;

/// One sample and four; plain, scissored, culled; viewports around the target and within it; no triangles yet.
ClipScenes clip_arrangements(const Rules& rules);

/// Vertices inside the view volume, but for those sent across some of `planes`; w > 0. Of the near planes, that may be
/// Vulkan's alone or OpenGL's, too. Some of the triangles are flat but for rounding.
ClipTriangle across(const std::vector<ClipPlane>& planes, Random& random);

/// Across any number of planes, w of either sign.
ClipTriangle across_any(Random& random);

/// Slivers that the snap turns over, backs culled: inside the view volume, but for one in the middle; and all of them
/// across one of its planes.
ClipScenes culled_slivers(const Rules& rules, std::size_t count);

/// Makes triangles until the models predict different masks for `wanted` of them, or `tries` is used up.
ClipScenes tell_apart(const TransformModel& a, const TransformModel& b, const ClipScenes& arrangements,
                      const std::function<ClipTriangle(Random&)>& make, std::size_t wanted, std::size_t tries);

}  // namespace edgecase::conformance
