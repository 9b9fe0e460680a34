// What is certain of a mesh whose vertices may be snapped in several ways.
//
// Equal positions are snapped alike, so that each choice leaves a mesh: its triangles still share whole edges. If for
// no choice a triangle turns over, a sample on no edge lies in as many triangles as the outline winds around it. Moving
// each vertex from one of its grid points to another sweeps an outline edge over the convex hull of the points that its
// two ends may have, and the winding number of a sample changes only when an edge passes it. Outside all these hulls it
// is therefore the same for every choice: such a sample is covered exactly once, or never, and which of the two may be
// asked of any one choice. In a hull it may lie inside, on the outline or outside, and is covered at most once.
//
// A specification that says who covers a sample on an edge says so of two polygons with a common edge. In a mesh's
// vertex more than two meet, and of an odd number of them no choice has exactly one of each two neighbours cover it:
// read together, exactly one of them all does. That is what Vulkan's and OpenGL's conformance tests of fill rules
// demand too.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "conformance/scene/rule_set.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// The samples of `mesh`, a mesh of `scene`, that may lie inside or outside: a mask, empty if the set of rules leaves
/// no vertex a choice. Nothing if some choice turns a triangle over, so that nothing is certain.
std::optional<std::vector<std::uint64_t>> open_samples(const Scene& scene, const RuleSet& rule_set, const Mesh& mesh);

}  // namespace edgecase::conformance
