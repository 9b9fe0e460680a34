// Triangles that tell ways of transforming and snapping a vertex apart, by what they cover.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "conformance/models/transform_model.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// Every combination of subpixel bits, SnapRounding, MultiplyAdd and HalfPixelShift, the latter the same for one sample
/// and several: 4 to 8 bits, and those around what the device reports, the likeliest first. Clipping is left out of
/// them: their positions all lie inside the view volume.
///
/// Without clip space, window positions reach the subject through a viewport whose middle is 0 and whose size is a
/// power of two. There the multiply-add rounds nothing, and (x - 1/2) * 2^bits and x * 2^bits - 2^bits / 2 are the same
/// rounded difference times a power of two: so only HalfPixelShift `none` and `before_scaling`, `separate`, are tried.
std::vector<TransformModel> transform_candidates(int reported_bits, bool clip_space);

struct TransformProbe {
  /// In the window, and in clip space in viewports of several kinds, all of them around the target.
  std::vector<Scene> scenes;
  /// One number a candidate: two have the same if no triangle of the probe tells them apart.
  std::vector<std::size_t> group;
};

/// Searches positions next to the ties of every candidate's grid for those from which two candidates go to different
/// grid points, and makes each the end of an edge that passes a sample on either side of it. Kept is what parts
/// candidates that nothing before did, and some more. `samples` is 1 or another number of standard samples; what
/// `subject` cannot draw is left out.
TransformProbe transform_probe(std::span<const TransformModel> candidates, int samples, const Subject& subject);

}  // namespace edgecase::conformance
