// The rasterizer that planted faults spoil: as straightforward as it can be, in 128 bits.
#pragma once

#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/fault_table.h"

namespace edgecase::conformance {

/// Adds what `triangle`, in window positions, covers under the scene's setting and rules, with `fault`, to `mask`.
void draw_with_fault(const Scene& scene, const Triangle& triangle, Fault fault, MutableMaskView mask);

}  // namespace edgecase::conformance
