// Finding out how a subject transforms and snaps vertices, instead of believing what it says.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "conformance/models/transform_model.h"
#include "conformance/scene/error.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// The first of transform_candidates() under which every mask that `subject` draws of the probe is right, with one
/// sample a pixel; and, if it can draw them, the HalfPixelShift under which those with four are, too. Says nothing of
/// the clipper. An error names the subject if none fits: then nothing can be said about vertices off the grid.
tl::expected<TransformModel, Error> find_transform(Subject& subject);

/// What that makes of window positions, with so many samples a pixel.
Rules window_rules(const TransformModel& transform, int samples);

/// "8 subpixel bits, to nearest even, half a pixel subtracted first".
std::string describe_snap(const Rules& rules);

/// The same of one sample and several, and how the viewport transform is rounded.
std::string describe_transform(const TransformModel& transform);

}  // namespace edgecase::conformance
