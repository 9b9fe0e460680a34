// The real geometry: triangles as their vertices are given, before any snapping.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "conformance/bench/workloads.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Coordinates of the real geometry are multiples of 2^-20 px: those of a binary32 from 8 px on are.
inline constexpr int kGeometryBits = 20;

/// Adds to `mask`, of one sample a pixel, the pixels of `target` whose centres the unsnapped triangle covers, by the
/// top-left rule, exactly. Every coordinate is a multiple of 2^-20 px and less than 2^15 px from the origin.
void cover_geometry(const Triangle& triangle, const Extent& target, MutableMaskView mask);

/// The first `count` triangles of `workload`, as they could have been before they were put on the grid: each vertex
/// moved by less than half a subpixel along both axes, uniformly, vertices in one place by the same. Nothing for the
/// workloads whose vertices would be where they are on a coarse grid, too: `full` and `ties`.
std::optional<Scene> make_off_grid(const Workload& workload, std::size_t count, std::uint64_t seed = 1);

}  // namespace edgecase::conformance
