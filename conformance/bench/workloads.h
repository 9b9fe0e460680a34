// Workloads: the sets of triangles on which speed is measured. Each stands for a use: the small triangles of a scene,
// the large ones of an occluder pass, a clear, hair, a tessellated surface, and vertices that put samples on edges.
//
// All are drawn to 1920x1080 pixels, one sample a pixel, with 8 subpixel bits; every vertex lies on that grid and on or
// inside the target's border. The same arguments give the same triangles on every machine: beside integers, only
// operations that IEEE 754 rounds correctly are used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "conformance/scene/scene.h"

namespace edgecase::conformance {

struct Workload {
  std::string_view name;
  std::string_view about;
  /// Triangles of the whole workload.
  std::size_t triangles;
  /// Appends exactly `count` triangles, at most `triangles`: the first ones of the whole workload.
  void (*append)(std::uint64_t seed, std::size_t count, Scene& scene);
};

/// small10, med200, large20k, full, sliver, mesh512, ties.
std::span<const Workload> workloads();

/// The workload of that name, or null.
const Workload* find_workload(std::string_view name);

/// The first `count` triangles of `workload`, all of them if it has no more than that.
Scene make_workload(const Workload& workload, std::size_t count, std::uint64_t seed = 1);

/// `count` triangles of `area` px^2 anywhere on `target`, on the grid, none thin. They must fit: sqrt(area / 0.12) px,
/// the longest edge that can be, is at most the target's lesser side.
Scene make_even(const Extent& target, std::size_t count, double area, std::uint64_t seed = 1);

}  // namespace edgecase::conformance
