// Cracks: what clipping tears open in a mesh that was watertight before it.
//
// A clipper makes new vertices, and rounds them. Where the triangles on both sides of an edge do not round alike, as
// when the edge leaves through several planes, samples well inside the mesh are covered by neither or by both
// (NVlabs/nvdiffrast#225). No rule forbids that, and a model of the clipper predicts it; so it is counted on its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "conformance/compare/compare.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Running totals over any number of meshes.
struct Cracks {
  std::uint64_t meshes = 0;
  std::uint64_t torn_meshes = 0;
  std::uint64_t samples_inside = 0;  ///< certainly inside: these have to be covered exactly once
  std::uint64_t holes = 0;           ///< of these, covered by no triangle
  std::uint64_t doubled = 0;         ///< of these, covered by more than one
  std::optional<WrongSample> first;  ///< its triangle is the mesh's first

  /// Adds the totals of meshes that come after this one's.
  void add(const Cracks& later);
};

/// Where the volume that can be seen begins: at z = 0 (Vulkan, Direct3D) or z = -w (OpenGL). It ends at z = w.
enum class NearPlane { zero, minus_w };

/// How far, in pixels along either axis, a rasterizer that clips and transforms in binary32 and snaps to nearest may
/// put the border of a mesh away from where it is; nothing if no bound below a pixel holds, as with w next to 0.
///
/// With u = 2^-24, M the largest magnitude of a coordinate of the mesh and w the least one of what can be seen of it:
/// the distances d of an edge's ends from a plane have different signs and a relative error of u, so that t = d / (d -
/// d') is off by less than 4u, and the new vertex by less than 8 M u from the edge and from the plane; (df * n - dn *
/// f) / (df - dn) is no worse. Six planes add up to 48 M u, which division makes 96 (M / w) u, and the viewport half
/// its size times as many pixels. Dividing, multiplying, adding the centre, and half a pixel first, cost less than 4u
/// of half the size and 4u of the farthest end of the viewport. The bound is doubled, so that what certainly_inside()
/// itself rounds in binary64 is as nothing; the snap adds half a unit.
std::optional<double> border_error(int subpixel_bits, const Viewport& viewport, NearPlane near,
                                   std::span<const ClipTriangle> mesh);

/// Sets the bits of the samples that every rasterizer has to cover once, whatever triangles the mesh is cut into: those
/// in a pixel that is wholly inside the viewport and the scissor, inside the mesh as seen, and off its border, cut
/// edges included, by more than the border_error() along some axis. `inside` has MaskLayout(setting); false, and none
/// set, if there is no such error.
bool certainly_inside(const Setting& setting, int subpixel_bits, const Viewport& viewport, NearPlane near,
                      std::span<const ClipTriangle> mesh, MutableMaskView inside);

/// Counts the holes and doubled samples among `inside`, and adds the mesh to `total`. `masks` holds the mask of each of
/// its triangles, in order; `first_triangle` is the index that the first has in the report.
void count_cracks(const Setting& setting, MaskView inside, std::span<const std::uint64_t> masks,
                  std::size_t first_triangle, Cracks& total);

}  // namespace edgecase::conformance
