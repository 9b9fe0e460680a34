// What llvmpipe covers of triangles in window positions where that is not what the rules say: where edge values wrap
// (llvmpipe_wrap.h), and beside the scissor, which lets through half a pixel if there is more than one sample to a
// pixel (drawn_region.h). In clip space the scissor is a part of the TransformModel.
#pragma once

#include <span>

#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Whether the scissor lets more through than the rules do.
bool llvmpipe_passes_scissor(const Setting& setting);

/// Whether it may be anything but what the rules say, by the setting and the triangle's extent.
bool llvmpipe_may_deviate(const Setting& setting, const Triangle& triangle);

/// The same for a whole list: says no only if it does so for each of them.
bool llvmpipe_any_may_deviate(const Setting& setting, std::span<const Triangle> triangles);

/// Turns `mask`, which has MaskLayout(setting) and is what the rules cover, into what llvmpipe covers. Positions pass
/// through the viewport transform unchanged (enclosing_viewport.h).
void predict_llvmpipe(const Setting& setting, const Triangle& triangle, MutableMaskView mask);

}  // namespace edgecase::conformance
