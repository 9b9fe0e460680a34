// Finding out how a subject snaps, instead of believing what it says.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/error.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// Every way of snapping that is tried, in that order, with the given number of subpixel bits.
std::vector<Rules> snap_candidates(int subpixel_bits);

/// Small triangles around pixel centres whose vertices lie on, and one binary32 step beside, the ties of the grid, so
/// that any two candidates cover different samples in some of them.
Scene snap_probe(int subpixel_bits);

/// The first candidate under which every mask that `subject` draws of the probe is right. An error names the subject if
/// none fits: then nothing can be said about vertices off the grid.
tl::expected<Rules, Error> find_snap(Subject& subject);

/// "to nearest even", "half up, half a pixel subtracted first", ...
std::string describe_snap(const Rules& rules);

}  // namespace edgecase::conformance
