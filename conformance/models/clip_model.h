// What is left of a triangle in clip space when a driver has clipped, projected and snapped it, bit for bit.
//
// All three models share one scheme. A vertex has an outcode: the planes it lies outside of. A triangle with all
// vertices outside one plane is dropped; one with no vertex outside any plane goes to the snap as it is. Any other is
// cut as a polygon, plane by plane, by the planes of its combined outcode only, in the driver's order: a vertex with d
// >= 0 stays, and each edge from d >= 0 to d < 0 or back yields a new vertex. What remains is drawn as a fan from its
// first vertex, each triangle on its own. (llvmpipe: measured, and described in Mesa's draw_pipe_clip.c. SwiftShader:
// measured; it fills the outline as a whole, which covers what the fan covers.)
#pragma once

#include <optional>
#include <vector>

#include "conformance/models/transform_model.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// How a triangle is wound on the screen (y down).
enum class Turn { counter_clockwise = -1, none = 0, clockwise = 1 };

/// By exact arithmetic; the vertices are grid points of at most 24 bits per coordinate.
Turn turn_of(const Triangle& triangle);

/// Whether a vertex lies outside the view volume, guard bands or not.
bool leaves_view_volume(const TransformModel& model, const ClipTriangle& triangle);

/// What clipping left of a triangle, or a part of that.
struct WindowTriangle {
  Triangle triangle;                   ///< snapped
  Turn turn_before_snap = Turn::none;  ///< in binary32

  bool operator==(const WindowTriangle&) const = default;
};

/// Appends the window triangles of `triangle` to `out`, all vertices on the grid of model.rules: the driver covers what
/// model.fill makes of their coverage. Nothing is appended for a triangle that clipping drops. Returns how the driver
/// takes the whole to be wound if model.winding decides that before clipping, and Turn::none otherwise. Nothing, and
/// nothing appended, if the model does not reach that far: a coordinate that is not finite or, not being zero, has a
/// magnitude outside [2^-40, 2^40]; a position that no finite grid point of binary32 stands for, as at w = 0; a
/// triangle larger than model.max_extent.
std::optional<Turn> append_window_triangles(const TransformModel& model, const Setting& setting,
                                            const Viewport& viewport, const ClipTriangle& triangle,
                                            std::vector<WindowTriangle>& out);

}  // namespace edgecase::conformance
